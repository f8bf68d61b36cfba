// The dialogs that change one stay: discard, rename, times.  A dialog keeps the stay for which it was opened, and the
// order names it by its key, so that nothing else is changed if stays come and go meanwhile.

import { by_id, set_text, show } from "./dom.js";
import { duration, time_of_day, visible } from "./format.js";

const kDay_ms = 24 * 3600 * 1000;

/** Returns a stay in words.  A running one has no end. */
function described(stay) {
    const times = stay.end ? `${time_of_day(stay.start)} to ${time_of_day(stay.end)} UTC`
        : `running since ${time_of_day(stay.start)} UTC`;
    return `${visible(stay.site)} (stay ${stay.number}), ${times}`;
}

/** Returns the instant with this time of day, HH:MM or HH:MM:SS in UTC, that is nearest to another instant; null if the
    text is no time of day. */
export function nearest_instant(text, near_ms) {
    const parts = /^(\d{1,2}):(\d{2})(?::(\d{2}))?$/.exec(text.trim());
    if (!parts) return null;
    const [hour, minute, second] = [parts[1], parts[2], parts[3] ?? "0"].map(Number);
    if (hour > 23 || minute > 59 || second > 59) return null;
    const time_ms = Math.floor(near_ms / kDay_ms) * kDay_ms + ((hour * 60 + minute) * 60 + second) * 1000;
    return [time_ms - kDay_ms, time_ms, time_ms + kDay_ms]
        .reduce((best, one) => (Math.abs(one - near_ms) < Math.abs(best - near_ms) ? one : best));
}

export class StayDialogs {
    /** @param order  sends an order: order(path, body).
        @param refuse  shows why nothing was sent.
        @param new_site  returns the site chosen for a rename. */
    constructor(order, refuse, new_site) {
        this.order = order;
        this.refuse = refuse;
        this.new_site = new_site;
        this.stay = null;
        const on_submit = (kind, act) => by_id(`${kind}-form`).addEventListener("submit", (event) => {
            event.preventDefault();
            if (act()) by_id(kind).close();
        });
        on_submit("discard", () => this.send("discard", { site: this.stay.site }, "discard-reason"));
        on_submit("rename", () => this.rename());
        on_submit("times", () => this.retime());
        for (const kind of ["discard", "rename", "times"]) {
            by_id(`${kind}-no`).addEventListener("click", () => by_id(kind).close());
        }
    }

    /** Opens a dialog: discard, rename or times.  @param stay  { key, site, number, start, end, running_s } */
    open(kind, stay) {
        this.stay = stay;
        by_id(`${kind}-reason`).value = "";
        if (kind === "rename") by_id("rename-site").value = by_id("rename-name").value = "";
        if (kind === "discard") {
            set_text("discard-text", stay.end ? `Discard ${described(stay)}?`
                : `Discard the running occupation at ${visible(stay.site)}, ${duration(stay.running_s)} old?`);
        } else if (kind === "rename") {
            set_text("rename-text", `Choose the correct site for ${described(stay)}:`);
        } else {
            set_text("times-text", `Correct the times of ${described(stay)}:`);
            by_id("times-from").value = time_of_day(stay.start);
            by_id("times-to").value = stay.end ? time_of_day(stay.end) : "";
            show("times-end", Boolean(stay.end));
        }
        by_id(kind).showModal();
    }

    send(change, body, reason_id) {
        const reason = by_id(reason_id).value;
        this.order(`/api/occupation/${change}`,
            { key: this.stay.key, ...body, ...(reason && { reason }) });
        return true;
    }

    rename() {
        const site = this.new_site();
        return site && this.send("rename", { site }, "rename-reason");
    }

    /** Sends the times that were changed.  @return true if there are any. */
    retime() {
        const body = { site: this.stay.site };
        for (const [key, old] of [["from", this.stay.start], ["to", this.stay.end]]) {
            const text = by_id(`times-${key}`).value;
            if (!old || text === time_of_day(old)) continue;
            const instant_ms = nearest_instant(text, Date.parse(old));
            if (instant_ms === null) {
                return this.refuse(`${text} is no time of day; allowed: HH:MM or HH:MM:SS, in UTC`);
            }
            body[key] = new Date(instant_ms).toISOString();
        }
        if (body.from || body.to) return this.send("retime", body, "times-reason");
        return this.refuse("the times are as before");
    }
}
