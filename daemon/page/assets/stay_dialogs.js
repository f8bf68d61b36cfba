// The dialogs that change one stay: stop, discard, rename, times.  A dialog keeps the stay for which it was opened, and the
// order names it by its key, so that nothing else is changed if stays come and go meanwhile.

import { Dialog } from "./dialog.js";
import { by_id, set_text, show } from "./dom.js";
import { duration, visible } from "./format.js";
import { tr } from "./language.js";
import { nearest_instant, span_with_utc, time_of_day, time_with_utc } from "./time.js";

/** Returns a stay in words.  A running one has no end. */
function described(stay) {
    const times = stay.end ? span_with_utc(stay.start, stay.end) : tr("running since {}", time_with_utc(stay.start));
    return tr("{} (stay {}), {}", visible(stay.site), stay.number, times);
}

export class StayDialogs {
    /** @param send  sends an order: send(path, body); rejects with a line for the operator.
        @param new_site  returns the site chosen for a rename. */
    constructor(send, new_site) {
        this.new_site = new_site;
        this.stay = null;
        this.dialogs = {
            stop: new Dialog("confirm-stop", send, () => this.order("stop", { site: this.stay.site })),
            discard: new Dialog("discard", send, () => this.order("discard", { site: this.stay.site }, "discard-reason")),
            rename: new Dialog("rename", send, () => this.renamed()),
            times: new Dialog("times", send, () => this.retimed()),
        };
    }

    /** Opens a dialog: stop, discard, rename or times.
        @param stay  { key, site, number, start, end, running_s } */
    open(kind, stay) {
        this.stay = stay;
        if (kind === "stop") {
            set_text("confirm-stop-text", tr("Stop {}?", described(stay)));
        } else if (kind === "discard") {
            set_text("discard-text", stay.end ? tr("Discard {}?", described(stay))
                : tr("Discard the running occupation at {}, {} so far?", visible(stay.site), duration(stay.running_s)));
        } else if (kind === "rename") {
            by_id("rename-site").value = by_id("rename-name").value = "";
            set_text("rename-text", tr("Choose the correct site for {}:", described(stay)));
        } else {
            set_text("times-text", tr("Correct the times of {}:", described(stay)));
            by_id("times-from").value = time_of_day(stay.start);
            by_id("times-to").value = stay.end ? time_of_day(stay.end) : "";
            show("times-end", Boolean(stay.end));
        }
        if (kind !== "stop") by_id(`${kind}-reason`).value = "";
        this.dialogs[kind].open();
    }

    /** Shows in the dialog of a stop what speaks against it, "" if nothing. */
    say_doubt(doubt) {
        set_text("confirm-stop-doubt", doubt && `⚠ ${doubt}`);
    }

    order(change, body, reason_id = null) {
        const reason = reason_id && by_id(reason_id).value;
        return [`/api/occupation/${change}`, { key: this.stay.key, ...body, ...(reason && { reason }) }];
    }

    renamed() {
        const site = this.new_site();
        if (!site) throw new Error(tr("no site is chosen"));
        return this.order("rename", { site }, "rename-reason");
    }

    /** Returns the order with the times that were changed. */
    retimed() {
        const body = { site: this.stay.site };
        for (const [key, old] of [["from", this.stay.start], ["to", this.stay.end]]) {
            const text = by_id(`times-${key}`).value;
            if (!old || text === time_of_day(old)) continue;
            const instant_ms = nearest_instant(text, Date.parse(old));
            if (instant_ms === null) throw new Error(tr("{} is no time of day; allowed: HH:MM or HH:MM:SS, HH:MMZ in UTC", text));
            body[key] = new Date(instant_ms).toISOString();
        }
        if (!body.from && !body.to) throw new Error(tr("the times are as before"));
        return this.order("retime", body, "times-reason");
    }
}
