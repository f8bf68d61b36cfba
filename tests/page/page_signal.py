"""The page shows each word of the signal of a real daemon, and the terminal the same."""

import time

from browser import Browser
from emulated_session import Session, wait_for
from programs import IS_SANITIZED, Scratch, demand

SPEED = 30 if IS_SANITIZED else 100
# Longer than the defaults, because a pause of a busy host can be more than 10 s of simulated time.
CONFIG = "[verdict]\ngap_s = 60.0\nstuck_s = 120.0\n"
# Set point 2.5 degC above the temperature of the box.
COLD = CONFIG + "operating_degc = 45.0\n"


def follow(session, browser, wanted, seconds):
    """Waits until page and daemon have shown the same word for each of `wanted`, in any order."""
    wanted, end = set(wanted), time.monotonic() + seconds
    while wanted and time.monotonic() < end:
        word = browser.text("signal-word")
        if word in wanted and session.status()["signal"]["text"] == word:
            print(f"{browser.text('clock')}: {word}: {browser.text('signal-sentence')}")
            browser.shot(f"real-{word.lower().replace(' ', '-').replace(',', '')}-1366")
            wanted.remove(word)
        time.sleep(0.05)
    demand(f"within {seconds:g} s the page showed every expected word; missing: {wanted or 'none'}", not wanted)


with Browser(allowed_errors=["WebSocket connection to", "Failed to load resource"]) as page:
    with Scratch() as scratch:
        daemon = Session(scratch, speed=SPEED, config=COLD)
        wait_for("the daemon answers", daemon.status)
        page.open(daemon.port)
        follow(daemon, page, {"WARMING UP"}, 20)
    with Scratch() as scratch:
        daemon = Session(scratch, speed=SPEED, config=CONFIG)
        wait_for("the daemon answers", daemon.status)
        page.open(daemon.port)
        follow(daemon, page, {"NO STAY RUNS"}, 6000 / SPEED)
        daemon.ctl("start", "No.1", "--set-ups", "2")
        follow(daemon, page, {"KEEP OFF", "LIFT, SET DOWN"}, 6000 / SPEED)
        daemon.order("silence seconds=100000")
        follow(daemon, page, {"NO DATA"}, 20)
