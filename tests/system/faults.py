"""Faults at 20x that need a real terminal, process or log: counters and archive must agree with the emulator's truth.

fault-list.md has all faults, with the tests that play each of them without programs.
"""

import json
import os
import re
import termios

from emulated_session import FRAME, Session, gaps_of, require_unread, wait_for
from programs import Scratch, daemon_config, demand, together, unused_port

ANSWER = 4  # Bytes
OWN, OTHER = "00000001", "87654321"

# Several faults at random times.
RANDOM = """
[random]
seed = 5
flip_bit_per_h = 120
drop_bytes_per_h = 60
duplicate_frame_per_h = 60
error_flags_per_h = 60
"""


def leave_cooked(port):
    """Sets a terminal as a login prompt leaves it: echo, XON/XOFF, CR and NL exchanged, signals, seven bits."""
    terminal = os.open(port, os.O_RDWR | os.O_NOCTTY)
    settings = termios.tcgetattr(terminal)
    settings[0] |= termios.IXON | termios.IXOFF | termios.IXANY | termios.ICRNL | termios.ISTRIP
    settings[3] |= termios.ICANON | termios.ECHO | termios.ISIG
    termios.tcsetattr(terminal, termios.TCSANOW, settings)
    os.close(terminal)


def closed_pipe():
    """Returns the end of a log whose reader has ended."""
    reader, writer = os.pipe()
    os.close(reader)
    return writer


def bytes_agree(report, counters, outages=0):
    """On a slow host some answers come after their time-out: they are received as part of the stream."""
    require_unread(report, report["frames_sent"] - counters["frames"], outages)
    arrived = report["bytes_handed_over"] - report["bytes_of_answers"] - report["bytes_unread"]
    late = counters["bytes"] - arrived
    demand(f"{counters['bytes']} bytes received are the {arrived} handed over, and {late} of answers after their time-out",
           late in range(0, 5 * ANSWER, ANSWER))
    damaged = arrived - FRAME * counters["frames"]
    demand(f"{counters['bytes_skipped']} bytes skipped are the {damaged} outside whole frames and the late answers",
           counters["bytes_skipped"] == damaged + late)


def gaps_agree(session, counters, unread=0):
    gaps, missing = gaps_of(session.truth())
    demand(f"{counters['gaps']} gaps of {counters['samples_missing']}, truth {gaps} of {missing}, and {unread} unread",
           (counters["gaps"], counters["samples_missing"]) == (gaps, missing + unread))


def damaged_line():
    """Damage at random times on a terminal in cooked mode, with a log that cannot be written."""
    with Scratch() as scratch:
        session = Session(scratch, RANDOM, prepare_port=leave_cooked, stderr=closed_pipe())
        session.wait_for_frames(500)  # A first frame is dropped if garbage follows it, because nothing confirms it.
        session.order("garbage bytes=10000")
        session.order("lose_frames count=3")
        session.wait_for_frames(50 * 200)
        report, counters = session.end()
        bytes_agree(report, counters)
        gaps_agree(session, counters)
        demand(f"{counters['duplicates']} duplicates, {report['frames_repeated']} were sent",
               counters["duplicates"] == report["frames_repeated"] > 0)
        demand("damage and flags are counted", min(counters[f"{kind}_errors"] for kind in ("checksum", "framing")) > 0
               and counters["error_flags"] == report["frames_flagged"] > 0)
        demand("one session", counters["sessions"] == len(report["runs"]) == 1)
        session.archive_is_true(missing=0, steps=None)  # Its times depend on the host; kill_daemon.py has them.


def unplugged_port():
    """Outages of up to six wraps of the counter: the same stream continues, and its counter shows what each cost."""
    with Scratch() as scratch:
        session = Session(scratch, speed=5)  # An adoption is certain within 1 s of signal: 0.2 s of the host.
        session.wait_for_frames(1000)
        names = {(scratch / "sensor").readlink()}
        for seconds in (5, 100):
            before = session.emulated()["frames_sent"]
            session.order(f"hang_up seconds={seconds}")
            wait_for("the port is gone", lambda: not (scratch / "sensor").is_symlink())
            wait_for("the port is back", lambda: (scratch / "sensor").is_symlink())
            wait_for("frames again", lambda: session.emulated()["frames_sent"] > before + 500)  # noqa: B023
            names.add((scratch / "sensor").readlink())
            session.settled()
        report, counters = session.end()
        demand(f"the port came back under {len(names)} names, and its stream was adopted each time",
               len(names) > 1 and counters["link_adoptions"] == 2 and counters["sessions"] == len(report["runs"]) == 1)
        unread = report["frames_sent"] - counters["frames"]
        bytes_agree(report, counters, outages=2)
        gaps_agree(session, counters, unread)
        session.archive_is_true(missing=unread, steps=None)


def changed_baud():
    """The sensor changes its baud rate: the daemon finds the new one, says so, and notes it in the journal."""
    with Scratch() as scratch:
        session = Session(scratch)
        session.wait_for_frames(1000)
        session.order("change_baud")
        wait_for("frames at the other baud rate", lambda: session.status()["counters"]["link_sessions"] == 2
                 and session.emulated()["runs"][-1]["frames"] > 500)
        reason = " ".join(session.status()["reasons"])
        session.settled()
        report, counters = session.end()
        baud = re.search(rb'"baud":(\d+)', sorted((scratch / "data" / "journal").glob("*.a351j"))[-1].read_bytes())
        demand(f"the status says {reason}, the journal {baud and baud[1]}",
               "115200 baud, not at the configured 460800" in reason and baud and baud[1] == b"115200")
        # Sent before the daemon had stopped the sensor at its baud rate.
        session.archive_is_true(missing=report["frames_sent"] - counters["frames"], steps=None)


def refused(session, name, old, new):
    """Demands that a second daemon ends at once with status 3."""
    (session.scratch / f"{name}.toml").write_text(daemon_config(unused_port()).replace(old, new))
    status = session.start_daemon(f"{name}.toml", stderr=None).wait(timeout=10)
    demand(f"a second daemon on the {name} ends with {status}, expected 3", status == 3)


def changed_sensor():
    """A second daemon, a reset, and another sensor in the middle of a stay."""
    with Scratch() as scratch:
        session = Session(scratch)
        session.wait_for_frames(1000)
        refused(session, "port", 'root = "data"', 'root = "other"')
        refused(session, "data root", 'port = "sensor"', 'port = "none"')
        demand("the first one has lost nothing",
               session.settled()["gaps"] == session.status()["counters"]["link_stalls"] == 0)
        session.order("reset")
        wait_for("a new session after the reset", lambda: session.status()["counters"]["sessions"] == 2)
        session.settled()
        session.ctl("start", "No.1")
        session.order(f"other_unit serial_number={OTHER}")
        wait_for("the other sensor is reported",
                 lambda: f"{OTHER} after {OWN}" in " ".join(session.status()["reasons"]))
        session.settled()
        stays = json.loads(session.ctl("list", "--json"))["occupations"]
        demand("its stay has ended", len(stays) == 1 and session.status()["occupation"] is None)
        _, counters = session.end()
        demand("three sessions", counters["sessions"] == 3)
        session.counted()


def changes():
    changed_baud()
    changed_sensor()


together(damaged_line, unplugged_port, changes)  # They wait most of their time.
