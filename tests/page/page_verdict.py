"""The page shows each verdict that a real daemon comes to: cold, run in, at rest, shaken and unplugged."""

import time

from browser import Browser
from emulated_session import Session, wait_for
from programs import IS_SANITIZED, Scratch, demand

SPEED = 30 if IS_SANITIZED else 100
# A busy host pauses for longer than 10 s of this time.
CONFIG = "[verdict]\ngap_s = 60.0\nstuck_s = 120.0\n"
# A set point that the box is 2.5 degC below.
COLD = CONFIG + "operating_degc = 45.0\n"


def follow(session, browser, wanted, seconds):
    """Waits until page and daemon have been of one mind about each of `wanted`, in whatever order."""
    wanted, end = set(wanted), time.monotonic() + seconds
    while wanted and time.monotonic() < end:
        word = browser.text("verdict-word").lower()
        if word in wanted and session.status()["verdict"]["state"] == word:
            checks = browser.text("verdict-checks").splitlines()
            print(f"{browser.text('clock')}: {word}: {checks[0]}")
            browser.shot(f"real-{word.replace(' ', '-')}-1366")
            wanted.remove(word)
        time.sleep(0.05)
    demand(f"within {seconds} s the page came to every verdict; missing: {wanted}", not wanted)


with Browser(allowed_errors=["WebSocket connection to", "Failed to load resource"]) as page:
    with Scratch() as scratch:
        daemon = Session(scratch, speed=SPEED, config=COLD)
        wait_for("the daemon", daemon.status)
        page.open(daemon.port)
        follow(daemon, page, {"warming up"}, 20)
    with Scratch() as scratch:
        daemon = Session(scratch, speed=SPEED, config=CONFIG)
        wait_for("the daemon", daemon.status)
        page.open(daemon.port)
        follow(daemon, page, {"settling", "stable", "disturbed"}, 6000 / SPEED)
        daemon.order("silence seconds=100000")
        follow(daemon, page, {"no data"}, 20)
