// The dialog that adds a site to the daemon's list.

import { Dialog } from "./dialog.js";
import { by_id } from "./dom.js";
import { tr } from "./language.js";

const kNumbers = [["latitude_deg", "new-site-latitude", true], ["longitude_deg", "new-site-longitude", true],
    ["altitude_m", "new-site-height", false], ["gravity_mgal", "new-site-gravity", false]];

/** Returns the order.  @throws Error with a line for the operator. */
function order() {
    const body = { site: by_id("new-site-name").value.trim() };
    if (!body.site) throw new Error(tr("the name is empty"));
    for (const [key, id, is_needed] of kNumbers) {
        const text = by_id(id).value.trim().replace(",", ".");
        if (!text && !is_needed) continue;
        if (!text || !Number.isFinite(Number(text))) {
            throw new Error(tr("{}: not a number; allowed: such as 36.25", by_id(id).parentElement.firstChild.data.trim()));
        }
        body[key] = Number(text);
    }
    return ["/api/sites", body];
}

export class NewSite {
    /** @param send  as for Dialog.
        @param added  called with the name of a site that was added. */
    constructor(send, added) {
        this.dialog = new Dialog("new-site", async (path, body) => {
            await send(path, body);
            added(body.site);
        }, order);
        by_id("add-site").addEventListener("click", () => this.open());
    }

    open() {
        for (const id of ["new-site-name", ...kNumbers.map(([, number]) => number)]) by_id(id).value = "";
        this.dialog.open();
    }
}
