"""Sixteen simultaneous viewers: a browser that stays, one that reloads every second, and fourteen sockets, one never read.

The recording must not be disturbed, and the page that stays must never be stale.
"""

import threading
import time

from browser import Browser
from emulated_session import Session
from live_stream import messages, open_stream
from programs import IS_LONG, Scratch, demand

CROWD_S = 300 if IS_LONG else 8
SOCKETS = 13
LOST = ["WebSocket connection to", "Failed to load resource"]


class Reader(threading.Thread):
    def __init__(self, port):
        super().__init__(daemon=True)
        self.connection, self.count = open_stream(port), 0
        self.start()

    def run(self):
        for _ in messages(self.connection):
            self.count += 1


with Scratch() as scratch, Browser() as page, Browser(allowed_errors=LOST) as restless:
    session = Session(scratch, speed=1)
    session.wait_for_frames(100)
    page.open(session.port)
    page.wait_for("samples are shown", lambda: page.run("return document.getElementById('trace-end').textContent") != "")
    readers = [Reader(session.port) for _ in range(SOCKETS)]
    stuck = open_stream(session.port, receive_buffer=4096)
    oldest_s, banners, loads, end = 0.0, set(), 0, time.monotonic() + CROWD_S
    while time.monotonic() < end:
        begin = time.monotonic()
        restless.open(session.port)
        loads += 1
        oldest_s = max(oldest_s, float(page.text("age").split()[0]))
        banners.add(page.text("banner"))
        time.sleep(max(0.0, begin + 1 - time.monotonic()))
    demand(f"during {loads} reloads of the other browser the data of the page are at most {oldest_s} s old, limit 1",
           oldest_s < 1.0)
    demand(f"the page never called its data stale: {banners}", banners == {""})
    restless.wait_for("samples are shown", lambda: restless.run("return document.getElementById('trace-end').textContent") != "")
    demand(f"every socket was served with at least {min(reader.count for reader in readers)} messages",
           min(reader.count for reader in readers) > 8 * CROWD_S)
    page.allowed_errors = restless.allowed_errors
    _, counters = session.end()
    demand("the recording has no gap, no skipped byte and one session", counters["gaps"] == counters["samples_missing"]
           == counters["bytes_skipped"] == counters["queue_full"] == 0 and counters["sessions"] == 1)
    session.archive_is_true(missing=0)
