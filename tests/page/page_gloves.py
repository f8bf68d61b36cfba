"""A stay of a real daemon by keyboard alone, and one by touch alone: start, next set-up, stop, undo the stop, stop again."""

import json
import time

from browser import Browser, Keys
from emulated_session import Session
from programs import Scratch, demand

MOST_TABS = 20


def tab_to(browser, identifier):
    for count in range(MOST_TABS):
        if browser.run("return document.activeElement.id") == identifier:
            print(f"holds: {identifier} has the focus after {count} presses of Tab")
            return
        browser.press(Keys.TAB)
    demand(f"Tab reaches {identifier} within {MOST_TABS} presses", False)


def press_key(browser, identifier, text=""):
    tab_to(browser, identifier)
    if text:
        browser.press(text)
    else:
        browser.press(Keys.ENTER)


def tap(browser, identifier, text=""):
    """Taps the middle of an element; no mouse event is made by the test."""
    element = browser.find(f"#{identifier}")
    browser.run("arguments[0].scrollIntoView({block: 'center'})", element)
    box = browser.run("const b = arguments[0].getBoundingClientRect(); return [b.left + b.width / 2, b.top + b.height / 2];", element)
    for kind, points in (("touchStart", [{"x": box[0], "y": box[1]}]), ("touchEnd", [])):
        browser.driver.execute_cdp_cmd("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
    time.sleep(0.4)  # Chromium waits for a second tap.
    if text:
        browser.driver.execute_cdp_cmd("Input.insertText", {"text": text})


def confirm_stop(session, browser, act, site):
    act(browser, "stop")
    browser.wait_for_text("confirm-stop-text", f"Stop {site}")
    act(browser, "confirm-stop-yes")
    browser.wait_for("the stay is stopped", lambda: session.status()["occupation"] is None)
    browser.wait_for_text("start", "Start")


def run_a_stay(session, browser, act, site):
    before = len(json.loads(session.ctl("list", "--json"))["occupations"])
    act(browser, "start-name", site)
    act(browser, "start")
    browser.wait_for_text("run-site", site)
    act(browser, "setup")
    browser.wait_for("the second set-up runs", lambda: session.status()["occupation"]["set_up_count"] == 2)
    confirm_stop(session, browser, act, site)
    browser.wait_for_text("day-rows", f"{site} (1)")
    act(browser, "resume-last")
    browser.wait_for_text("run-site", site)
    confirm_stop(session, browser, act, site)
    stays = json.loads(session.ctl("list", "--json"))["occupations"]
    last = stays[-1]
    demand(f"the log has one further stay, at {last['site']} with {len(last['set_ups'])} set-ups",
           (len(stays) - before, last["site"], len(last["set_ups"])) == (1, site, 2))


with Scratch() as scratch, Browser() as page:
    daemon = Session(scratch, speed=1)
    daemon.wait_for_frames(50)
    page.driver.get(f"http://127.0.0.1:{daemon.port}/")
    page.wait_for_text("clock", "UTC")
    for size in ((1366, 768), (800, 480)):
        page.resize(size)
        run_a_stay(daemon, page, press_key, f"keys-{size[0]}")
    page.driver.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": True})
    for size in ((390, 844), (800, 480)):
        page.resize(size)
        time.sleep(1.0)  # A tap meets a place, which must not move any more.
        run_a_stay(daemon, page, tap, f"touch-{size[0]}")
