// Functions that put texts into the document.  They create text nodes only, never markup.

import { number } from "./format.js";

const found = new Map();
const listed = new Map(); // Items that each list shows.

/** Returns the element with this id; all of them are in index.html from the start. */
export function by_id(id) {
    if (!found.has(id)) found.set(id, document.getElementById(id));
    return found.get(id);
}

/** Sets a text.  The document is changed only if the text differs, because screen readers announce
    each change of a live region. */
export function set_text(id, text) {
    const element = by_id(id);
    if (element.textContent !== text) element.textContent = text;
}

/** Sets a value in mGal with its uncertainty.  Its element has two parts, which differ in size. */
export function set_value(id, value_mgal, u_mgal) {
    const texts = [number(value_mgal, 1), `± ${number(u_mgal, 1)} mGal`];
    [...by_id(id).children].forEach((part, i) => { if (part.textContent !== texts[i]) part.textContent = texts[i]; });
}

export function show(id, is_shown) {
    by_id(id).hidden = !is_shown;
}

export function make(tag, text, class_name = "") {
    const element = document.createElement(tag);
    element.textContent = text;
    if (class_name) element.className = class_name;
    return element;
}

/** Sets the items of a list, [text, class] each. */
export function set_items(id, items) {
    const key = JSON.stringify(items);
    if (listed.get(id) === key) return;
    listed.set(id, key);
    by_id(id).replaceChildren(...items.map(([text, class_name]) => make("li", text, class_name)));
}
