"""Draws every view of the page to look at: all sizes, both schemes, both languages.

usage: A351_BIN=build/release/bin /usr/bin/python3 tests/page/looks.py [PART]
Writes screenshots/looks/VIEW-WIDTH-SCHEME-LANGUAGE.png beside A351_BIN; PART: only views whose name has it.
"""

import sys
import time

from browser import SCREENSHOTS, Browser
from gloves import SIZES
from made_up import finding, finished, occupation, reading, sites, stay, survey, tilt, verdict
from programs import demand
from stub_daemon import StubDaemon

PART = sys.argv[1] if len(sys.argv) > 1 else ""
DIALOGS = {"stop": ("#stop", "#confirm-stop"), "discard": ("#run-discard", "#discard"), "rename": ("#run-rename", "#rename"),
           "times": ("#run-times", "#times"), "help": ("#help-open", "#help")}


def made_up_day():
    stub = StubDaemon()
    stub.sites = sites()
    stub.occupations = [{**finished(f"No.{i}", hours_ago=7 - 0.5 * i), "key": f"20260301T00{i:02}00Z"} for i in range(12)]
    differences = {0: 0.42, 3: -1.16, 5: 12.1}
    stub.survey = survey([*(stay(f"No.{i}", gravity_mgal=979861.32 - 6.37 * i, difference_mgal=differences.get(i)) for i in range(12)),
                          {**stay("No.12", gravity_mgal=979782.11, is_running=True, set_ups=2), "u_evening_mgal": 0.87}],
                         [finding("No.5 (1) reads like No.3: it is 12.1 mGal too high for No.5", True)])
    return stub


def run_stay(stub, **changes):
    stub.status["verdict"] = verdict("stable", 430)
    stub.status["tilt"] = tilt(0.4, -0.3)
    stub.status["occupation"] = occupation("No.12", set_up_count=2, whole=reading(0.82, 0.0, True), set_up_left_s=45.0, **changes)


def field_views(stub, browser, shot):
    run_stay(stub)
    browser.wait_for("a stay runs", lambda: browser.text("run-gravity") != "", 15)
    shot("field-stay")
    stub.status["verdict"] = {**verdict("settling"), "time_left_s": 184.0}
    stub.status["tilt"] = tilt(2.4, -0.6, ["lower the +x side by 2.4'", "raise the +y side by 0.6'"])
    stub.status["occupation"] = occupation(moved={"utc": "2026-03-01T01:43:20.000Z", "is_at_start": False})
    browser.wait_for("a moved box is shown", lambda: browser.text("moved-text") != "")
    shot("field-moved")
    run_stay(stub)
    browser.wait_for("the box is still again", lambda: browser.text("moved-text") == "")
    browser.click("#stop")
    browser.wait_for("the dialog is open", lambda: browser.text("confirm-stop") != "")
    shot("field-stop")
    browser.click("#confirm-stop-no")
    stub.status["occupation"] = None
    stub.status["level"], stub.status["reasons"] = "fault", ["the disk of the data root is full"]
    stub.status["verdict"] = verdict("no data", 42)
    browser.wait_for("a fault is shown", lambda: browser.text("trouble") != "")
    shot("field-fault")
    stub.status["level"], stub.status["reasons"] = "good", []


def placement_test(stub, browser, shot):
    browser.wait_for("no stay runs", lambda: browser.text("start") != "")
    browser.run("document.getElementById('start-test').click()")
    shot("field-before-test")
    browser.run("document.getElementById('start-test').click()")
    test = {**reading(0.82, 0.0, True), "set_ups": 13, "set_up_sd_mgal": 1.31, "set_up_sd_limits_mgal": [0.94, 2.16], "set_up_error_mgal": 0.36}
    stub.status["verdict"] = verdict("stable", 100)
    stub.status["occupation"] = occupation("No.0", set_up_count=13, planned_set_ups=20, planned_s=3600.0, has_own_plan=True, whole=test,
                                           reading=reading(0.9), set_up_left_s=65.0)
    browser.wait_for("the placement test runs", lambda: "13" in browser.text("run-plan"))
    shot("field-test")


def full_page(stub, browser, shot):
    run_stay(stub)
    browser.click("#view-switch")
    browser.wait_for("the stays are shown", lambda: "979782" in browser.text("gravity-rows"), 15)
    time.sleep(1.0)
    shot("page", True)
    browser.run("document.getElementById('gravity').scrollIntoView()")
    shot("page-gravity")
    for name, (button, dialog) in DIALOGS.items():
        browser.click(button)
        browser.wait_for(f"the dialog {name} is open", lambda: browser.text(dialog[1:]) != "")  # noqa: B023
        shot(f"dialog-{name}")
        browser.press("\ue00c")  # Escape.
    stub.status["occupation"] = None
    browser.wait_for("no stay runs", lambda: browser.text("start") != "")
    browser.click("#add-site")
    shot("dialog-new-site")
    browser.press("\ue00c")


def look(language, size, scheme):
    with Browser(language=f"{language},en") as browser:
        stub = made_up_day()
        time.sleep(0.3)
        browser.resize(size)
        browser.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": scheme}]})
        browser.driver.get(f"http://127.0.0.1:{stub.port}/#field")

        def shot(view, is_whole=False):
            if PART in view:
                time.sleep(0.4)
                browser.shot(f"looks/{view}-{size[0]}-{scheme}-{language}", is_whole)
        field_views(stub, browser, shot)
        placement_test(stub, browser, shot)
        full_page(stub, browser, shot)


(SCREENSHOTS / "looks").mkdir(parents=True, exist_ok=True)
for a_language in ("en", "ja"):
    for a_size in SIZES:
        for a_scheme in ("light", "dark"):
            look(a_language, a_size, a_scheme)
print(f"the pictures are in {SCREENSHOTS / 'looks'}")
