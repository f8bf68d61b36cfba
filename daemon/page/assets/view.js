// How the page looks: all panels or the field view, which has only what is needed at a benchmark; light or dark.  Both choices
// are remembered.  This script runs before the first picture, so that neither changes in front of the operator.

import { by_id, set_text } from "./dom.js";
import "./fragment.js"; // Removes the token.
import { tr } from "./language.js";
import { choices } from "./memory.js";

const kField = "#field"; // Fragment of the address that opens the field view.
const kPage = "#page"; // The same for all panels.
const system_scheme = matchMedia("(prefers-color-scheme: dark)");

/** Returns true while the field view is shown. */
export function is_field() {
    return document.documentElement.classList.contains("field");
}

export function is_dark() {
    return document.documentElement.dataset.scheme === "dark";
}

/** Shows the view that the address names, else the remembered one. */
function show_view() {
    const view = [kField, kPage].includes(location.hash) ? location.hash : choices.recalled("view");
    document.documentElement.classList.toggle("field", view === kField);
    set_text("view-switch", is_field() ? tr("Full page") : tr("Field view"));
    dispatchEvent(new Event("resize")); // The charts have another width, or none.
    dispatchEvent(new Event("view"));
}

function switch_view() {
    const view = is_field() ? kPage : kField;
    choices.remember("view", view);
    history.replaceState(null, "", view);
    show_view();
    scrollTo(0, 0);
}

/** Shows the chosen scheme, else that of the system. */
function show_scheme() {
    const scheme = choices.recalled("scheme") || (system_scheme.matches ? "dark" : "light");
    document.documentElement.dataset.scheme = scheme;
    set_text("scheme-switch", is_dark() ? tr("Light") : tr("Dark"));
    dispatchEvent(new Event("scheme"));
}

function switch_scheme() {
    choices.remember("scheme", is_dark() ? "light" : "dark");
    show_scheme();
}

by_id("view-switch").addEventListener("click", switch_view);
by_id("scheme-switch").addEventListener("click", switch_scheme);
addEventListener("hashchange", show_view);
system_scheme.addEventListener("change", show_scheme);
show_view();
show_scheme();
