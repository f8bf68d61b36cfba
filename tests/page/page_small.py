"""The page on small screens: readable at arm's length, usable with gloves, without scrolling sideways; light and dark."""

from browser import LAPTOP, Browser
from gloves import SIZES, demand_for_gloves
from made_up import MOVED, SIGNALS, finished, gravity, no_stay, occupation, signal, sites, stay, survey, tilt
from programs import demand
from stub_daemon import StubDaemon

MAIN = ["signal-word", "signal-sentence", "signal-buttons", "run-site", "run-value"]


def show_stays(stub, browser):
    for word in ("keep_off", "lift", "go", "look"):
        stub.status["signal"] = signal(word)
        stub.status["occupation"] = occupation(gravity=gravity(), moved=MOVED if word == "look" else None)
        stub.status["tilt"] = tilt(2.4, -0.6, ["lower the +x side by 2.4'", "raise the +y side by 0.6'"]) if word == "lift" else None
        browser.wait_for_text("signal-word", SIGNALS[word][0])
        browser.wait_for_text("run-value", "979809.9 ± 1.3 mGal")
        demand_for_gloves(browser, word, "run-value", MAIN)
    stub.status["level"], stub.status["reasons"] = "fault", ["the disk of the data root is full"]
    stub.status["signal"] = signal("no_data")
    browser.wait_for_text("trouble", "FAULT: the disk")
    demand_for_gloves(browser, "fault", "run-value", ["trouble", *MAIN])
    stub.status["level"], stub.status["reasons"] = "good", []

    stub.status["signal"] = signal("keep_off")
    browser.wait_for("the fault is gone", lambda: browser.text("trouble") == "")
    browser.click("#stop")
    browser.wait_for_text("confirm-stop-text", "Stop No.5")
    demand_for_gloves(browser, "stop", None, ["confirm-stop-yes", "confirm-stop-no"])
    browser.click("#confirm-stop-yes")
    browser.wait_for("the order to stop is sent", lambda: stub.posts[-1:] and stub.posts[-1][0] == "/api/occupation/stop")


def show_between_stays(stub, browser):
    stub.occupations = [{**finished(f"No.{i}", hours_ago=2.0 - 0.3 * i), "key": f"key-{i}"} for i in range(6)]
    stub.survey = survey([stay(f"No.{i}", difference_mgal=-1.16 if i % 3 else 12.1, key=f"key-{i}") for i in range(6)])
    stub.status["occupation"], stub.status["signal"] = None, no_stay()
    browser.wait_for_text("day-rows", "+12.1", seconds=15)
    demand_for_gloves(browser, "between stays", None, ["signal-word", "signal-buttons", "start-site", "start"])
    browser.click("#day-rows tr")
    browser.open_details()
    browser.open_details(identifier="more")
    demand_for_gloves(browser, "all unfolded")


def remember(stub, browser):
    browser.resize(SIZES[1])
    demand("the other language is offered on a small screen", browser.text("language-switch") == "日本語")
    browser.resize(LAPTOP)
    browser.click("#scheme-switch")
    browser.open(stub.port)
    browser.wait_for_text("clock", "UTC")
    demand("the dark scheme is remembered", browser.run("return document.documentElement.dataset.scheme") == "dark")


with Browser() as page:
    daemon = StubDaemon()
    daemon.sites = sites()
    page.wait_for("samples arrive", lambda: daemon.samples)
    page.open(daemon.port)
    page.wait_for_text("clock", "UTC")
    show_stays(daemon, page)
    show_between_stays(daemon, page)
    remember(daemon, page)
