// The list of the day's stays, each in one line so that a whole day is visible, and the buttons that change the chosen one.

import { by_id, make, show } from "./dom.js";
import { duration, number, visible } from "./format.js";
import { tr } from "./language.js";
import { time_of_day, zone } from "./time.js";

const kResume_ms = 10 * 60 * 1000; // The daemon's limit (kLongestResume) is the same.
const kDialogs = ["rename", "times", "discard"];
const kOrders = ["resume", "restore"];

/** Returns value and standard error in mGal, as far as they are known. */
export function reading_text(reading) {
    if (!reading || reading.value_mgal === null) return "–";
    return reading.standard_error_mgal === null ? number(reading.value_mgal, 2)
        : `${number(reading.value_mgal, 2)} ± ${number(reading.standard_error_mgal, 2)}`;
}

/** Returns true if the last stay can be resumed still. */
export function may_resume(last, now_ms) {
    return last !== undefined && now_ms <= Date.parse(last.set_ups.at(-1).end) + kResume_ms;
}

function start_text(start) {
    const utc = start.slice(11, 19);
    return zone(start) === "UTC" ? utc : `${time_of_day(start)} (${utc})`;
}

function remark_text(one) {
    const sd_mgal = one.reading?.set_up_sd_mgal ?? null;
    const set_ups = one.set_ups.length > 1 &&
        tr("{} set-ups", one.set_ups.length) + (sd_mgal === null ? "" : tr(", sd {} mGal", number(sd_mgal, 2)));
    return [one.is_discarded && tr("discarded"), set_ups, visible(one.note)].filter(Boolean).join("; ");
}

function name_of(one) {
    return one.is_discarded ? visible(one.site) : `${visible(one.site)} (${one.number})`;
}

function row_of(one) {
    const row = document.createElement("tr");
    row.dataset.key = one.key;
    if (one.is_discarded) row.className = "discarded";
    const seconds = one.set_ups.reduce((sum, s) => sum + (Date.parse(s.end) - Date.parse(s.start)) / 1000, 0);
    row.append(make("td", name_of(one)), make("td", start_text(one.set_ups[0].start)), make("td", duration(seconds)),
        make("td", one.is_discarded ? "–" : reading_text(one.reading)), make("td", remark_text(one)));
    row.firstElementChild.title = visible(one.site);
    row.lastElementChild.title = remark_text(one);
    return row;
}

export class DayList {
    /** @param open  opens a dialog for a stay: open(kind, stay).
        @param change  sends an order: change(path, body). */
    constructor(open, change) {
        this.stays = []; // The newest first.
        this.last = undefined; // The stay that ended last.
        this.shown = null; // The stays in the table, as JSON.
        this.is_running = true; // Another stay runs, as far as is known.
        this.now_ms = 0;
        for (const kind of kDialogs) by_id(`day-${kind}`).addEventListener("click", () => open(kind, this.named()));
        for (const kind of kOrders) {
            by_id(`day-${kind}`).addEventListener("click", () => {
                const { key, site } = this.named();
                change(`/api/occupation/${kind}`, { key, site });
            });
        }
        by_id("day-stay").addEventListener("change", () => this.mark());
        by_id("day-rows").addEventListener("click", (event) => {
            const row = event.target.closest("tr");
            if (!row) return; // Between two rows.
            by_id("day-stay").value = row.dataset.key;
            this.mark();
        });
    }

    chosen() {
        return this.stays.find((one) => one.key === by_id("day-stay").value);
    }

    /** Names the chosen stay for a dialog or an order. */
    named() {
        const { key, site, number: count, set_ups } = this.chosen();
        return { key, site, number: count, start: set_ups[0].start, end: set_ups.at(-1).end };
    }

    /** Sets the stays of the day.  Rows that did not change are kept. */
    set(stays, discarded) {
        this.last = stays.at(-1);
        const all = [...stays, ...discarded.map((one) => ({ ...one, is_discarded: true }))];
        const text = JSON.stringify(all);
        if (text === this.shown) return;
        this.shown = text;
        const [was_newest, chosen] = [this.stays[0]?.key, by_id("day-stay").value];
        this.stays = all.sort((one, other) => (one.set_ups[0].start < other.set_ups[0].start ? 1 : -1));
        by_id("day-rows").replaceChildren(...this.stays.map(row_of));
        by_id("day-stay").replaceChildren(...this.stays.map((one) => {
            const option = make("option", `${name_of(one).slice(0, 60)}, ${start_text(one.set_ups[0].start)}`);
            option.value = one.key;
            return option;
        }));
        // The newest is chosen until the operator chooses another one.
        if (chosen !== was_newest && this.stays.some((one) => one.key === chosen)) by_id("day-stay").value = chosen;
        show("day-empty", all.length === 0);
        show("day-table", all.length > 0);
        show("day-change", all.length > 0);
        this.mark();
    }

    /** Marks the row of the chosen stay. */
    mark() {
        const chosen = this.chosen();
        for (const row of by_id("day-rows").children) row.classList.toggle("chosen", row.dataset.key === chosen?.key);
        for (const kind of kDialogs) show(`day-${kind}`, chosen !== undefined && !chosen.is_discarded);
        show("day-restore", Boolean(chosen?.is_discarded));
        this.mark_resume();
    }

    /** Offers to resume the last stay, as long as the daemon allows it. */
    show_resume(running, now_ms) {
        this.is_running = running !== null;
        this.now_ms = now_ms;
        this.mark_resume();
    }

    mark_resume() {
        const is_last = this.last !== undefined && this.chosen()?.key === this.last.key;
        show("day-resume", is_last && !this.is_running && may_resume(this.last, this.now_ms));
    }
}
