// The list of the day's stays, the newest first: gravity, one mark, and the remarks of the row that was pressed.  Below it are the
// buttons that change this stay.

import { by_id, make, set_text, show } from "./dom.js";
import { duration, number, signed, visible } from "./format.js";
import { doubts_of, gravity_of, missed_set_up_of } from "./gravity.js";
import { tr } from "./language.js";
import { time_of_day, zone } from "./time.js";

const kResume_ms = 10 * 60 * 1000; // The daemon's limit (kLongestResume) is the same.
const kDialogs = ["rename", "times", "discard"];
const kOrders = ["resume", "restore"];

/** Returns true if the last stay can be resumed still. */
export function may_resume(last, now_ms) {
    return last !== undefined && now_ms <= Date.parse(last.set_ups.at(-1).end) + kResume_ms;
}

/** Returns a running stay in the form of those that have ended. */
function of_running({ key, site, number: count, start, set_up_count, running_s, note, whole }) {
    return { key, site, number: count, note, running_s, reading: whole, is_running: true,
        set_ups: Array(set_up_count).fill({ start, end: null }) };
}

function remark_of(one) {
    const { length } = one.set_ups;
    const sd_mgal = one.reading?.set_up_sd_mgal ?? null;
    const seconds = one.set_ups.reduce((sum, part) => sum + (Date.parse(part.end) - Date.parse(part.start)) / 1000, 0);
    const set_ups = tr("{} set-ups", length) + (sd_mgal === null ? "" : tr(", sd {} mGal", number(sd_mgal, 1)));
    return [one.is_discarded && tr("discarded"), one.is_running ? tr("running") : duration(seconds), length > 1 && set_ups,
        visible(one.note)].filter(Boolean).join("; ");
}

/** Returns what a row shows. */
function row_of(one) {
    const gravity = one.is_discarded ? undefined : gravity_of(one.key);
    const doubts = one.is_discarded ? [] : doubts_of(one.key);
    const is_known = Number.isFinite(gravity?.gravity_mgal);
    const is_left_out = Number.isFinite(gravity?.left_out_difference_mgal);
    const value = is_known ? `${number(gravity.gravity_mgal, 1)} ± ${number(gravity.u_mgal, 1)}` : "–";
    const name = one.is_discarded ? visible(one.site) : `${visible(one.site)} (${one.number})`;
    return { key: one.key, class_name: one.is_discarded ? "discarded" : one.is_running ? "running" : "",
        cells: [time_of_day(one.set_ups[0].start).slice(0, 5), name, value, is_left_out ? signed(gravity.left_out_difference_mgal) : "",
            doubts.length > 0 ? "⚠" : is_known ? "✓" : ""],
        remarks: [...doubts.map((text) => `⚠ ${text}`), remark_of(one)] };
}

export class DayList {
    /** @param open  opens a dialog for a stay: open(kind, stay).
        @param change  sends an order: change(path, body).
        @param divide  begins a set-up in a stay that has ended: divide(stay, at). */
    constructor(open, change, divide) {
        this.stays = []; // The newest first.
        this.resumable = null; // Key of the stay that can be resumed.
        this.unfolded = null; // Key of the stay whose remarks are shown.
        this.shown = null; // The rows in the table, as JSON.
        for (const kind of kDialogs) by_id(`day-${kind}`).addEventListener("click", () => open(kind, this.named()));
        for (const kind of kOrders) {
            by_id(`day-${kind}`).addEventListener("click", () => {
                const { key, site } = this.named();
                change(`/api/occupation/${kind}`, { key, site });
            });
        }
        by_id("day-setup").addEventListener("click", () => divide(this.named(), missed_set_up_of(this.unfolded).time_utc));
        const press = (event) => {
            const key = event.target.closest("tr")?.dataset.key;
            if (key === undefined || (event.key && event.key !== "Enter" && event.key !== " ")) return;
            event.preventDefault();
            this.unfolded = this.unfolded === key ? null : key;
            this.draw();
        };
        by_id("day-rows").addEventListener("click", press);
        by_id("day-rows").addEventListener("keydown", press);
    }

    chosen() {
        return this.stays.find((one) => one.key === this.unfolded);
    }

    /** Names the chosen stay for a dialog or an order. */
    named() {
        const { key, site, number: count, set_ups, running_s } = this.chosen();
        return { key, site, number: count, start: set_ups[0].start, end: set_ups.at(-1).end, running_s };
    }

    /** Shows the stays of the day.  @param running  the running one, or null. */
    set(ended, discarded, running, now_ms) {
        this.stays = [...ended, ...discarded.map((one) => ({ ...one, is_discarded: true })), ...(running ? [of_running(running)] : [])]
            .sort((one, other) => (one.set_ups[0].start < other.set_ups[0].start ? 1 : -1));
        this.resumable = running === null && may_resume(ended.at(-1), now_ms) ? ended.at(-1).key : null;
        this.draw();
    }

    /** Draws the table if it has changed, and keeps the focus. */
    draw() {
        const rows = this.stays.map(row_of);
        const text = JSON.stringify([rows, this.unfolded, this.resumable, missed_set_up_of(this.unfolded)]);
        if (text === this.shown) return;
        this.shown = text;
        const focused = document.activeElement?.dataset.key;
        by_id("day-rows").replaceChildren(...rows.flatMap((row) => this.elements_of(row)));
        if (focused) [...by_id("day-rows").children].find((row) => row.dataset.key === focused)?.focus();
        if (this.stays.length > 0) set_text("day-zone", tr("Start, {}", zone(this.stays[0].set_ups[0].start)));
        show("day-empty", rows.length === 0);
        show("day-table", rows.length > 0);
        const chosen = this.chosen();
        show("day-change", chosen !== undefined);
        for (const kind of kDialogs) show(`day-${kind}`, chosen !== undefined && !chosen.is_discarded);
        show("day-resume", chosen !== undefined && chosen.key === this.resumable);
        // Later it is an amendment.
        const missed = chosen?.key === this.resumable && missed_set_up_of(chosen?.key);
        show("day-setup", Boolean(missed));
        if (missed) set_text("day-setup", tr("Next set-up at {}", time_of_day(missed.time_utc)));
        show("day-restore", Boolean(chosen?.is_discarded));
    }

    /** Returns the row, and a second one with its remarks if it is unfolded. */
    elements_of({ key, class_name, cells, remarks }) {
        const row = make("tr", "", class_name);
        row.dataset.key = key;
        row.tabIndex = 0;
        row.ariaExpanded = key === this.unfolded;
        row.append(...cells.map((text) => make("td", text)));
        if (key !== this.unfolded) return [row];
        const second = make("tr", "", "remarks");
        const cell = make("td", remarks.filter(Boolean).join("\n"), "foreign");
        cell.colSpan = cells.length;
        second.append(cell);
        return [row, second];
    }
}
