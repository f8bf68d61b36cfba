// Keeps a small screen on while the page is shown, where the browser allows it, and else says what to set by hand.

import { set_text, show } from "./dom.js";
import { tr } from "./language.js";

const small = matchMedia("(max-width: 1099px), (max-height: 599px)"); // The same limits are in page.css.
let lock = null;
let refusal = ""; // Why the browser does not keep the screen on.

function reason() {
    if (navigator.wakeLock) return refusal;
    return isSecureContext ? tr("this browser cannot keep the screen on")
        : tr("over plain http from another device browsers do not keep the screen on");
}

function say() {
    show("awake", small.matches && reason() !== "");
    set_text("help-screen", reason()
        ? tr("Screen: {}. Therefore set the screen timeout of this device to 30 minutes or more by hand.", reason())
        : tr("Screen: it stays on while this page is shown."));
    set_text("help-vibration", navigator.vibrate ? tr("Vibration: it comes with the sounds, if the device has it.")
        : tr("Vibration: this browser has none, or allows it only over https."));
}

/** Asks for the lock, or releases it; browsers release it by themselves while the page is hidden. */
async function keep_awake() {
    const is_wanted = small.matches && !document.hidden;
    if (!navigator.wakeLock) return say();
    try {
        if (is_wanted && (!lock || lock.released)) lock = await navigator.wakeLock.request("screen");
        else if (!is_wanted) await lock?.release();
        refusal = "";
    } catch {
        refusal = tr("this browser does not keep the screen on now, perhaps to save the battery");
    }
    say();
}

document.addEventListener("visibilitychange", keep_awake);
small.addEventListener("change", keep_awake);
keep_awake();
