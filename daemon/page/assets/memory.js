// Texts that the browser keeps for this page, if storage is allowed.

/** Returns functions that read and write texts of a storage.  recalled() returns "" for a text that is not there. */
function memory(storage) {
    return {
        recalled(key) {
            try {
                return storage().getItem(key) ?? "";
            } catch {
                return ""; // Storage is switched off: the operator types the text again after a reload.
            }
        },
        remember(key, text) {
            try {
                storage().setItem(key, text);
            } catch {
                // Storage is switched off.
            }
        },
    };
}

/** Texts kept until the window is closed. */
export const { recalled, remember } = memory(() => sessionStorage);

/** Choices of the operator, kept in the browser. */
export const choices = memory(() => localStorage);
