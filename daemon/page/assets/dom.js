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

/** Sets a value in mGal with its error, and its label if there is one.  Its element has three parts, which may differ in size. */
export function set_value(id, value_mgal, error_mgal, label = null) {
    const [value, error, name] = by_id(id).children;
    const width = Number.isFinite(error_mgal) ? `± ${number(error_mgal)} mGal` : "mGal";
    const texts = [[value, number(value_mgal)], [error, Number.isFinite(value_mgal) ? width : ""], [name, label ?? name.textContent]];
    for (const [element, text] of texts) if (element.textContent !== text) element.textContent = text;
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
