// The panel with the gravity so far: the corrected value of each stay, and what is wrong with the day.

import { get } from "./api.js";
import { by_id, make, set_items, set_text, show } from "./dom.js";
import { number, signed, visible } from "./format.js";
import { sentence, tr } from "./language.js";
import { time_with_utc } from "./time.js";

const kRefresh_ms = 5000;
const kGravityReasons = {
    not_yet: tr("not computed yet"),
    off: tr("switched off by gravity_every_min = 0"),
    no_sites: tr("the configuration names no table of sites"),
};

let shown = "";
let current = []; // Stays with figures that are not old.
let next_ms = 0;

function state_text(survey) {
    const figures = survey.as_of_utc
        ? tr("As of {}, data up to {}{}.", time_with_utc(survey.as_of_utc), time_with_utc(survey.data_to_utc),
            survey.model ? tr(", model {}", visible(survey.model)) : "") : "";
    if (!survey.reason) return figures;
    const reason = kGravityReasons[survey.reason] ?? sentence(survey.reason_parts, survey.reason_text) ?? survey.reason;
    const head = survey.stays.some((stay) => stay.gravity_mgal !== null) ? tr("These figures are old") : tr("No figures");
    return `${head}: ${visible(reason)}. ${figures}`;
}

function row_of(stay) {
    const row = document.createElement("tr");
    if (stay.is_running) row.className = "running";
    const u = Number.isFinite(stay.u_mgal) ? ` ± ${number(stay.u_mgal, 2)}` : "";
    const value = Number.isFinite(stay.gravity_mgal) ? number(stay.gravity_mgal, 2) + u : "–";
    const remarks = [stay.is_running && tr("running"), stay.set_ups > 1 && tr("{} set-ups", stay.set_ups),
        Number.isFinite(stay.u_evening_mgal) && tr("± {} mGal after a return to the base", number(stay.u_evening_mgal, 2)),
        ...stay.remarks.map((remark) => visible(sentence(remark.text_parts, remark.text)))];
    row.append(make("td", `${visible(stay.site)} (${stay.occupation})`, "foreign"), make("td", value),
        make("td", signed(stay.left_out_difference_mgal ?? NaN, 2)),
        make("td", remarks.filter(Boolean).join("; "), "foreign"));
    return row;
}

/** Returns the stay with its gravity so far; null if there are no figures, or only old ones. */
export function gravity_of(key) {
    return current.find((stay) => stay.key === key && Number.isFinite(stay.gravity_mgal)) ?? null;
}

function show_gravity(survey) {
    current = survey.reason ? [] : survey.stays;
    const text = JSON.stringify(survey);
    if (text === shown) return;
    shown = text;
    set_text("gravity-state", state_text(survey));
    const findings = [...survey.findings].sort((one, other) => other.is_headline - one.is_headline);
    show("gravity-findings", findings.length > 0);
    set_items("gravity-findings", findings.map((one) => [visible(sentence(one.text_parts, one.text)), one.is_headline ? "headline" : ""]));
    by_id("gravity-rows").replaceChildren(...survey.stays.map(row_of).reverse()); // The newest first.
    show("gravity-table", survey.stays.length > 0);
}

/** Reads and shows the gravity so far, at most once in some seconds; called with each status. */
export async function refresh_gravity() {
    if (document.hidden || performance.now() < next_ms) return;
    next_ms = performance.now() + kRefresh_ms;
    try {
        show_gravity(await get("/api/survey"));
    } catch (error) {
        set_text("gravity-state", tr("No figures: {}", visible(error.message)));
        shown = "";
        current = [];
    }
}
