// Light or dark.  The choice is remembered.  This script runs before the first picture, so that the colours do not change in front
// of the operator.

import { by_id, set_text } from "./dom.js";
import { tr } from "./language.js";
import { choices } from "./memory.js";

const system_scheme = matchMedia("(prefers-color-scheme: dark)");

function is_dark() {
    return document.documentElement.dataset.scheme === "dark";
}

/** Shows the chosen scheme, else that of the system. */
function show_scheme() {
    document.documentElement.dataset.scheme = choices.recalled("scheme") || (system_scheme.matches ? "dark" : "light");
    set_text("scheme-switch", is_dark() ? tr("Light") : tr("Dark"));
    dispatchEvent(new Event("scheme"));
}

by_id("scheme-switch").addEventListener("click", () => {
    choices.remember("scheme", is_dark() ? "light" : "dark");
    show_scheme();
});
system_scheme.addEventListener("change", show_scheme);
show_scheme();
