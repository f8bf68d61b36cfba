"""Days at 1000x: memory, file descriptors and threads of the daemon must not grow, and the archive must be the truth.

A351_LONG=1: the scenario `week`, seven days in ten minutes; otherwise its first four hours.
"""

import os
import pathlib
import statistics
import time

from emulated_session import Session, wait_for
from programs import IS_LONG, IS_SANITIZED, Scratch, demand, end_cleanly, read_json

SPEED = 150 if IS_SANITIZED else 1000
HOURS = 168 if IS_LONG else 4
HOUR_S = 3600 / SPEED
# Limit for the daemon's memory, as in system_bench.py; not tested under sanitizers.
LARGEST_MB = 60
# Hour after which memory must not grow: the daemon keeps the times of the last 24 h for occupations in the past.
SETTLED_H = 25
LARGEST_GROWTH_MB = 1  # Allows for some pages of the allocator.

# Counters of work that is done or waiting.  All other counters must not change while the sensor is connected.
WORK = {"archive_records", "archive_records_waiting", "bytes", "frames", "journal_bytes", "journal_segments_compressed",
        "link_sessions", "sessions"}


def footprint(pid):
    process = pathlib.Path("/proc") / str(pid)
    status = dict(line.split(":", 1) for line in (process / "status").read_text().splitlines())
    return (int(status["VmRSS"].split()[0]) / 1024, len(os.listdir(process / "fd")), int(status["Threads"]))


def hour_by_hour(session, hours):
    """Returns for each simulated hour the median memory in MB and the smallest numbers of descriptors and threads.

    The smallest numbers, because the compression of a segment needs some for a short time.
    """
    table, begin = [], time.monotonic()
    for hour in range(hours):
        seen = [footprint(session.daemon.pid)]
        while time.monotonic() < begin + (hour + 1) * HOUR_S:
            seen.append(footprint(session.daemon.pid))
            time.sleep(HOUR_S / 20)
        memory, descriptors, threads = zip(*seen)
        table.append((statistics.median(memory), min(descriptors), min(threads)))
    return table


with Scratch() as scratch:
    (scratch / "days.toml").write_text(f'base = "week"\nname = "days"\n[schedule]\nduration_h = {HOURS + 1}\n')
    session = Session(scratch, speed=SPEED, scenario="days.toml")
    session.wait_for_frames(50 * 600)
    wait_for("each channel has its day file open, as it has after 93 records",
             lambda: session.status()["counters"]["archive_records"] > 300)
    before = session.status()["counters"]  # Taken now, because a sensor that starts up does not answer at first.
    table = hour_by_hour(session, HOURS)
    counters = session.status()["counters"]
    print(f"the emulator ends with {session.sim.wait(timeout=600)}")
    time.sleep(1.0)
    heard = session.status()["counters"]["frames"]
    end_cleanly("the daemon", session.daemon, 60)
    report = read_json(scratch / "report.json")

    print("hour  memory_mb  descriptors  threads")
    for hour in sorted({0, 1, *range(0, HOURS, 12), HOURS - 1}):
        print(f"{hour:4d} {table[hour][0]:10.1f} {table[hour][1]:12d} {table[hour][2]:8d}")
    print("counters:", counters)
    print("emulator:", {key: report[key] for key in ("frames_sent", "largest_lateness_real_s", "mean_rate_real_hz")})
    largest = max(row[0] for row in table)
    if not IS_SANITIZED:
        demand(f"largest memory {largest:.1f} MB, limit {LARGEST_MB}", largest < LARGEST_MB)
    if HOURS > SETTLED_H:
        growth = table[-1][0] - table[SETTLED_H][0]
        demand(f"memory changed by {growth:+.1f} MB from hour {SETTLED_H} to the last, limit {LARGEST_GROWTH_MB}",
               growth < LARGEST_GROWTH_MB)
    demand("the last hour has no more descriptors and threads than the first",
           all(last <= first for last, first in zip(table[-1][1:], table[0][1:])))
    unexplained = {key: count for key, count in counters.items()
                   if count != before[key] and key not in WORK}
    demand(f"one session; counters that changed without a reason: {unexplained or 'none'}",
           not unexplained and counters["sessions"] == counters["link_sessions"] == 1)
    demand(f"{heard} frames received, {report['frames_sent']} were sent", heard == report["frames_sent"])
    session.archive_is_true(missing=0)
