// The gravity so far: the corrected value of each stay, and what is wrong with the day.

import { get } from "./api.js";
import { set_items, set_text, show } from "./dom.js";
import { visible } from "./format.js";
import { sentence, tr } from "./language.js";
import { shown, time_with_utc } from "./time.js";

const kRefresh_ms = 5000;

let survey = { stays: [], findings: [] };
let next_ms = 0;

function text_of(said) {
    return shown(said.text_parts, said.text);
}

/** Returns why there are no new figures; "" if there are. */
function trouble() {
    if (!survey.reason) return "";
    const reason = sentence(survey.reason_parts, survey.reason_text) ?? survey.reason;
    const head = survey.stays.some((stay) => stay.gravity_mgal !== null) ? tr("These figures are old") : tr("No figures");
    return `${head}: ${visible(reason)}.`;
}

/** Returns the figures of a stay; undefined if there are none. */
export function gravity_of(key) {
    return survey.stays.find((stay) => stay.key === key);
}

/** Returns the finding that the box was lifted and set down in a stay without Next set-up; undefined if there is none. */
export function missed_set_up_of(key) {
    return survey.findings.find((one) => one.key === key && one.kind === "missed_set_up");
}

/** Returns what speaks against the reading of a stay, as texts.  After a missed set-up a part of it is not used. */
export function doubts_of(key) {
    const findings = survey.findings.filter((one) => one.key === key && (one.is_headline || one === missed_set_up_of(key)));
    const texts = [...(survey.contradictions ?? []).filter((one) => one.key === key), ...findings, ...(gravity_of(key)?.remarks ?? [])].map(text_of);
    return [...new Set(texts)];
}

/** Reads the gravity so far, at most once in some seconds; called with each status. */
export async function refresh_gravity() {
    if (document.hidden || performance.now() < next_ms) return;
    next_ms = performance.now() + kRefresh_ms;
    try {
        survey = await get("/api/survey");
        set_text("gravity-state", trouble());
    } catch (error) {
        survey = { stays: [], findings: [] };
        set_text("gravity-state", tr("No figures: {}", visible(error.message)));
    }
    // Those of one stay are in its row.
    const findings = survey.findings.filter((one) => one.is_headline && !gravity_of(one.key));
    show("gravity-findings", findings.length > 0);
    set_items("gravity-findings", findings.map((one) => [`⚠ ${text_of(one)}`, ""]));
    set_text("gravity-age", survey.as_of_utc ? tr("Gravity as of {}, data up to {}{}.", time_with_utc(survey.as_of_utc),
        time_with_utc(survey.data_to_utc), survey.model ? tr(", model {}", visible(survey.model)) : "") : "");
}
