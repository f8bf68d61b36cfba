"""Fault 29 of fault-list.md: midnight at the end of a month, of a leap day and of a year.

Each midnight has its own emulator and daemon.
"""

import datetime

from emulated_session import Session
from fault_table import FaultTable
from miniseed_headers import end_us, headers
from programs import IS_SANITIZED, Scratch

SPEED = 20 if IS_SANITIZED else 100
# Largest difference between the time of a sample and its place by the header's rate, in us; as in three_days.py.
LARGEST_DEPARTURE_US = 4500
BEFORE_MIN = 10  # Of simulated time: at 100x the daemon has 6 s to start sampling before midnight.
# Day that begins at the midnight, name of the case, and the days before and after the midnight as year.day-of-year.
MIDNIGHTS = [("2023-03-01", "end of February", "2023.059", "2023.060"),
             ("2024-02-29", "leap day begins", "2024.059", "2024.060"),
             ("2024-03-01", "leap day ends", "2024.060", "2024.061"),
             ("2024-01-01", "new year", "2023.365", "2024.001"),
             ("2025-01-01", "new year after a leap year", "2024.366", "2025.001")]
SCENARIO = """base = "indoor"
name = "midnight"
[schedule]
start_utc = "START"
duration_h = 1.0
"""

table = FaultTable()
scratches = [Scratch() for _ in MIDNIGHTS]
sessions = []
for scratch, (day, *_) in zip(scratches, MIDNIGHTS):
    path = scratch.__enter__()
    start = (datetime.datetime.fromisoformat(day) - datetime.timedelta(minutes=BEFORE_MIN)).strftime("%Y-%m-%dT%H:%M:%SZ")
    (path / "midnight.toml").write_text(SCENARIO.replace("START", start))
    sessions.append(Session(path, speed=SPEED, scenario="midnight.toml", start=start))
for session in sessions:
    session.wait_for_frames((BEFORE_MIN + 3) * 60 * 50)
for session, (day, name, before, after) in zip(sessions, MIDNIGHTS):
    session.end()
    midnight_us = datetime.datetime.fromisoformat(day + "T00:00:00+00:00").timestamp() * 1e6
    files = sorted((session.scratch / "data" / "archive").rglob("*.D.*"))
    days = {file.name[-8:] for file in files}
    in_place = all(file.parent.parts[-4] == file.name[-8:-4] for file in files)
    records = headers(files)
    last_us = max(end_us(one) - 1e6 / one.rate_hz for one in records if one.start_us < midnight_us)
    misplaced = [one for one in records if (one.start_us >= midnight_us) != one.file.name.endswith(after)]
    counted = session.counted().values()
    is_true = all(one["matched"] == one["truth"] > 0 and one["altered"] == one["duplicated"] == one["steps"] == 0
                  for one in counted)
    table.note(29, name, f"day files {', '.join(sorted(days))}; by the header's rate the last sample of the day is at "
               f"{(last_us - midnight_us) / 1e3:+.2f} ms; {len(misplaced)} records in the wrong file",
               days == {before, after} and in_place and is_true and not misplaced
               and last_us - midnight_us < LARGEST_DEPARTURE_US)
for scratch in scratches:
    scratch.__exit__(None, None, None)
table.finish()
