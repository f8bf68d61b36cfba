// Times of day in the operator's zone, which is that of the browser, with UTC beside them.

import { visible } from "./format.js";
import { sentence, tr } from "./language.js";

function two(value) {
    return String(value).padStart(2, "0");
}

/** Formats an instant, or a number of ms, in the operator's zone; milliseconds are cut to `decimals` places. */
export function time_of_day(instant, decimals = 0) {
    if (!instant) return "–";
    const date = new Date(instant);
    const fraction = decimals ? `.${String(date.getMilliseconds()).padStart(3, "0").slice(0, decimals)}` : "";
    return `${two(date.getHours())}:${two(date.getMinutes())}:${two(date.getSeconds())}${fraction}`;
}

function is_utc(instant) {
    return new Date(instant).getTimezoneOffset() === 0;
}

function utc_of_day(instant) {
    return new Date(instant).toISOString().slice(11, 19);
}

/** Formats an instant as 21:05:09 (12:05:09 UTC), in a zone that is UTC as 12:05:09 UTC. */
export function time_with_utc(instant) {
    if (!instant) return "–";
    return is_utc(instant) ? `${utc_of_day(instant)} UTC` : `${time_of_day(instant)} (${utc_of_day(instant)} UTC)`;
}

/** Formats the time between two instants likewise. */
export function span_with_utc(from, to) {
    const utc = `${tr("{} to {}", utc_of_day(from), utc_of_day(to))} UTC`;
    return is_utc(from) ? utc : `${tr("{} to {}", time_of_day(from), time_of_day(to))} (${utc})`;
}

/** Formats date and time likewise. */
export function date_with_utc(instant) {
    const date = new Date(instant);
    return `${date.getFullYear()}-${two(date.getMonth() + 1)}-${two(date.getDate())} ${time_with_utc(instant)}`;
}

/** Returns the name of the operator's zone at an instant: UTC, UTC+9, UTC−3:30. */
export function zone(instant) {
    const offset_min = -new Date(instant).getTimezoneOffset();
    if (offset_min === 0) return "UTC";
    const minutes = Math.abs(offset_min) % 60;
    return `UTC${offset_min < 0 ? "−" : "+"}${Math.floor(Math.abs(offset_min) / 60)}${minutes ? `:${two(minutes)}` : ""}`;
}

/** Returns the instant with this time of day that is nearest to another instant: HH:MM or HH:MM:SS in the operator's zone,
    with a final Z in UTC; null if the text is no time of day. */
export function nearest_instant(text, near_ms) {
    const parts = /^(\d{1,2}):(\d{2})(?::(\d{2}))?\s*(Z?)$/i.exec(text.trim());
    if (!parts) return null;
    const [hour, minute, second] = [parts[1], parts[2], parts[3] ?? "0"].map(Number);
    if (hour > 23 || minute > 59 || second > 59) return null;
    const near = new Date(near_ms);
    const in_utc = (day) => Date.UTC(near.getUTCFullYear(), near.getUTCMonth(), near.getUTCDate() + day, hour, minute, second);
    const in_zone = (day) => new Date(near.getFullYear(), near.getMonth(), near.getDate() + day, hour, minute, second).getTime();
    return [-1, 0, 1].map(parts[4] ? in_utc : in_zone)
        .reduce((best, one) => (Math.abs(one - near_ms) < Math.abs(best - near_ms) ? one : best));
}

/** Returns a sentence of the daemon as it is shown: in the page's language, its instants in the operator's zone. */
export function shown(parts, english) {
    return visible((sentence(parts, english) ?? "")
        .replace(/\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d+)?Z/g, (instant) => time_with_utc(instant)));
}

/** Returns sentences of the daemon likewise. */
export function all_shown(parts, english) {
    return english.map((text, i) => shown(parts?.[i], text));
}
