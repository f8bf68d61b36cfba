// What the browser keeps for this page over a reload, where it is allowed to.

/** Empty when nothing is kept. */
export function recalled(key) {
    try {
        return sessionStorage.getItem(key) ?? "";
    } catch {
        return ""; // Storage is switched off: typed again after a reload.
    }
}

export function remember(key, text) {
    try {
        sessionStorage.setItem(key, text);
    } catch {
        // As above.
    }
}
