// Texts that the browser keeps for this page over a reload, if storage is allowed.

/** Returns the stored text, or "" if there is none. */
export function recalled(key) {
    try {
        return sessionStorage.getItem(key) ?? "";
    } catch {
        return ""; // Storage is switched off: the operator types the text again after a reload.
    }
}

export function remember(key, text) {
    try {
        sessionStorage.setItem(key, text);
    } catch {
        // Storage is switched off.
    }
}
