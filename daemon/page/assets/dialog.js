// A dialog with a form.  It stays open, with its texts, until the daemon has accepted its order.

import { by_id, set_text, show } from "./dom.js";
import { visible } from "./format.js";
import { tr } from "./language.js";

export class Dialog {
    /** The elements are ID, ID-form, ID-no and ID-error.
        @param send  sends an order: send(path, body); rejects with a line for the operator.
        @param order  returns [path, body]; throws an Error with a line for the operator. */
    constructor(id, send, order) {
        this.id = id;
        this.is_sending = false;
        by_id(`${id}-no`).addEventListener("click", () => by_id(id).close());
        by_id(`${id}-form`).addEventListener("submit", (event) => {
            event.preventDefault();
            this.submit(send, order);
        });
    }

    open() {
        show(`${this.id}-error`, false);
        by_id(this.id).showModal();
    }

    async submit(send, order) {
        if (this.is_sending) return;
        this.is_sending = true;
        show(`${this.id}-error`, false);
        try {
            await send(...order());
            by_id(this.id).close();
        } catch (error) {
            set_text(`${this.id}-error`, tr("Not done: {}", visible(error.message)));
            show(`${this.id}-error`, true);
        } finally {
            this.is_sending = false;
        }
    }
}
