// The verdict, and the level of the box.

import { by_id, set_items, set_text } from "./dom.js";
import { duration, number, signed, significant, time_of_day, unit, visible } from "./format.js";

const kAdvice = {
    "stable": "What is read now counts.",
    "settling": "Wait: the temperature still moves.",
    "warming up": "Wait: the oven is not yet where it works.",
    "disturbed": "Hands off, step back: the box was touched or shaken.",
    "no data": "Nothing to judge: see Health below.",
    "not assessed": "",
};
const kBubbleScale = 100 / 3; // Drawing units per arc minute: the rim is 3'.

function check_text(check) {
    const name = check.unit ? " " + unit(check.unit) : "";
    return `${visible(check.quantity)} ${significant(check.value)}${name}, ` +
        `${check.is_least ? "at least" : "limit"} ${significant(check.limit)}${name.replace(" s ago", " s")}`;
}

/** @param stale_s  age of the newest sample where that is too old to judge by, else null. */
export function show_verdict(verdict, stale_s) {
    const section = by_id("verdict");
    const is_stale = stale_s !== null;
    const state = is_stale ? "no data" : verdict.state;
    const word = is_stale ? "NO FRESH DATA" : visible(verdict.state).toUpperCase();
    section.dataset.state = state;
    by_id("verdict-sign").setAttribute("href", `#sign-${state.replace(" ", "-")}`);
    set_text("verdict-word", word);
    set_text("verdict-advice", is_stale
        ? `Last verdict: ${visible(verdict.state)}, ${duration(stale_s)} ago.` : kAdvice[state] ?? "");
    set_text("verdict-held", is_stale || !Number.isFinite(verdict.held_s) ? "" : `Held for ${duration(verdict.held_s)}.`);
    const checks = verdict.checks ?? [];
    set_items("verdict-checks", checks.length
        ? checks.map((check) => [(check.is_met ? "✓ " : "✗ ") + check_text(check), check.is_met ? "met" : "unmet"])
        : verdict.reasons.map((reason) => ["✗ " + visible(reason), "unmet"]));
    return word;
}

/** @param level  of the status; null as long as no tilt is known. */
export function show_level(level) {
    const spot = by_id("bubble-spot");
    if (!level) {
        spot.setAttribute("visibility", "hidden");
        set_text("level-numbers", "no tilt known yet");
        set_text("level-word", "–");
        set_items("level-advice", []);
        set_text("level-reference", "");
        return;
    }
    const length = Math.hypot(level.x_arcmin, level.y_arcmin);
    const at_rim = Math.min(1, 84 / (kBubbleScale * length || 1));
    spot.setAttribute("visibility", "visible");
    // As in a spirit level, the bubble is where the box is high.
    spot.setAttribute("cx", kBubbleScale * at_rim * level.x_arcmin);
    spot.setAttribute("cy", -kBubbleScale * at_rim * level.y_arcmin);
    spot.setAttribute("class", level.is_within ? "within" : "beyond");
    set_text("level-numbers", `x ${signed(level.x_arcmin)}′  y ${signed(level.y_arcmin)}′`);
    set_text("level-word", level.is_within ? `✓ within ${number(level.limit_arcmin, 1)}′`
        : `✗ more than ${number(level.limit_arcmin, 1)}′`);
    set_items("level-advice", level.advice.map((text) => [visible(text).replaceAll("'", "′"), ""]));
    set_text("level-reference", level.reference
        ? `against ${visible(level.reference.site)}, ${time_of_day(level.reference.utc)} UTC`
        : "against level: no set-up of today yet");
}
