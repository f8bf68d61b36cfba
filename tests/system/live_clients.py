"""Sixteen clients of the live stream, one of them stuck and one that reconnects each second.

The recording must not be disturbed, memory must stay limited and each viewer must cost little CPU time.  The viewers must
receive the true samples within 0.5 s.

A351_LONG=1: for five minutes; otherwise for 15 s.
"""

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

COST_S = 30 if IS_LONG else 6  # Length of each of the two measurements of CPU time, in s.
CROWD_S = 300 if IS_LONG else 15  # Longer than the 10 s after which the daemon closes a stuck client.
VIEWERS = 10
READERS = 14  # 16 clients with the stuck and the reconnecting one.
LARGEST_MB = 60  # Limit for the daemon's memory, as in system_bench.py.
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
    """Client that reads the stream until it is closed or end() is called."""

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
        """Returns the number of blocks that do not continue the block before."""
        return sum(1 for last, this in zip(self.blocks, self.blocks[1:])
                   if this.first_index != last.first_index + len(last.channels[0]))


def instrument_ms(session):
    """Returns the simulated time of the session at speed 1, in ms."""
    begin, host = (datetime.datetime.fromisoformat(text.replace("Z", "+00:00")).timestamp()
                   for text in session.clock.split("@")[1].split(","))
    return 1e3 * (begin + time.time() - host)


def come_and_go(session, until, opened):
    """Opens the stream each second, reads up to the first block, and closes the connection without a close message."""
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
    """Returns True if the daemon has closed the stream; first reads the bytes that the kernel still holds."""
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
    print(f"memory: {sizes[0]:.1f} MB at the beginning, {largest:.1f} MB at most, {growth:+.1f} MB since a quarter of the time")
    if not IS_SANITIZED:
        demand(f"memory is {largest:.1f} MB, limit {LARGEST_MB}, and grows by {growth:+.1f} MB, limit {LARGEST_GROWTH_MB}",
               largest < LARGEST_MB and growth < LARGEST_GROWTH_MB)
    demand(f"the reconnecting client had data {len(opened)} times, each time within {max(opened):.2f} s, limit 2",
           len(opened) > 0.7 * CROWD_S and max(opened) < 2.0)
    demand("the daemon closed the connection of the stuck client", is_left(stuck))
    return readers


def see_truth(session, reader):
    """Demands that each sample of the stream is the true one of its time."""
    truth = session.samples()
    instants = sorted(truth)
    wrong = count = 0
    for one in reader.blocks:
        for i, values in enumerate(zip(*one.channels)):
            at = round((one.time_ms + i * one.interval_ms) * 1e6)
            nearest = bisect.bisect_left(instants, at - int(one.interval_ms * 5e5))
            wrong += nearest == len(instants) or truth[instants[nearest]] != values
            count += 1
    demand(f"{wrong} of {count} samples of a viewer differ from the truth at their time", wrong == 0 and count > 50 * CROWD_S)


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
    print(f"share of a core: {100 * alone:.2f} % without viewers, {100 * viewed:.2f} % with {VIEWERS} viewers")
    if not IS_SANITIZED:
        demand(f"a viewer costs {100 * each:.2f} % of a core, limit 2 %", each < 0.02)

    readers = crowd(session, pid)
    ages = sorted(age for reader in readers for age in reader.ages_s)
    late = ages[int(0.99 * len(ages))]
    print(f"age of the newest sample on arrival: {statistics.median(ages):.3f} s, 99 % within {late:.3f} s, "
          f"largest {ages[-1]:.3f} s")
    demand(f"99 % of the blocks arrive within {late:.3f} s, limit 0.5", late < 0.5)
    slowest = max(reader.first_data_s for reader in readers)
    demand(f"the slowest viewer had its first data after {slowest:.2f} s, limit 2", slowest < 2.0)
    demand("no viewer missed a sample", all(reader.blocks and reader.breaks() == 0 for reader in readers))
    demand(f"every viewer had the status at least {min(reader.statuses for reader in readers)} times in {CROWD_S} s",
           all(reader.statuses > 0.7 * CROWD_S for reader in readers))
    _, counters = session.end()
    see_truth(session, readers[0])
    demand("the recording has no gap, no skipped byte and one session", counters["gaps"] == counters["samples_missing"]
           == counters["bytes_skipped"] == counters["queue_full"] == 0 and counters["sessions"] == 1)
    session.archive_is_true(missing=0)


with Scratch() as scratch:
    play(scratch)
