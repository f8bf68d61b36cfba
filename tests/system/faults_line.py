"""Faults of the line and of the counter at 20x, numbered as in fault-list.md.

Lost bytes, garbage, markers and control characters in the data, single bytes and many frames in one read, and outages
longer than the counter's wrap.
"""

import os
import signal
import struct
import termios
import time

from emulated_session import INTACT, Session, gaps_of, wait_for
from fault_table import FaultTable
from miniseed_headers import gaps_in_samples, headers
from programs import Scratch, demand

FRAME = 24
SPEED = 20
WRAP_S = 16.384
MARKERS = b"\x80\x0d"
CONTROL = bytes.fromhex("11 13 0D 0A 03 1A 00 FF")
table = FaultTable()


def leave_cooked(port):
    """Sets a terminal as a login prompt leaves it: echo, XON/XOFF, CR and NL exchanged, signals, seven bits."""
    terminal = os.open(port, os.O_RDWR | os.O_NOCTTY)
    settings = termios.tcgetattr(terminal)
    settings[0] |= termios.IXON | termios.IXOFF | termios.IXANY | termios.ICRNL | termios.ISTRIP
    settings[3] |= termios.ICANON | termios.ECHO | termios.ISIG
    termios.tcsetattr(terminal, termios.TCSANOW, settings)
    os.close(terminal)


def longest_outage(truth):
    """Returns the largest number of consecutive frames that did not arrive; the silence at the end does not count."""
    longest = now = 0
    for _, fate in truth[:max(at for at, row in enumerate(truth) if row[1] == INTACT)]:
        now = 0 if fate == INTACT else now + 1
        longest = max(longest, now)
    return longest


def order_and_settle(session, orders):
    before = session.settled()
    for order in orders:
        kind = order.split()[0]
        done = session.emulated()["faults"].get(kind, 0)
        session.order(order)
        wait_for(order, lambda: session.emulated()["faults"].get(kind, 0) > done)
    after = session.settled()
    return {key: after[key] - before[key] for key in after}


def pause_daemon(session, seconds):
    """Stops the daemon for some seconds; the receive buffer keeps 4095 bytes meanwhile."""
    session.daemon.send_signal(signal.SIGSTOP)
    time.sleep(seconds)
    session.daemon.send_signal(signal.SIGCONT)


def is_archive_true(session, steps=0):
    counted = session.counted()
    return all(one["matched"] > 0 and one["missing"] == one["altered"] == one["duplicated"] == 0
               and (steps is None or one["steps"] == steps) for one in counted.values())


with Scratch() as scratch:
    session = Session(scratch, speed=SPEED, prepare_port=leave_cooked)
    session.wait_for_frames(1000)

    incidents = order_and_settle(session, [f"drop_bytes bytes={size}" for size in range(1, FRAME)])
    noise = order_and_settle(session, 20 * ["garbage bytes=10000"])
    heap = order_and_settle(session, ["stall seconds=10"])
    session.order("overrun")
    pause_daemon(session, 1.5)
    session.settled()
    report, counters = session.end()
    is_true = is_archive_true(session)
    truth, rows = session.truth(), session.rows()

    table.note(12, "lost bytes",
               f"1 to 23 bytes removed from a frame, 23 times: {incidents['samples_missing']} samples missing",
               incidents["samples_missing"] == 23 and is_true)
    table.note(13, "garbage", f"20 times 10 kB: {noise['bytes_skipped']} bytes skipped, {noise['samples_missing']} "
               f"samples missing, {counters['frames'] - report['frames_sent']} false frames",
               noise["bytes_skipped"] == 200_000 and noise["samples_missing"] == noise["anomalies"] == 0
               and counters["frames"] == report["frames_sent"] and is_true)
    payloads = [struct.pack(">4i", *row[1:5]) for row in rows if row[8] == INTACT]
    with_markers = sum(1 for payload in payloads if any(byte in MARKERS for byte in payload))
    seen = set().union(*payloads)
    table.note(14, "markers in the data",
               f"{with_markers} of {len(payloads)} frames carry 80 or 0D in the data, all archived",
               with_markers > 50 and is_true)
    table.note(15, "control characters", f"terminal left in cooked mode; {len(seen)} byte values seen, all archived",
               seen.issuperset(CONTROL) and is_true)
    table.note(16, "500 frames in one read",
               f"{heap['samples_missing']} missing, {heap['bytes_skipped']} bytes skipped",
               heap["samples_missing"] == heap["bytes_skipped"] == heap["gaps"] == 0 and is_true)
    outage_s = longest_outage(truth) / 50
    counted, true = (counters["gaps"], counters["samples_missing"]), gaps_of(truth)
    table.note(10, "outage longer than a wrap",
               f"{outage_s:.2f} s; gaps and samples missing {counted}, truth {true}",
               outage_s > WRAP_S and counted == true and counters["sessions"] == 1 and is_true)

# Steps ahead, in samples.  A step of 768 or more counts as a step back (sample_index.hpp).
JUMPS = (1, 40, 400, 767)
with Scratch() as scratch:
    (scratch / "pieces.toml").write_text('base = "tsukuba"\nname = "pieces"\n[line]\nis_bytewise = true\n')
    session = Session(scratch, speed=SPEED, scenario="pieces.toml")
    session.wait_for_frames(2000)
    pieces = session.settled()
    jumps = order_and_settle(session, [f"counter_jump count={size}" for size in JUMPS])
    stuck = order_and_settle(session, ["counter_stuck count=19"])
    report, counters = session.end()
    is_true = is_archive_true(session, steps=None)
    table.note(16, "frames byte by byte", f"{pieces['bytes_skipped']} bytes skipped, {pieces['gaps']} gaps in "
               f"{pieces['frames']} frames", pieces["bytes_skipped"] == pieces["gaps"] == 0 and is_true)
    in_archive = gaps_in_samples(headers(sorted((scratch / "data" / "archive").rglob("*.BNZ.D.*"))))
    table.note(17, "counter jumps ahead", f"by {JUMPS} samples: {jumps['samples_missing']} missing in {jumps['gaps']} gaps; in "
               f"the archive {in_archive}", jumps["gaps"] == len(JUMPS) and jumps["samples_missing"] == sum(JUMPS)
               and in_archive[:len(JUMPS)] == list(JUMPS) and is_true)
    table.note(18, "counter stuck", f"{stuck['duplicates']} of 19 frames dropped as repeated, a gap of "
               f"{stuck['samples_missing']}", stuck["duplicates"] == stuck["samples_missing"] == 19 and is_true)
    demand("one session", counters["sessions"] == 1)

table.finish()
