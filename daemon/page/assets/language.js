// The language of the page.  English texts in the sources are the keys of the daemon's catalogue.  The page follows the browser's
// language, until the operator chooses another one.

import { choices } from "./memory.js";

const kLanguages = JSON.parse(document.querySelector('meta[name="a351-languages"]').content); // Names by their codes.
const kBrowser = navigator.languages.map((name) => name.slice(0, 2)).find((name) => name in kLanguages);

/** Code of the language that is shown. */
export const language = [choices.recalled("language"), kBrowser].find((code) => code in kLanguages) ?? "en";

async function load() {
    if (language === "en") return {};
    try {
        return await (await fetch(`/${language}.json`)).json();
    } catch {
        return {}; // The page is then in English.
    }
}

const catalogue = await load();

/** Fills the places of a text: {}, {1}, each with a format that does not matter here. */
function filled(text, words) {
    let place = 0;
    return text.replace(/\{(\d*)(?::[^}]*)?\}/g, (_, number) => words[number === "" ? place++ : Number(number)] ?? "");
}

/** Returns a text of the catalogue with its arguments. */
export function tr(text, ...words) {
    return filled(catalogue[text] ?? text, words);
}

/** Returns a sentence of the daemon.
    @param parts  its parts: a text, or an array of a text of the catalogue and its arguments, which are such lists of parts.
    @param english  the whole sentence, used if there are no parts; null if it is not known. */
export function sentence(parts, english) {
    if ((language === "en" && english !== null) || !Array.isArray(parts)) return english;
    return parts.map((part) => (Array.isArray(part) ? tr(part[0], ...part.slice(1).map((words) => sentence(words, ""))) : part))
        .join("");
}

/** Replaces a text of the page; <b> is the only markup in texts. */
function set_translation(element, text) {
    const nodes = text.split(/<b>|<\/b>/).map((part, i) => {
        if (i % 2 === 0) return document.createTextNode(part);
        const bold = document.createElement("b");
        bold.textContent = part;
        return bold;
    });
    element.replaceChildren(...nodes);
}

/** Translates an element that has only <b> inside as one text, else each text node by itself. */
function translate(element) {
    for (const name of ["title", "aria-label", "placeholder"]) {
        const text = element.getAttribute(name);
        if (text && catalogue[text]) element.setAttribute(name, catalogue[text]);
    }
    const key = (text) => text.trim().replace(/\s+/g, " ");
    if ([...element.children].every((child) => child.tagName === "B" && !child.id)) {
        const text = catalogue[key(element.innerHTML)];
        if (text) set_translation(element, text);
        return;
    }
    for (const node of element.childNodes) {
        const text = node.nodeType === Node.TEXT_NODE && catalogue[key(node.data)];
        if (text) node.data = node.data.replace(/\S[^]*\S|\S/, text);
    }
}

document.documentElement.lang = language;
if (language !== "en") for (const element of document.body.querySelectorAll("*")) translate(element);

const codes = Object.keys(kLanguages);
const other = codes[(codes.indexOf(language) + 1) % codes.length];
const button = document.getElementById("language-switch");
button.textContent = kLanguages[other];
button.lang = other;
button.addEventListener("click", () => {
    choices.remember("language", other);
    location.reload(); // All texts are made again.
});
