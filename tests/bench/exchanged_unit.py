"""Measures what an exchange of the sensor in the middle of a day costs: left-out errors against those of two separate days.

Each seed draws two units, within +-25 % and with biases within +-5000 mGal, and an instant of the day of tsukuba, with at least four stays before and after it.
The first unit recorded before it, the second one from it on, into one data root.  A stay that runs at this instant ends there.
In each fourth seed the first unit comes back later, at a second instant.
The second one has then perhaps too few set-ups to be corrected, in both ways: such a day is counted, with the stations of the first one.
The same records in two data roots, one for each unit, are the separate days.  Both are corrected by `a351-correct survey`.
An error is the joint value of a station, with its own reference hidden, minus true gravity.
"""

import concurrent.futures
import datetime
import json
import os
import random
import re
import shutil
import statistics

from command_line import add_days, command_line
from simulated_units import rms, rms_by_day, simulate
from mseed_records import records
from programs import Scratch, correct_survey, events_of, instant, read_json, rows

SERIALS = ("00000001", "00000777")
BIAS_MGAL = 5000.0  # 5 mg; units of this family differ by 2 to 50 mg.
UTC = datetime.timezone.utc


def copy_archive(day, root, is_wanted):
    for file in sorted((day / "archive").rglob("*.D.*")):
        kept = b"".join(record for record, start, end in records(file.read_bytes()) if is_wanted(start, end))
        target = root / file.relative_to(day)
        target.parent.mkdir(parents=True, exist_ok=True)
        with open(target, "ab") as out:
            out.write(kept)


def write_root(root, log, metadata, day):
    (root / "events").mkdir(parents=True)
    (root / "metadata").mkdir()
    (root / "events" / f"{log[0]['utc'][:7]}.jsonl").write_text("".join(json.dumps(event) + "\n" for event in log))
    (root / "metadata" / "station.xml").write_text(metadata)
    shutil.copy(day / "sites.csv", root.parent / "sites.csv")


def channels_between(metadata, start, end):
    """Returns the channels of a metadata file with other dates; None keeps the begin, or leaves the end open."""
    dates = (f'startDate="{stamp(start)}"' if start else r"\g<0>") + (f' endDate="{stamp(end)}"' if end else "")
    return "".join(re.sub(r'startDate="[^"]*"', dates, channel)
                   for channel in re.findall(r" *<Channel .*?</Channel>\n", metadata, re.S))


def stamp(time):
    return time.strftime("%Y-%m-%dT%H:%M:%S.%fZ")


def exchanged(days, scratch, times):
    """Writes the day with exchanges at these times, and the two separate days; returns their data roots.

    @param times  of the second unit, and perhaps of the first one again
    """
    root, alone = scratch / "both" / "day", [scratch / "first" / "first", scratch / "second" / "second"]
    limits = [datetime.datetime.min.replace(tzinfo=UTC), *times, datetime.datetime.max.replace(tzinfo=UTC)]
    changes = [{"type": "other_unit", "utc": stamp(time), "serial_number": SERIALS[(k + 1) % 2], "before": SERIALS[k % 2]}
               for k, time in enumerate(times)]
    metadata = [(day / "metadata" / "station.xml").read_text() for day in days]
    channels, log, logs = "", [], [[], []]
    for k, (begin, end) in enumerate(zip(limits, limits[1:])):
        unit, day = k % 2, days[k % 2]
        for folder in (root, alone[unit]):
            copy_archive(day, folder, lambda start, after: begin <= start and after <= end)
        stays = [event for event in events_of(day) if begin <= instant(event["utc"]) < end]
        while stays and stays[0]["type"] != "start":
            stays.pop(0)  # The box was exchanged during this stay.
        stays += changes[k:k + 1]
        log += stays
        logs[unit] += stays
        channels += channels_between(metadata[unit], begin if k else None, end if k < len(times) else None)
    whole = re.sub(r" *<Channel .*</Channel>\n", lambda _: channels, metadata[0], flags=re.S)
    write_root(root, log, whole, days[0])
    for unit in range(2):
        write_root(alone[unit], logs[unit], metadata[unit], days[unit])
    return root, alone


def correct(scratch, name, *roots):
    """Returns value and uncertainty of each station, and the folder of the results."""
    out = scratch / name
    said = correct_survey(roots[0], out, *roots[1:], check=False)
    if said.returncode != 0 and "1 of 2 surveys are not corrected" not in said.stderr:
        raise SystemExit(f"a351-correct ended with {said.returncode}: {said.stderr}")
    values = {row["site"]: (float(row["gravity_mgal"]), float(row["u_gravity_mgal"])) for row in rows(out / "joint.csv")}
    return values, out, said.returncode == 0


def look_at(scratch, seed):
    folder = scratch / str(seed)
    folder.mkdir()
    draw = random.Random(f"exchange {seed}")
    days = [simulate(folder, f"unit{k}", "tsukuba", seed + 100000 * k, 0.25,
                     f"[sensor]\nbias_mgal = {draw.uniform(-BIAS_MGAL, BIAS_MGAL)}\n", serial)
            for k, serial in enumerate(SERIALS)]
    starts = sorted(instant(row["start_utc"]) for row in rows(days[0] / "truth.csv"))
    first, last = starts[4], starts[-4]
    at = first + draw.random() * (last - first)
    times = [at, at + draw.uniform(0.5, 1.0) * (starts[-2] - at)] if seed % 4 == 0 else [at]
    root, alone = exchanged(days, folder, times)
    truth = {row["site"]: float(row["gravity_mgal"]) for row in rows(days[0] / "truth.csv")}
    joint, out, is_whole = correct(folder, "joint", root)
    separate, _, _ = correct(folder, "separate", *alone)
    kinds = [{finding["kind"] for finding in read_json(file)["findings"]} for file in sorted(out.glob("*/result.json"))]
    is_named = len(kinds) == (2 if is_whole else 1) and all("other_unit" in each for each in kinds)
    errors = [[values[site][0] - truth[site] for site in values] for values in (joint, separate)]
    ratios = [(values[site][0] - truth[site]) / values[site][1] for values in (joint,) for site in values]
    apart = max(abs(joint[site][0] - separate[site][0]) for site in joint) if joint.keys() == separate.keys() else float("inf")
    shutil.rmtree(folder)
    return times, errors, ratios, apart, is_named, is_whole


line = command_line(__doc__, "exchanged_unit.py 81001 2", has_promises=False)
add_days(line, 81001, 20, least=2)
options = line.parse_args()
with Scratch() as scratch:
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = list(pool.map(lambda seed: look_at(scratch, seed), range(options.first, options.first + options.days)))
for k, (times, (ours, separate), ratios, apart, is_named, _) in enumerate(results):
    print(f"seed {options.first + k}: exchange at {' and '.join(f'{at:%H:%M:%S}' for at in times)}, {rms(ours):.2f} mGal, separate days "
          f"{rms(separate):.2f} mGal, e/u {rms(ratios):.2f}, apart {apart:.4f} mGal{'' if is_named else ', NOT NAMED'}")
(ours, u_ours), (separate, _), (ratio, u_ratio) = (rms_by_day(r) for r in ([r[1][0] for r in results], [r[1][1] for r in results], [r[2] for r in results]))
print(f"{len(results)} days: rms {ours:.3f} +- {u_ours:.3f} mGal with an exchange, {separate:.3f} as two separate days; e/u {ratio:.2f} +- {u_ratio:.2f}\n"
      f"values differ by at most {max(r[3] for r in results):.4f} mGal; the exchange is a finding on {sum(r[4] for r in results)} days; "
      f"on {sum(not r[5] for r in results)} days one unit had too few set-ups")
# Standard error of the difference of the mean squares, from days, as a difference of the rms.
squares = [rms(r[1][0]) ** 2 - rms(r[1][1]) ** 2 for r in results]
both = rms([e for r in results for e in r[1][0]]) + rms([e for r in results for e in r[1][1]])
print(f"difference of the rms {statistics.mean(squares) / both:.5f} +- {statistics.stdev(squares) / len(squares) ** 0.5 / both:.5f} mGal, paired by day")
