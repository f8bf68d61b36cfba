// Sounds and vibrations for an operator who does not look at the screen.  They are off until a button turns them on, because
// browsers allow sound only after a press.

import { by_id, set_text } from "./dom.js";
import { tr } from "./language.js";

const kTone_s = 0.16;
const kStep_s = 0.22; // From one tone to the next.
const kLoudness = 0.5;

// Tones in Hz, which small loudspeakers reproduce, and vibrations in ms: on, off, on.  The last one is the most important.
const kSignals = {
    due: { tones_hz: [1047, 784], vibration_ms: [120, 120, 120] },
    look: { tones_hz: [784, 1047, 1568], vibration_ms: [250, 120, 250] },
    fault: { tones_hz: [494, 494, 494, 494], vibration_ms: [700, 200, 700] },
};

let audio = null; // Made at the first press of the button.
let is_on = false;
let before = null; // The states when they were last followed.

function sound(tones_hz) {
    audio.resume(); // A telephone call may have suspended it.
    tones_hz.forEach((tone_hz, i) => {
        const oscillator = audio.createOscillator();
        const volume = audio.createGain();
        const begin_s = audio.currentTime + i * kStep_s;
        oscillator.frequency.value = tone_hz;
        volume.gain.setValueAtTime(kLoudness, begin_s);
        volume.gain.linearRampToValueAtTime(0, begin_s + kTone_s); // Without a click at the end.
        oscillator.connect(volume).connect(audio.destination);
        oscillator.start(begin_s);
        oscillator.stop(begin_s + kTone_s);
    });
}

function toggle() {
    is_on = !is_on;
    set_text("sound-switch", is_on ? tr("Sound is on") : tr("Sound is off"));
    by_id("sound-switch").setAttribute("aria-pressed", is_on);
    if (!is_on) return;
    audio ??= new AudioContext();
    sound([784]); // The operator hears how loud it is.
}

/** Signals the states that have just become true: once per change, and none at the first call.
    @param states  { due, look, fault }: set-up or plan complete, a contradiction, no data or a fault. */
export function follow(states) {
    const fresh = Object.keys(kSignals).filter((name) => before && states[name] && !before[name]);
    before = states;
    if (!is_on || fresh.length === 0) return;
    const { tones_hz, vibration_ms } = kSignals[fresh.at(-1)];
    sound(tones_hz);
    navigator.vibrate?.(vibration_ms);
}

by_id("sound-switch").addEventListener("click", toggle);
