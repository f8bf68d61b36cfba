// The signal: what the operator is to do now, with the buttons that fit; the level of the box, and details for the curious.

import { by_id, set_items, set_text, show } from "./dom.js";
import { duration, number, signed, significant, visible } from "./format.js";
import { tr } from "./language.js";
import { all_shown, shown, time_of_day, time_with_utc } from "./time.js";

/** Time without data after which the page says so, real time; kStaleAfter of the daemon. */
export const kStale_s = 3;
const kBubbleScale = 100 / 3; // Drawing units per arc minute: the rim is 3'.

/** Shows the signal.  @param stay  the running stay, or null.  @param stale_s  age of the newest sample if it is too old, else null.
    @return the word shown. */
export function show_signal(signal, stay, stale_s) {
    const is_stale = stale_s !== null;
    const code = is_stale ? "no_data" : signal.word;
    const word = is_stale ? tr("NO FRESH DATA") : tr(signal.text);
    by_id("signal").dataset.word = code;
    by_id("signal").toggleAttribute("data-idle", signal.buttons.includes("start")); // Nothing is complete.
    by_id("signal-sign").setAttribute("href", `#sign-${code}`);
    set_text("signal-word", word);
    set_text("signal-sentence", is_stale ? tr("Last signal: {}, {} ago.", tr(signal.text), duration(stale_s))
        : shown(signal.parts, signal.sentence));
    const moved = time_of_day(stay?.moved?.utc);
    const labels = { stop_at: tr("Stop at {}", moved), setup_at: tr("Next set-up at {}", moved), begin_at: tr("Move the start to {}", moved) };
    for (const button of by_id("signal-buttons").children) {
        const { code: order } = button.dataset;
        const is_proposed = !is_stale && signal.buttons.includes(order);
        // A stay can be stopped at any time.
        button.hidden = !is_proposed && !(stay && ["stop", "setup"].includes(order));
        button.classList.toggle("proposed", is_proposed);
        button.classList.toggle("primary", is_proposed && order === signal.buttons[0]);
        if (labels[order] && button.textContent !== labels[order]) button.textContent = labels[order];
    }
    return word;
}

/** Returns the reasons of the status in words, one per line, without the one that is the signal's sentence. */
export function troubles_of({ reasons, reason_parts, signal }) {
    return all_shown(reason_parts, reasons).filter((_, i) => !signal.sentence.startsWith(reasons[i])).join("\n");
}

/** Shows the tilt relative to the first set-up of the day.
    @param tilt  from the status; null while the box must not be touched, its values null if they are not known. */
export function show_tilt(tilt) {
    show("level", tilt !== null);
    if (!tilt) return;
    const spot = by_id("bubble-spot");
    const is_known = tilt.x_arcmin !== null;
    spot.setAttribute("visibility", is_known ? "visible" : "hidden");
    set_text("level-reference", tr("compared with {}, {}", visible(tilt.reference.site), time_with_utc(tilt.reference.utc)));
    set_items("level-advice", all_shown(tilt.advice_parts, tilt.advice).map((text) => [text.replaceAll("'", "′"), ""]));
    if (!is_known) {
        set_text("level-numbers", tr("tilt not known yet"));
        set_text("level-word", "");
        return;
    }
    const length = Math.hypot(tilt.x_arcmin, tilt.y_arcmin);
    const at_rim = Math.min(1, 84 / (kBubbleScale * length || 1));
    // The bubble is at the high side of the box, as in a spirit level.
    spot.setAttribute("cx", kBubbleScale * at_rim * tilt.x_arcmin);
    spot.setAttribute("cy", -kBubbleScale * at_rim * tilt.y_arcmin);
    spot.setAttribute("class", tilt.is_within ? "within" : "beyond");
    set_text("level-numbers", `${tilt.axes[0]} ${signed(tilt.x_arcmin)}′  ${tilt.axes[1]} ${signed(tilt.y_arcmin)}′`);
    set_text("level-word", tilt.is_within ? tr("✓ within {}′ on both axes", number(tilt.limit_arcmin, 1))
        : tr("✗ more than {}′", number(tilt.limit_arcmin, 1)));
}

function check_text(check) {
    const name = check.unit ? " " + check.unit.replace("degC", "°C") : "";
    const error = check.error ? ` ± ${significant(check.error)}` : "";
    const ending = check.ending ? " " + tr(check.ending) : "";
    const limit = `${significant(check.limit)}${name}`;
    return `${check.is_met ? "✓" : "✗"} ${visible(tr(check.quantity))} ${significant(check.value)}${error}${name}${ending}` +
        (check.is_least ? tr(" (needs {})", limit) : tr(" (limit {})", limit));
}

/** Shows what the uncorrected reading does, for models without the whole day. */
export function show_details({ details, occupation }) {
    const whole = occupation?.whole;
    const texts = [`${visible(tr(details.state))}. ${tr("Unchanged for {}.", duration(details.held_s))}`,
        whole && tr("{} mGal before all corrections; {} of data used, {} left out.", number(whole.value_mgal), duration(whole.used_s), duration(whole.left_out_s)),
        whole?.set_ups > 1 && tr("Scatter of {} set-ups: {} mGal, of their mean {} mGal.", whole.set_ups,
            number(whole.set_up_sd_mgal), number(whole.set_up_error_mgal))];
    set_text("details-reading", texts.filter(Boolean).join(" "));
    set_items("details-checks", details.checks.length ? details.checks.map((check) => [check_text(check), ""])
        : all_shown(details.reason_parts, details.reasons).map((reason) => [`✗ ${reason}`, ""]));
}
