"""The field view: readable at arm's length, usable with gloves, without scrolling sideways; light and dark; both choices are remembered."""

import time

from browser import LAPTOP, Browser
from gloves import SIZES, demand_for_gloves
from made_up import finding, finished, occupation, reading, sites, stay, survey, tilt, verdict
from programs import demand
from stub_daemon import StubDaemon


def show_stays(stub, browser):
    stub.status["verdict"] = {**verdict("settling"), "time_left_s": 184.0}
    stub.status["occupation"] = occupation()
    stub.status["tilt"] = tilt(0.4, 0.3)
    browser.wait_for_text("run-judgement", "still about 4 min 10 s needed")
    demand_for_gloves(browser, "settling", "run-value", ["verdict-word", "run-time", "run-plan", "run-value", "run-judgement", "stop", "setup", "tools"])

    stub.status["verdict"] = verdict("stable", 430)
    stub.status["occupation"] = occupation(whole=reading(0.82, 0.0, True))
    stub.survey = survey([stay("No.0"), stay("No.5", is_running=True)])
    browser.wait_for_text("run-gravity", "979861.32 ± 1.27 mGal gravity so far", seconds=10)
    browser.wait_for_text("run-judgement", "✓ GOOD ENOUGH")
    demand_for_gloves(browser, "good enough", "run-gravity", ["verdict-word", "run-time", "run-plan", "run-gravity", "run-judgement", "stop", "setup", "tools"])
    stub.survey = {**stub.survey, "reason": "killed", "reason_text": "signal 9 ended it"}
    browser.wait_for("old figures are not shown as the value", lambda: browser.text("run-gravity") == "", seconds=10)

    stub.status["verdict"] = verdict("disturbed", 12)
    stub.status["occupation"] = occupation(moved={"utc": "2026-03-01T01:43:20.000Z", "is_at_start": False})
    stub.status["tilt"] = tilt(2.4, -0.6, ["lower the +x side by 2.4'", "raise the +y side by 0.6'"])
    browser.wait_for_text("moved-text", "The box was moved at 01:43:20 UTC")
    browser.wait_for_text("level-advice", "lower the +x side by 2.4′")
    demand_for_gloves(browser, "moved", "run-value", ["verdict-word", "stop"])

    stub.status["level"], stub.status["reasons"] = "fault", ["the disk of the data root is full"]
    stub.status["verdict"] = verdict("no data", 42)
    stub.status["occupation"] = occupation(propose_set_up=True)
    browser.wait_for_text("trouble", "FAULT: the disk")
    demand_for_gloves(browser, "fault", "run-value", ["verdict-word", "trouble", "stop"])
    stub.status["level"], stub.status["reasons"] = "good", []
    stub.status["verdict"], stub.status["tilt"] = verdict("stable", 500), tilt(0.4, 0.3)

    stub.status["occupation"] = occupation()
    browser.wait_for("the fault is gone", lambda: browser.text("trouble") == "")
    browser.click("#stop")
    browser.wait_for_text("confirm-stop-text", "Stop No.5")
    demand_for_gloves(browser, "stop", None, ["confirm-stop-yes", "confirm-stop-no"])
    browser.click("#confirm-stop-yes")
    browser.wait_for("the order to stop is sent", lambda: stub.posts[-1:] and stub.posts[-1][0] == "/api/occupation/stop")


def show_between_stays(stub, browser):
    stub.occupations = [finished("No.0", hours_ago=2), finished("No.5", hours_ago=0.2)]
    stub.occupations[-1]["key"] = "20260301T013000Z"
    headline = "No.5 (1) reads like No.7: it is 12.1 mGal too high for No.5"
    stub.survey = survey([stay("No.5", difference_mgal=12.1)], [finding(headline, True), finding("a remark", False)])
    stub.status["occupation"] = None
    stub.status["verdict"] = verdict("warming up")
    browser.wait_for_text("last-value", "979861.32 ± 1.27 mGal gravity so far", seconds=10)
    demand("a known benchmark shows its difference", browser.text("last-name") == "Last stay: No.5 (1), left out − reference +12.10 mGal")
    browser.wait_for_text("gravity-findings", headline)
    demand("of the findings only the headline is shown", browser.text("gravity-findings") == headline)
    demand_for_gloves(browser, "between stays", "last-value", ["verdict-word", "start-site", "start"])


def remember(stub, browser):
    view = "return document.documentElement.classList.contains('field')"
    browser.click("#view-switch")
    browser.wait_for("the button leads to the full page", lambda: browser.text("health-rows") != "")
    browser.open(stub.port)
    browser.wait_for_text("clock", "UTC")
    demand("the full page is remembered", not browser.run(view))
    browser.click("#view-switch")
    demand("the address has the view", browser.run("return location.hash") == "#field")
    browser.click("#scheme-switch")
    browser.open(stub.port)
    browser.wait_for_text("clock", "UTC")
    demand("the field view is remembered", browser.run(view))
    demand("the dark scheme is remembered", browser.run("return document.documentElement.dataset.scheme") == "dark")
    browser.driver.get(f"http://127.0.0.1:{stub.port}/#page")
    browser.wait_for_text("health-rows", "interface 1")
    demand("the address decides before the memory", not browser.run(view))
    for size in SIZES:
        browser.resize(size)
        browser.demand_readable(f"the full page in dark colours at {size[0]} px")
        time.sleep(0.5)
        browser.shot(f"dark-{size[0]}", is_whole=True)
    browser.resize(LAPTOP)


with Browser() as page:
    daemon = StubDaemon()
    daemon.sites = sites()
    time.sleep(0.3)
    page.driver.get(f"http://127.0.0.1:{daemon.port}/#field")
    page.wait_for_text("clock", "UTC")
    show_stays(daemon, page)
    show_between_stays(daemon, page)
    remember(daemon, page)
