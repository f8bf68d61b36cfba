"""A small disk is filled up and emptied under the daemon at 20x: the archive must hold every sample that was sent.

Disks that fail, stall or turn read-only: fault-list.md.
"""

import time

import small_disk
from emulated_session import Session, wait_for
from programs import Scratch, demand, run
from small_disk import RESERVE

SPEED = 20


def has_reason(session, beginning):
    return any(reason.startswith(beginning) for reason in session.status()["reasons"])


def archive_size(scratch):
    return sum(file.stat().st_size for file in (scratch / "data" / "archive").rglob("*.D.*"))


def fill(session, data):
    """Fills the disk up to the reserve."""
    small_disk.fill(data / "filler")
    wait_for("the reserve is released", lambda: session.status()["disk"]["reserve"] == "given_up")


def fill_reserve(session, data):
    small_disk.fill(data / "filler2")
    wait_for("the journal has a fault", lambda: session.status()["counters"]["journal_faults"] > 0)


def full_and_emptied():
    with Scratch() as scratch:
        data = scratch / "data"
        small_disk.mount(data)
        session = Session(scratch, speed=SPEED)
        reserve = data / "state" / "reserve"
        session.wait_for_frames(1000)
        wait_for("the reserve of 64 MiB exists and its blocks are allocated",
                 lambda: session.status()["disk"]["reserve"] == "present" and reserve.stat().st_blocks * 512 >= RESERVE)
        fill(session, data)
        before, size = session.status(), archive_size(scratch)
        wait_for("3000 more samples are journaled", lambda: session.status()["journaled"] >= (before["journaled"]
                                                                                              or 0) + 3000)
        state = session.status()
        demand(f"the status reports the fault: {state['reasons']}", state["level"] == "fault"
               and has_reason(session, "disk full"))
        demand(f"{state['disk']['free_bytes']} bytes are free for the journal, and the journal has no fault",
               0 < state["disk"]["free_bytes"] <= RESERVE and state["counters"]["journal_faults"] == 0)
        demand("the archive is not written meanwhile", archive_size(scratch) == size
               and state["counters"]["archive_records_waiting"] > 0)
        session.ctl("note", "in the reserve")

        fill_reserve(session, data)
        demand(f"the status reports the fault: {session.status()['reasons']}", has_reason(session, "journal: "))
        time.sleep(3.0)
        journaled = session.status()["journaled"]
        (data / "filler").unlink()
        (data / "filler2").unlink()
        wait_for("the fault is over and the reserve is back",
                 lambda: (state := session.status())["disk"]["reserve"] == "present"
                 and state["journaled"] > journaled + 3 * 50 * SPEED and state["level"] != "fault")
        demand("the blocks of the reserve are allocated again", reserve.stat().st_blocks * 512 >= RESERVE)
        demand("the reserve was released once", session.status()["counters"]["reserve_given_up"] == 1)
        session.end()
        session.archive_is_true(missing=0)
        demand("the event is in the event log",
               "in the reserve" in "".join(file.read_text() for file in (data / "events").iterdir()))
        run("umount", data)


def stopped_when_full():
    with Scratch() as scratch:
        data = scratch / "data"
        small_disk.mount(data)
        session = Session(scratch, speed=SPEED)
        session.wait_for_frames(1000)
        fill(session, data)
        fill_reserve(session, data)
        session.daemon.terminate()
        status = session.daemon.wait(timeout=60)
        session.sim.terminate()
        session.sim.wait(timeout=30)
        last = (scratch / "a351d.log").read_text().split(" stopping\n")[1].splitlines()
        demand(f"stopped on a full disk it ends with {status}, and its last lines have the reason: {last}",
               status == 1 and any(" error: journal: " in line for line in last))
        run("umount", data)


small_disk.enter_own_mounts()
full_and_emptied()
stopped_when_full()
