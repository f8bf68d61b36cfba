"""Sounds come once per change and never before the button; the page keeps the screen on, or says what to set by hand; the help needs no network.

Over plain http and a name other than localhost, as on a telephone, browsers have no wake lock.
"""

import time

from browser import LAPTOP, Browser
from gloves import SIZES
from made_up import no_stay, occupation, signal, sites
from programs import demand
from stub_daemon import StubDaemon

REMOTE = "recorder.example"  # Resolves to this host, but is not trusted as localhost is.

# Counts tones and vibrations instead of making them.
COUNTER = """
window.tones_hz = []; window.vibrations = []; window.locks = 0;
window.AudioContext = class {
    currentTime = 0; destination = {};
    resume() {}
    createGain() { return { gain: { setValueAtTime() {}, linearRampToValueAtTime() {} }, connect: (next) => next }; }
    createOscillator() {
        const frequency = { value: 0 };
        return { frequency, connect: (next) => next, stop() {}, start() { window.tones_hz.push(frequency.value); } };
    }
};
navigator.vibrate = (pattern) => { window.vibrations.push(pattern); return true; };
const lock = () => { ++window.locks; return Promise.resolve({ released: false, release() { this.released = true; --window.locks; } }); };
if (navigator.wakeLock) navigator.wakeLock.request = lock;
"""


def heard(browser):
    """Returns the tones since the last call."""
    return browser.run("return window.tones_hz.splice(0)")


def demand_signals(stub, browser):
    stub.status["signal"] = signal("lift")
    browser.wait_for_text("signal-word", "LIFT")
    time.sleep(0.5)
    demand("nothing sounds before the button is pressed", heard(browser) == [])
    browser.click("#sound-switch")
    demand("the button sounds once, and says that it is on", len(heard(browser)) == 1 and browser.text("sound-switch") == "Sound is on")
    time.sleep(1.5)
    demand("a state that was there before is not signalled", heard(browser) == [])
    for word, change, count in (("KEEP OFF", lambda: stub.status.update(signal=signal("keep_off")), 0),
                                ("LIFT, SET DOWN", lambda: stub.status.update(signal=signal("lift")), 2),
                                ("KEEP OFF again", lambda: stub.status.update(signal=signal("keep_off")), 0),
                                ("YOU CAN GO", lambda: stub.status.update(signal=signal("go")), 2),
                                ("no stay", lambda: stub.status.update(signal=no_stay(), occupation=None), 0),
                                ("LOOK", lambda: stub.status.update(signal=signal("look", buttons=["checked"])), 3),
                                ("NO DATA", lambda: stub.status.update(signal=signal("no_data")), 4),
                                ("data again", lambda: stub.status.update(signal=signal("keep_off"), occupation=occupation()), 0),
                                ("FAULT", lambda: stub.status.update(level="fault", reasons=["the disk is full"]), 4),
                                ("good again", lambda: stub.status.update(level="good", reasons=[]), 0),
                                ("old data", lambda: setattr(stub, "is_sampling", False), 4)):
        vibrations = browser.run("return window.vibrations.length")
        change()
        time.sleep(4.5 if word == "old data" else 2.5)
        tones = heard(browser)
        demand(f"{word}: {len(tones)} tones in some seconds, expected {count}: {tones}", len(tones) == count)
        demand(f"{word}: its tones fall", count != 2 or tones == sorted(tones, reverse=True))
        demand(f"{word}: it vibrates as often as it sounds",
               browser.run("return window.vibrations.length") - vibrations == (1 if count else 0))
    stub.is_sampling = True
    browser.wait_for("new data are shown", lambda: browser.text("banner") == "")
    browser.driver.refresh()
    browser.wait_for_text("signal-word", "KEEP OFF")
    time.sleep(1.5)
    demand("after a reload the sound is off", heard(browser) == [] and browser.text("sound-switch") == "Sound is off")


def demand_awake(browser):
    demand("the page leaves the screen of a laptop alone", browser.run("return window.locks") == 0)
    browser.resize(SIZES[1])
    browser.wait_for("it keeps a small screen on", lambda: browser.run("return window.locks") == 1)
    demand("then nothing is to be set by hand", browser.text("awake") == "")
    browser.resize(LAPTOP)
    browser.wait_for("it releases the screen of a laptop", lambda: browser.run("return window.locks") == 0)
    browser.run("navigator.wakeLock.request = () => Promise.reject(new Error('battery'));")
    browser.resize(SIZES[1])
    browser.wait_for_text("awake", "set the screen timeout to 30 min by hand")
    browser.click("#help-open")
    browser.wait_for_text("help-screen", "perhaps to save the battery. Therefore set the screen timeout of this device")
    browser.click("#help-close")


def demand_remote(stub, browser):
    browser.driver.get(f"http://{REMOTE}:{stub.port}/")
    browser.wait_for("a stay runs", lambda: browser.text("stop") != "")
    demand("a name of the network is no secure context", not browser.run("return isSecureContext"))
    for width, height in SIZES[1:]:
        browser.resize((width, height))
        browser.demand_readable(f"the page of a telephone, {width} x {height}", 64)
        browser.wait_for_text("awake", "set the screen timeout to 30 min by hand")
        browser.run("scrollTo(0, 0)")  # The help was opened at the end of the page.
        demand("Stop is visible without scrolling", browser.is_above_fold("stop"))
        browser.shot(f"remote-{width}")
        browser.click("#help-open")
        browser.wait_for_text("help-screen", "over plain http from another device browsers do not keep the screen on. Therefore set")
        stub.is_away = True
        browser.demand_readable(f"the help, {width} x {height}", 64)
        demand("its button is visible without scrolling", browser.is_above_fold("help-close"))
        browser.shot(f"help-{width}")
        browser.click("#help-close")
        browser.wait_for_text("banner", "CONNECTION LOST")
        browser.click("#help-open")
        demand("the help opens without a connection", browser.text("help-title") == "Help")
        browser.click("#help-close")
        stub.is_away = False
        browser.wait_for("the page is connected again", lambda: browser.text("banner") == "", seconds=12)


LOST = ["WebSocket connection to", "ERR_EMPTY_RESPONSE", "Failed to load resource"]

with Browser(allowed_errors=LOST, may_ask={REMOTE},
             rules=f"MAP {REMOTE} 127.0.0.1, MAP * ~NOTFOUND, EXCLUDE 127.0.0.1") as page:
    daemon = StubDaemon()
    daemon.sites = sites()
    daemon.status["occupation"] = occupation()
    time.sleep(0.3)
    page.driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": COUNTER})
    page.open(daemon.port)
    page.wait_for_text("clock", "UTC")
    demand_signals(daemon, page)
    demand_awake(page)
    demand_remote(daemon, page)
