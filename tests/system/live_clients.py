"""Sixteen clients of the live stream, one of them stuck and one that comes anew each second: the record is untouched,
memory bounded, the daemon's cost per viewer small, and what they see is what was sensed, soon.

A351_LONG=1: for five minutes; otherwise for a quarter of one."""

import bisect
import datetime
import os
import pathlib
import statistics
import threading
import time

from emulated_session import Session
from live_stream import BINARY, TEXT, block, messages, open_stream
from programs import IS_LONG, IS_SANITIZED, Scratch, demand

COST_S = 30 if IS_LONG else 6  # Of each of the two measurements of CPU time.
CROWD_S = 300 if IS_LONG else 15  # Longer than the 10 s after which a stuck one is left.
VIEWERS = 10
READERS = 14  # With the stuck one and the one that comes and goes: 16.
LARGEST_MB = 60  # As system_bench.py promises of the daemon as a whole.
LARGEST_GROWTH_MB = 4


def cpu_seconds(pid):
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def memory_mb(pid):
    status = dict(line.split(":", 1) for line in pathlib.Path(f"/proc/{pid}/status").read_text().splitlines())
    return int(status["VmRSS"].split()[0]) / 1024


def share_of_core(pid, seconds):
    before, begin = cpu_seconds(pid), time.monotonic()
    time.sleep(seconds)
    return (cpu_seconds(pid) - before) / (time.monotonic() - begin)


class Reader(threading.Thread):
    """Reads until it is left or told to end."""

    def __init__(self, session):
        super().__init__(daemon=True)
        self.session, self.blocks, self.ages_s, self.statuses = session, [], [], 0
        self.first_data_s, self.is_over = None, False
        self.start()

    def run(self):
        begin = time.monotonic()
        self.connection = open_stream(self.session.port)
        for kind, payload in messages(self.connection):
            self.statuses += kind == TEXT
            if kind == BINARY:
                now_ms = instrument_ms(self.session)
                self.blocks.append(block(payload))
                if self.first_data_s is None:
                    self.first_data_s = time.monotonic() - begin
                else:
                    last = self.blocks[-1]
                    self.ages_s.append((now_ms - last.time_ms) / 1e3 - (len(last.channels[0]) - 1) * last.interval_ms / 1e3)
            if self.is_over:
                break
        self.connection.close()

    def end(self):
        self.is_over = True
        self.join(timeout=30)
        return self

    def breaks(self):
        """Blocks that do not go on where the one before ended."""
        return sum(1 for last, this in zip(self.blocks, self.blocks[1:])
                   if this.first_index != last.first_index + len(last.channels[0]))


def instrument_ms(session):
    """Simulated time at speed 1, as Session began it."""
    begin, host = (datetime.datetime.fromisoformat(text.replace("Z", "+00:00")).timestamp()
                   for text in session.clock.split("@")[1].split(","))
    return 1e3 * (begin + time.time() - host)


def come_and_go(session, until, opened):
    """Opens the stream each second, reads what comes at once, and leaves without a word."""
    while time.monotonic() < until:
        begin = time.monotonic()
        connection = open_stream(session.port)
        for kind, _ in messages(connection):
            if kind == BINARY:
                opened.append(time.monotonic() - begin)
                break
        connection.close()
        time.sleep(max(0.0, begin + 1 - time.monotonic()))


def is_left(connection):
    """Whether the daemon has closed the stream, behind what the kernels still kept of it."""
    connection.settimeout(2)
    try:
        while connection.recv(65536):
            pass
    except TimeoutError:
        return False
    except OSError:
        pass
    return True


def crowd(session, pid):
    until = time.monotonic() + CROWD_S
    readers = [Reader(session) for _ in range(READERS)]
    stuck, opened = open_stream(session.port, receive_buffer=4096), []
    guest = threading.Thread(target=come_and_go, args=(session, until, opened), daemon=True)
    guest.start()
    sizes = []
    while time.monotonic() < until:
        sizes.append(memory_mb(pid))
        time.sleep(0.1)
    guest.join(timeout=30)
    for reader in readers:
        reader.end()
    growth, largest = sizes[-1] - sizes[len(sizes) // 4], max(sizes)
    print(f"memory: {sizes[0]:.1f} MB at the beginning, {largest:.1f} MB at most, {growth:+.1f} MB since a quarter")
    if not IS_SANITIZED:
        demand(f"memory stays below {LARGEST_MB} MB and grows by less than {LARGEST_GROWTH_MB}",
               largest < LARGEST_MB and growth < LARGEST_GROWTH_MB)
    demand(f"the one that comes anew each second had data {len(opened)} times, after {max(opened):.2f} s at most",
           len(opened) > 0.7 * CROWD_S and max(opened) < 2.0)
    demand("the stuck one was left", is_left(stuck))
    return readers


def see_truth(session, reader):
    """Each sample of the stream is the one that was sensed at its time."""
    truth = session.samples()
    instants = sorted(truth)
    wrong = count = 0
    for one in reader.blocks:
        for i, values in enumerate(zip(*one.channels)):
            at = round((one.time_ms + i * one.interval_ms) * 1e6)
            nearest = bisect.bisect_left(instants, at - int(one.interval_ms * 5e5))
            wrong += nearest == len(instants) or truth[instants[nearest]] != values
            count += 1
    demand(f"of {count} samples of a viewer {wrong} are not what was sensed then", wrong == 0 and count > 50 * CROWD_S)


def play(scratch):
    session = Session(scratch, speed=1)
    pid = session.daemon.pid
    session.wait_for_frames(100)
    alone = share_of_core(pid, COST_S)
    viewers = [Reader(session) for _ in range(VIEWERS)]
    time.sleep(1)
    viewed = share_of_core(pid, COST_S)
    for viewer in viewers:
        viewer.end()
    each = (viewed - alone) / VIEWERS
    print(f"share of a core: {100 * alone:.2f} % without viewers, {100 * viewed:.2f} % with {VIEWERS}")
    if not IS_SANITIZED:
        demand(f"a viewer costs {100 * each:.2f} % of a core, promised less than 2 %", each < 0.02)

    readers = crowd(session, pid)
    ages = sorted(age for reader in readers for age in reader.ages_s)
    late = ages[int(0.99 * len(ages))]
    print(f"age of the newest sample on arrival: {statistics.median(ages):.3f} s, 99 % within {late:.3f} s, "
          f"largest {ages[-1]:.3f} s")
    demand("viewers follow within 0.5 s", late < 0.5)
    slowest = max(reader.first_data_s for reader in readers)
    demand(f"the slowest of them had its first data {slowest:.2f} s after it came", slowest < 2.0)
    demand("none of them missed a sample", all(reader.blocks and reader.breaks() == 0 for reader in readers))
    demand(f"they had the status once a second: {min(reader.statuses for reader in readers)} times in {CROWD_S} s",
           all(reader.statuses > 0.7 * CROWD_S for reader in readers))
    _, counters = session.end()
    see_truth(session, readers[0])
    demand("nothing was dropped, skipped or missing", counters["gaps"] == counters["samples_missing"]
           == counters["bytes_skipped"] == counters["queue_full"] == 0 and counters["sessions"] == 1)
    session.archive_is_true(missing=0)


with Scratch() as scratch:
    play(scratch)
