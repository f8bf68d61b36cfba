"""With storage.record_age_s = 1 a record reaches the ring within 2 s of its last sample, by daemon and a351-stream.

kill_daemon.py kills daemons with such records; recovery_test.cpp makes them again from the journal.
A351_LONG=1: for a minute; otherwise for half a minute.
"""

import datetime
import signal
import statistics
import subprocess
import time

from datalink_ring import Ring
from emulated_session import Session
from mseed_records import begin_of
from programs import BIN, IS_LONG, IS_SANITIZED, Scratch, demand, instant, one_site, unused_port

SECONDS = 60 if IS_LONG else 30
MOST_S = 2.0
TIME_ERROR_S = 0.01  # That of kill_daemon.py at factor 1.
SCENARIO = one_site("quiet", "2017-07-15T23:59:45Z", 10)  # A quarter of a minute before midnight.


def latencies(session, ring):
    """Returns how old the oldest and the newest sample of each record are on arrival, in s, for the channels of the sensor."""
    start, host = (instant(part) for part in session.clock.split("@")[1].split(","))
    begin, seen, oldest, newest = None, 0, [], []
    end = time.monotonic() + SECONDS
    while time.monotonic() < end:
        time.sleep(0.01)
        with ring.lock:
            fresh = [packet[4] for packet in ring.packets[seen:]]
        now = start + (datetime.datetime.now(datetime.timezone.utc) - host)
        seen += len(fresh)
        for record in fresh:
            if record[15:16] != b"B":
                continue
            begin = begin or begin_of(record)
            if begin_of(record) < begin + datetime.timedelta(seconds=3):
                continue  # The times of the first 2 s of a stream are not known at once.
            age_s = (now - begin_of(record)).total_seconds()
            oldest.append(age_s)
            newest.append(age_s - (int.from_bytes(record[30:32], "big") - 1) / 50.0)
    return oldest, newest


with Scratch() as scratch:
    (scratch / "short-records.toml").write_text(SCENARIO)
    (scratch / "data").mkdir()
    ring = Ring(unused_port())
    ring.start()
    stream = subprocess.Popen([BIN / "a351-stream", "data", f"127.0.0.1:{ring.port}"], cwd=scratch)
    session = Session(scratch, speed=1, scenario="short-records.toml", storage="record_age_s = 1\n")
    try:
        oldest, newest = latencies(session, ring)
    finally:
        stream.send_signal(signal.SIGTERM)
        stream.wait(timeout=30)
    print(f"from the sensor to the ring: {len(oldest)} records; oldest sample of a record "
          f"median {statistics.median(oldest):.2f} s, worst {max(oldest):.2f} s; newest sample median {statistics.median(newest):.2f} s, "
          f"worst {max(newest):.2f} s")
    demand(f"{len(oldest)} records came, four a second", len(oldest) > 3.5 * (SECONDS - 10))
    late = sum(age > MOST_S for age in newest)
    demand(f"{late} records came later than {MOST_S} s after their last sample", IS_SANITIZED or late == 0)

    session.end()
    for name, counted in session.counted().items():
        demand(f"{name}: times are right within {counted['largest_time_error_s'] * 1e3:.1f} ms, limit {TIME_ERROR_S * 1e3:.0f} ms",
               counted["largest_time_error_s"] <= TIME_ERROR_S)
    session.archive_is_true(missing=0)
