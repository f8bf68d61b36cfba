"""A stay that was recorded on the road is not trusted, also at a station without a reference.

The simulated box stands still on its way.  So records of a second day, with the same seed and a box that is shaken as in a car,
take the place of those around some stays.
"""

import datetime
import pathlib

from miniseed_headers import RECORD, end_us, read
from programs import BIN, Scratch, demand, read_json, rows, run

SEED = 71021
DRIVEN = ("No.6", "No.8", "No.10")  # visited once
SHAKEN = """base = "tsukuba"
name = "shaken"
[vibration]
vehicles_per_h = 60
vehicle_s = [50, 60]
vehicle_hz = [1, 15]
vehicle_gal = [30, 40]
"""
BEFORE_US = 20e6


def microseconds(utc):
    return datetime.datetime.fromisoformat(utc.replace("Z", "+00:00")).timestamp() * 1e6


def records(file):
    data = file.read_bytes()
    return [(read(file, data[at:at + RECORD]), data[at:at + RECORD]) for at in range(0, len(data), RECORD)]


def exchange(file, other, windows):
    """Takes all records of `other` inside the windows, and those of `file` outside them, in order of time."""
    def is_inside(header):
        return any(start <= header.start_us and end_us(header) <= end for start, end in windows)

    def is_outside(header):
        return all(end_us(header) <= start or end <= header.start_us for start, end in windows)

    kept = [one for one in records(file) if is_outside(one[0])] + [one for one in records(other) if is_inside(one[0])]
    file.write_bytes(b"".join(data for _, data in sorted(kept, key=lambda one: one[0].start_us)))


with Scratch() as scratch:
    day, shaken = scratch / "day", scratch / "shaken"
    (scratch / "shaken.toml").write_text(SHAKEN)
    for scenario, out in (("tsukuba", day), (scratch / "shaken.toml", shaken)):
        run(BIN / "a351-sim", "survey", "--scenario", scenario, "--seed", SEED, "--out", out)
    windows = [(microseconds(stay["start_utc"]) - BEFORE_US, microseconds(stay["end_utc"]) + BEFORE_US)
               for stay in rows(day / "schedule.csv") if stay["site"] in DRIVEN]
    for file in (day / "archive").rglob("*.BN?.D.*"):
        exchange(file, pathlib.Path(str(file).replace(str(day), str(shaken))), windows)
    sites = (day / "sites.csv").read_text().splitlines()
    (day / "sites.csv").write_text("".join(
        (line.rpartition(",")[0] + "," if line.split(",")[0] in DRIVEN else line) + "\n" for line in sites))

    run(BIN / "a351-correct", "survey", day / "survey.toml", "--out", day / "result")
    readings = read_json(day / "result" / "result.json")["occupations"]
    for reading in readings:
        if reading["site"] in DRIVEN:
            demand(f"{reading['site']}: rms {reading['rms_z_mgal'] / 1000:.1f} Gal, u {reading['u_corrected_mgal']:.2f} mGal: "
                   f"{reading['grade']}: {reading['grade_reason']}", reading["grade"] == "repeat")
    others = [reading for reading in readings if reading["site"] not in DRIVEN]
    demand(f"none of the other {len(others)} is called shaken",
           not any("shaken" in reading["grade_reason"] for reading in others))
