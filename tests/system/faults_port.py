"""Ports that are unplugged and plugged in again, and a sensor that changes its baud rate, numbered as in fault-list.md.

At 20x one second of signal is 50 ms of the host's time.
"""

import re
import signal
import time

from emulated_session import Session, gaps_of, require_unread, wait_for
from fault_table import FaultTable
from programs import Scratch, together

table = FaultTable()


def is_archive_true(session, missing=0):
    return all(one["matched"] > 0 and one["altered"] == one["duplicated"] == 0 and one["missing"] == missing
               for one in session.counted().values())


def unplug(session, order):
    """Unplugs the port by this order, waits for new frames and returns the daemon's counters."""
    before = session.emulated()["frames_sent"]
    session.order(order)
    wait_for("the port is gone", lambda: not (session.scratch / "sensor").is_symlink())
    wait_for("the port is back", lambda: (session.scratch / "sensor").is_symlink())
    wait_for("frames again", lambda: session.emulated()["frames_sent"] > before + 1000)
    return session.settled()


# The device continues sampling; its counter shows how many samples each outage cost.
def outages():
    with Scratch() as scratch:
        session = Session(scratch)
        session.wait_for_frames(1000)
        first = session.status()["session"]
        names = [(scratch / "sensor").readlink()]
        for seconds in (5, 30, 100, 300):
            unplug(session, f"hang_up seconds={seconds}")
            names.append((scratch / "sensor").readlink())
        status = session.status()
        report, counters = session.end()
        gaps, missing = gaps_of(session.truth())
        unread = report["frames_sent"] - counters["frames"]
        require_unread(report, unread, outages=4)
        missing += unread
        is_true = is_archive_true(session, unread)
        is_one = (status["session"] == first and counters["sessions"] == len(report["runs"]) == 1
                  and counters["link_adoptions"] == 4 and status["device"]["assumed"])
        table.note(9, "unplugged, plugged in under another name",
                   f"4 outages, {report['frames_lost_unplugged']} frames lost, {counters['samples_missing']} samples "
                   f"missing, {counters['sessions']} session, {len(set(names))} names", len(set(names)) > 1 and is_one and is_true)
        table.note(10, "outages of 5, 30, 100 and 300 s",
                   f"{counters['gaps']} gaps of {counters['samples_missing']}, truth {gaps} of {missing}",
                   (counters["gaps"], counters["samples_missing"]) == (gaps, missing))


# A host that does not read for longer than several wraps of the counter; the receive buffer keeps 4095 bytes.
def host_that_does_not_read():
    with Scratch() as scratch:
        session = Session(scratch)
        session.wait_for_frames(1000)
        session.order("overrun")
        for seconds in (4.4, 4.7, 6.0):
            session.daemon.send_signal(signal.SIGSTOP)
            time.sleep(seconds)
            session.daemon.send_signal(signal.SIGCONT)
            session.settled()
        report, counters = session.end()
        gaps, missing = gaps_of(session.truth())
        table.note(10, "host does not read for 88, 94 and 120 s",
                   f"{counters['gaps']} gaps of {counters['samples_missing']}, truth {gaps} of {missing}",
                   (counters["gaps"], counters["samples_missing"]) == (gaps, missing) and counters["sessions"] == 1
                   and is_archive_true(session))


# The device loses its power: a new session begins, and no gap is counted.
def outage_without_power():
    with Scratch() as scratch:
        session = Session(scratch)
        session.wait_for_frames(1000)
        first = session.status()["session"]
        unplug(session, "hang_up seconds=40 loses_power=true")
        status = session.status()
        report, counters = session.end()
        table.note(9, "unplugged and without power",
                   f"{counters['sessions']} sessions, {len(report['runs'])} runs, {counters['link_adoptions']} adopted, "
                   f"{counters['samples_missing']} samples missing, archive "
                   f"{[int(one['missing']) for one in session.counted().values()]}",
                   counters["sessions"] == len(report["runs"]) == 2 and counters["link_adoptions"] == 0
                   and status["session"] != first and not status["device"]["assumed"] and is_archive_true(session))


# The daemon is killed and started again.
def killed_daemon():
    with Scratch() as scratch:
        session = Session(scratch, speed=5)
        session.wait_for_frames(1000)
        first = session.status()["session"]
        session.daemon.send_signal(signal.SIGKILL)
        session.daemon.wait()
        time.sleep(1)
        session.daemon = session.start_daemon()
        wait_for("the new daemon adopts the stream", lambda: session.status().get("counters", {}).get("link_adoptions") == 1)
        session.wait_for_frames(2000)
        status = session.status()
        report, counters = session.end()
        missing = {int(one["missing"]) for one in session.counted().values()}
        table.note(1, "the stream of a killed daemon", f"{max(missing)} samples missing, limit 50; {len(report['runs'])} run",
                   status["session"] == first and len(report["runs"]) == 1 and max(missing) <= 50
                   and is_archive_true(session, *missing))


# The device changes its baud rate: the daemon finds the new rate and uses it.
def changed_baud():
    with Scratch() as scratch:
        session = Session(scratch)
        session.wait_for_frames(1000)
        session.order("change_baud")
        wait_for("frames at the other baud rate", lambda: session.status()["counters"]["link_sessions"] == 2
                 and session.emulated()["runs"][-1]["frames"] > 500)
        status = session.status()
        reason = " ".join(status["reasons"])
        session.settled()
        report, counters = session.end()
        drained = report["frames_sent"] - counters["frames"]  # Sent before the daemon had stopped the sensor at its baud rate.
        baud = re.search(rb'"baud":(\d+)', sorted((scratch / "data" / "journal").glob("*.a351j"))[-1].read_bytes())
        table.note(22, "changed baud rate",
                   f"{report['frames_damaged']} frames until the rate was found, {drained} drained, "
                   f"then {status['device']['port'].split(',')[1]}",
                   "115200 baud, not at the configured 460800" in reason and baud is not None and baud[1] == b"115200"
                   and counters["sessions"] == 2 and 0 <= drained < 5000 and is_archive_true(session, drained))


def others():
    host_that_does_not_read()
    outage_without_power()
    killed_daemon()
    changed_baud()


together(outages, others)  # Both wait most of their time.
table.finish()
