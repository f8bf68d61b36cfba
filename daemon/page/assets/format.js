// Formatting of numbers, times and texts of unknown origin for the page.

import { tr } from "./language.js";

/** Formats a number with a true minus sign; a dash if it is not known. */
export function number(value, digits = 2) {
    if (!Number.isFinite(value)) return "–";
    return value.toFixed(digits).replace("-", "−");
}

/** Formats a number with at most three significant digits. */
export function significant(value) {
    if (!Number.isFinite(value)) return "–";
    return String(Number(value.toPrecision(3))).replace("-", "−");
}

/** Formats a number with its sign. */
export function signed(value, digits = 1) {
    const text = number(value, digits);
    return value > 0 ? "+" + text : text;
}

/** Formats seconds as 45 s, 3 min 20 s or 2 h 05 min. */
export function duration(seconds) {
    if (!Number.isFinite(seconds)) return "–";
    const s = Math.max(0, Math.round(seconds));
    if (s < 60) return tr("{} s", s);
    if (s < 3600) return tr("{} min {} s", Math.floor(s / 60), String(s % 60).padStart(2, "0"));
    return tr("{} h {} min", Math.floor(s / 3600), String(Math.floor((s % 3600) / 60)).padStart(2, "0"));
}

/** Makes a text of unknown origin safe to show: control characters become visible signs, and characters
    that change the writing direction are replaced. */
export function visible(text) {
    return String(text ?? "")
        .replace(/[\u0000-\u001f]/g, (c) => String.fromCharCode(0x2400 + c.charCodeAt(0)))
        .replace(/\u007f/g, "\u2421")
        .replace(/[\u0080-\u009f\u200e\u200f\u2028-\u202e\u2066-\u2069]/g, "\ufffd");
}
