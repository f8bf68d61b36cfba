// The verdict, and the level of the box.

import { by_id, set_items, set_text } from "./dom.js";
import { duration, number, signed, significant, visible } from "./format.js";
import { sentences, tr } from "./language.js";
import { time_with_utc } from "./time.js";

const kAdvice = {
    "stable": tr("Readings taken now are valid."),
    "settling": tr("Wait: the reading is not steady yet."),
    "warming up": tr("Wait: the oven has not reached its operating temperature."),
    "disturbed": tr("The box was touched or shaken: step back and wait."),
    "no data": tr("No verdict is possible: check sensor and cable."),
};
const kFirstValue = "values so far"; // Check of a daemon that has just started.
const kBubbleScale = 100 / 3; // Drawing units per arc minute: the rim is 3'.

function check_text(check) {
    const name = check.unit ? " " + check.unit.replace("degC", "°C") : "";
    const error = check.error ? ` ± ${significant(check.error)}` : "";
    const ending = check.ending ? " " + tr(check.ending) : "";
    const limit = `${significant(check.limit)}${name}`;
    return `${visible(tr(check.quantity))} ${significant(check.value)}${error}${name}${ending}` +
        (check.is_least ? tr(" (needs {})", limit) : tr(" (limit {})", limit));
}

function advice(verdict) {
    if (verdict.checks.some((check) => check.quantity.startsWith(kFirstValue))) return tr("Wait: the first verdict takes 20 s.");
    const unknown = verdict.checks.find((check) => !check.is_met && check.quantity === "temperature known for");
    if (!unknown || verdict.state === "disturbed") return kAdvice[verdict.state] ?? "";
    return tr("Wait: the temperature is known for {} of {} min.", significant(unknown.value), significant(unknown.limit));
}

/** Shows the verdict.  @param stale_s  age of the newest sample if it is too old for a verdict, else null.
    @return the word shown. */
export function show_verdict(verdict, stale_s) {
    const section = by_id("verdict");
    const is_stale = stale_s !== null;
    const state = is_stale ? "no data" : verdict.state;
    const word = is_stale ? tr("NO FRESH DATA") : visible(tr(verdict.state)).toUpperCase();
    section.dataset.state = state;
    by_id("verdict-sign").setAttribute("href", `#sign-${state.replace(" ", "-")}`);
    set_text("verdict-word", word);
    set_text("verdict-advice", is_stale
        ? tr("Last verdict: {}, {} ago.", visible(tr(verdict.state)), duration(stale_s)) : advice(verdict));
    const is_held = !is_stale && Number.isFinite(verdict.held_s);
    const is_waiting = is_held && verdict.time_left_s > 0;
    set_text("verdict-held", is_held ? tr("Unchanged for {}.", duration(verdict.held_s)) : "");
    set_text("verdict-left", is_waiting ? tr("At least {} more.", duration(verdict.time_left_s)) : "");
    const checks = verdict.checks;
    if (is_stale) set_items("verdict-checks", [[tr("✗ newest sample {} old", duration(stale_s)), "unmet"]]);
    else set_items("verdict-checks", checks.length
        ? checks.map((check) => [(check.is_met ? "✓ " : "✗ ") + check_text(check), check.is_met ? "met" : "unmet"])
        : sentences(verdict.reason_parts, verdict.reasons).map((reason) => ["✗ " + visible(reason), "unmet"]));
    return word;
}

/** Shows the tilt relative to the first set-up of the day.
    @param tilt  from the status; null before there is a set-up, its values null if they are not known. */
export function show_tilt(tilt) {
    const spot = by_id("bubble-spot");
    set_text("level-reference", tilt
        ? tr("compared with {}, {}", visible(tilt.reference.site), time_with_utc(tilt.reference.utc))
        : tr("Each set-up is compared with the first one of the day."));
    if (!tilt || tilt.x_arcmin === null) {
        spot.setAttribute("visibility", "hidden");
        set_text("level-numbers", tr("tilt not known yet"));
        set_text("level-word", "");
        set_items("level-advice", []);
        return;
    }
    const length = Math.hypot(tilt.x_arcmin, tilt.y_arcmin);
    const at_rim = Math.min(1, 84 / (kBubbleScale * length || 1));
    spot.setAttribute("visibility", "visible");
    // The bubble is at the high side of the box, as in a spirit level.
    spot.setAttribute("cx", kBubbleScale * at_rim * tilt.x_arcmin);
    spot.setAttribute("cy", -kBubbleScale * at_rim * tilt.y_arcmin);
    spot.setAttribute("class", tilt.is_within ? "within" : "beyond");
    set_text("level-numbers", `${tilt.axes[0]} ${signed(tilt.x_arcmin)}′  ${tilt.axes[1]} ${signed(tilt.y_arcmin)}′`);
    set_text("level-word", tilt.is_within ? tr("✓ within {}′ on both axes", number(tilt.limit_arcmin, 1))
        : tr("✗ more than {}′", number(tilt.limit_arcmin, 1)));
    set_items("level-advice", sentences(tilt.advice_parts, tilt.advice).map((text) => [visible(text).replaceAll("'", "′"), ""]));
}
