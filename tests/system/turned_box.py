"""A vertical axis that differs from that before the start is a fault with its remedy; the next start accepts it.

The emulated box is turned over between two runs of the daemon.
"""

from emulated_session import Session, wait_for
from programs import Scratch, demand, end_cleanly

SPEED = 10
UPRIGHT, TURNED = "2017-06-02T00:32:00Z", "2017-06-02T00:42:00Z"  # Set-ups of the scenario tumble, 8 min are left of each.
FRAMES = 2000  # 40 s
WORDS = "the vertical axis is -z, but before the start it was +z"
REMEDY = "if the box was turned on purpose, start the recorder again"


def found(session):
    return [reason for reason in session.status().get("reasons", []) if reason.startswith(WORDS)]


with Scratch() as scratch:
    session = Session(scratch, speed=SPEED, scenario="tumble", start=UPRIGHT)
    session.wait_for_frames(FRAMES)
    demand("the first run has nothing to compare with", not found(session))
    session.end()

    session = Session(scratch, speed=SPEED, scenario="tumble", start=TURNED)
    wait_for("the fault", lambda: found(session))
    demand(f"it ends with its remedy: {found(session)}", found(session)[0].endswith(REMEDY))
    demand("the level is fault", session.status()["level"] == "fault")
    end_cleanly("the daemon", session.daemon)
    session.daemon = session.start_daemon()
    sent = session.emulated()["frames_sent"]
    wait_for("40 s more", lambda: session.emulated()["frames_sent"] > sent + FRAMES)
    demand(f"the next start accepts the box: {found(session)}", not found(session))
    session.end()
