"""Draws every view of the page to look at: all sizes, both schemes, both languages.

usage: A351_BIN=build/release/bin /usr/bin/python3 tests/page/looks.py [PART]
Writes screenshots/looks/VIEW-WIDTH-SCHEME-LANGUAGE.png beside A351_BIN; PART: only views whose name has it.
"""

import sys
import time

from browser import SCREENSHOTS, Browser
from gloves import SIZES
from made_up import (MISSING, MOVED, SIGNALS, finding, finished, gravity, no_stay, occupation, reading, signal, sites, stay, survey, tilt)
from stub_daemon import StubDaemon

PART = sys.argv[1] if len(sys.argv) > 1 else ""
DIALOGS = {"stop": ("#stop", "#confirm-stop"), "discard": ("#day-discard", "#discard"), "rename": ("#day-rename", "#rename"),
           "times": ("#day-times", "#times"), "help": ("#help-open", "#help")}


def key_of(i):
    return f"20260301T00{i:02}00Z"


def made_up_day():
    stub = StubDaemon()
    stub.sites = sites()
    stub.occupations = [{**finished(f"No.{i}", hours_ago=7 - 0.5 * i), "key": key_of(i)} for i in range(12)]
    differences = {0: 0.42, 3: -1.16, 5: 12.1}
    stub.survey = survey([*(stay(f"No.{i}", gravity_mgal=979861.32 - 6.37 * i, difference_mgal=differences.get(i), key=key_of(i)) for i in range(12)),
                          stay("No.12", gravity_mgal=979782.11, is_running=True)],
                         [finding("No.5 (1) reads like No.3: it is 12.1 mGal too high for No.5", True, key_of(5))])
    return stub


def words(stub, browser, shot):
    for word in SIGNALS:
        stub.status["signal"] = signal(word)
        stub.status["tilt"] = tilt(2.4, -0.6, ["lower the +x side by 2.4'", "raise the +y side by 0.6'"]) if word == "lift" else None
        stub.status["occupation"] = occupation("No.12", gravity=MISSING if word == "keep_off" else gravity(979782.11), moved=MOVED if word == "look" else None)
        browser.wait_for(f"{word} is shown", lambda: browser.find("#signal").get_attribute("data-word") == word)  # noqa: B023
        shot(word)
    stub.status["level"], stub.status["reasons"] = "fault", ["the disk of the data root is full"]
    browser.wait_for("a fault is shown", lambda: browser.text("trouble") != "")
    shot("fault")
    stub.status["level"], stub.status["reasons"] = "good", []


def unfolded(stub, browser, shot):
    test = reading(set_ups=13, set_up_sd_mgal=1.31, set_up_sd_limits_mgal=[0.94, 2.16], set_up_error_mgal=0.36)
    stub.status["occupation"] = occupation("No.0", set_up_count=13, planned_set_ups=20, planned_s=3600.0, has_own_plan=True, whole=test)
    browser.wait_for("the placement test runs", lambda: browser.text("run-test") != "")
    shot("test")
    browser.run(f"document.querySelector('#day-rows [data-key=\"{key_of(5)}\"]').click()")
    for name, (button, dialog) in DIALOGS.items():
        browser.click(button)
        browser.wait_for(f"the dialog {name} is open", lambda: browser.text(dialog[1:]) != "")  # noqa: B023
        shot(f"dialog-{name}")
        browser.press("\ue00c")  # Escape.
    stub.status["occupation"], stub.status["signal"] = None, no_stay()
    browser.wait_for("no stay runs", lambda: browser.text("start") != "")
    shot("start")
    for part in ("more", "details"):
        browser.open_details(identifier=part)
    shot("unfolded", True)
    browser.click("#add-site")
    shot("dialog-new-site")


def look(language, size, scheme):
    with Browser(language=f"{language},en") as browser:
        stub = made_up_day()
        time.sleep(0.3)
        browser.resize(size)
        browser.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": scheme}]})
        browser.open(stub.port)

        def shot(view, is_whole=False):
            if PART in view:
                time.sleep(0.4)
                browser.shot(f"looks/{view}-{size[0]}-{scheme}-{language}", is_whole)
        words(stub, browser, shot)
        unfolded(stub, browser, shot)


(SCREENSHOTS / "looks").mkdir(parents=True, exist_ok=True)
for a_language in ("en", "ja"):
    for a_size in SIZES:
        for a_scheme in ("light", "dark"):
            look(a_language, a_size, a_scheme)
print(f"the pictures are in {SCREENSHOTS / 'looks'}")
