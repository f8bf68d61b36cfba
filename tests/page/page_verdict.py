"""The page shows each verdict of a real daemon: cold, warmed up, at rest, disturbed and without data."""

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
    """Waits until page and daemon have shown the same verdict for each of `wanted`, in any order."""
    wanted, end = set(wanted), time.monotonic() + seconds
    while wanted and time.monotonic() < end:
        word = browser.text("verdict-word").lower()
        if word in wanted and session.status()["verdict"]["state"] == word:
            checks = browser.text("verdict-checks").splitlines()
            print(f"{browser.text('clock')}: {word}: {checks[0]}")
            browser.shot(f"real-{word.replace(' ', '-')}-1366")
            wanted.remove(word)
        time.sleep(0.05)
    demand(f"within {seconds:g} s the page showed every expected verdict; missing: {wanted or 'none'}", not wanted)


with Browser(allowed_errors=["WebSocket connection to", "Failed to load resource"]) as page:
    with Scratch() as scratch:
        daemon = Session(scratch, speed=SPEED, config=COLD)
        wait_for("the daemon answers", daemon.status)
        page.open(daemon.port)
        follow(daemon, page, {"warming up"}, 20)
    with Scratch() as scratch:
        daemon = Session(scratch, speed=SPEED, config=CONFIG)
        wait_for("the daemon answers", daemon.status)
        page.open(daemon.port)
        follow(daemon, page, {"settling", "stable", "disturbed"}, 6000 / SPEED)
        daemon.order("silence seconds=100000")
        follow(daemon, page, {"no data"}, 20)
