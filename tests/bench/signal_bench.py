"""What the signal's LOOK finds at the benchmark, and what it says on days without a mistake.

usage: signal_bench.py FIRST_SEED DAYS [KIND ...]    (A351_BIN)
KIND: clean, set_up, names, reference; default all.  Days are of tsukuba and hot-afternoon in turn, each stay of two set-ups of
6 min, all benchmarks known.  The log is cut after each stop, as the recorder has it then.  On a day of a mistake, one draw:
- set_up: the second set-up of a stay is 12 mGal higher;
- names: the first two stays are under each other's names, whose references differ by more than 10 mGal;
- reference: the reference of one stay is 20 mGal too high.
The mistake is found if its stay, or a later one up to the next benchmark, has a contradiction.
"""

import concurrent.futures
import json
import os
import random
import shutil
import struct
import subprocess
import sys

from simulated_units import rms, simulate
from programs import BIN, Scratch, rows

SCENARIOS = ("tsukuba", "hot-afternoon")
TWO_SET_UPS = "[schedule]\nsetups = 2\n"
DISPLACED_mgal, WRONG_mgal, LEAST_APART_mgal = 12.0, 20.0, 10.0
RECORD_bytes = 512


def sites_with(gravity_of):
    return "site,longitude_deg,latitude_deg,altitude_m,gravity_mgal\n" + "".join(
        ",".join([row["site"], row["longitude_deg"], row["latitude_deg"], row["altitude_m"], str(gravity_of[row["site"]])]) + "\n"
        for row in gravity_of["rows"])


def so_far(day, events, sites):
    """Returns the gravity so far with these events and sites."""
    log = next((day / "events").glob("*.jsonl"))
    log.write_text("".join(json.dumps(event) + "\n" for event in events))
    (day / "now.csv").write_text(sites)
    answer = subprocess.run([BIN / "a351-correct", "survey", day, "--sites", day / "now.csv", "--json"], capture_output=True, text=True,
                            check=True)
    return json.loads(answer.stdout)


def second_of_day(record):
    """Returns the start of a miniSEED record."""
    year, day, hour, minute, second, _, fraction = struct.unpack(">HHBBBBH", record[20:30])
    return (year, day), 3600 * hour + 60 * minute + second + fraction * 1e-4


def displace(day, higher, start, end):
    """Takes the records of the vertical axis in [start, end) from the same day with a higher gravity."""
    for file in sorted((day / "archive").rglob("*.BNZ.D.*")):
        other = higher / file.relative_to(day)
        parts = [[data[i:i + RECORD_bytes] for i in range(0, len(data), RECORD_bytes)] for data in (file.read_bytes(), other.read_bytes())]
        inside = lambda record: start <= second_of_day(record) < end  # noqa: E731
        kept = [record for record in parts[0] if not inside(record)] + [record for record in parts[1] if inside(record)]
        file.write_bytes(b"".join(sorted(kept, key=second_of_day)))


def as_second(utc):
    import datetime
    time = datetime.datetime.fromisoformat(utc[:26])
    return (time.year, time.timetuple().tm_yday), 3600 * time.hour + 60 * time.minute + time.second + time.microsecond * 1e-6


def stays_of(events):
    """Returns for each stay the places of its first and last event."""
    starts = [i for i, event in enumerate(events) if event["type"] == "start"]
    return [(i, next(k for k in range(i, len(events)) if events[k]["type"] == "stop")) for i in starts]


def look(scratch, kind, seed):
    """Returns (contradiction at the stay or the next one, errors and u after it) of a day."""
    scenario = SCENARIOS[seed % len(SCENARIOS)]
    folder = scratch / f"{kind}-{seed}"
    folder.mkdir()
    day = simulate(folder, "day", scenario, seed, 0.0, TWO_SET_UPS)
    events = [json.loads(line) for line in next((day / "events").glob("*.jsonl")).read_text().splitlines()]
    table = rows(day / "sites.csv")
    true = {row["site"]: float(row["gravity_mgal"]) for row in table}
    listed = {**true, "rows": table}
    stays = stays_of(events)
    draw = random.Random(seed)
    place = draw.randrange(1, len(stays) - 1)
    site = events[stays[place][0]]["site"]
    if kind == "names":
        place = 1
        first, second = events[stays[0][0]]["site"], events[stays[1][0]]["site"]
        if abs(true[first] - true[second]) <= LEAST_APART_mgal:
            return None
        for k, name in ((0, second), (1, first)):
            for i in range(stays[k][0], stays[k][1] + 1):
                events[i]["site"] = name
    if kind == "reference":
        listed[site] += WRONG_mgal
        place = next(k for k, (start, _) in enumerate(stays) if events[start]["site"] == site)
    if kind == "set_up":
        raised = {name: gravity + DISPLACED_mgal for name, gravity in true.items()}
        text = "".join(f"[[site]]\nname = \"{row['site']}\"\n" + "".join(
            f"{key} = {raised[row['site']] if key == 'gravity_mgal' else row[key]}\n"
            for key in ("longitude_deg", "latitude_deg", "altitude_m", "gravity_mgal")) for row in table)
        higher = simulate(folder, "higher", scenario, seed, 0.0, TWO_SET_UPS + text)
        start, stop = stays[place]
        second = next(i for i in range(start, stop) if events[i]["type"] == "setup")
        displace(day, higher, as_second(events[second]["utc"]), as_second(events[stop]["utc"]))
    sites = sites_with(listed)
    asked = range(len(stays)) if kind == "clean" else range(place, min(place + 2, len(stays)))
    found, spread = [], []
    for k in asked:
        answer = so_far(day, events[:stays[k][1] + 1], sites)
        found.append([one["text"] for one in answer["contradictions"]])
        for stay in answer["stays"]:
            if stay["gravity_mgal"] is not None and kind != "clean":
                spread.append((stay["gravity_mgal"] - true[stay["site"]], stay["u_mgal"]))
            if kind == "clean" and stay is answer["stays"][-1] and stay["gravity_mgal"] is not None:
                spread.append((stay["gravity_mgal"] - true[stay["site"]], stay["u_mgal"]))
    shutil.rmtree(folder)
    return found, spread


first, days = int(sys.argv[1]), int(sys.argv[2])
with Scratch() as scratch, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    for kind in sys.argv[3:] or ["clean", "set_up", "names", "reference"]:
        seen = [one for one in pool.map(lambda seed: look(scratch, kind, seed), range(first, first + days)) if one]
        spread = [one for _, day in seen for one in day]
        if os.environ.get("A351_SHOW"):
            for found, _ in seen:
                print("   ", found)
        ratio = rms(error / u for error, u in spread) if spread else float("nan")
        if kind == "clean":
            stays = [bool(stay) for found, _ in seen for stay in found]
            print(f"clean: LOOK at {sum(stays)} of {len(stays)} stays ({100 * sum(stays) / len(stays):.1f} %, promised 3); error over u "
                  f"at the end of the stay {ratio:.2f} (promised 0.9 to 1.1), of {len(spread)} values", flush=True)
        else:
            print(f"{kind}: LOOK at the benchmark on {sum(bool(found[0]) for found, _ in seen)}, there or at the next one on "
                  f"{sum(any(found) for found, _ in seen)} of {len(seen)} days (promised 95 %); error over u then {ratio:.2f}", flush=True)
