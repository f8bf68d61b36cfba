"""`record` on a night with a power cycle, steps, gaps, or a stuck or constant channel.

The record must be divided into segments, or refused with the reason.
"""

import csv
import datetime
import random

from programs import BIN, Scratch, demand, read_json, rows, run

STEP_S = 20
COLUMNS = ("time_utc", "acceleration_mgal", "temperature_degc")
NIGHT = 'base = "indoor"\nname = "part"\n[schedule]\nstart_utc = "{start}"\nduration_h = 5.0\n'
# Switched off for twenty minutes.  The sensor heats itself by 0.94 degC; with a time constant of 1034 s it loses 0.6 degC of
# this, and regains it after power-on.
POWER_CYCLE = "[sensor]\npower_on_before_start_h = 0.25\ntemperature_warm_up_degc = -0.6\n[oven]\nrun_in_h = 0.25\n"
THERMOMETER_DEGC = 0.0015  # Standard deviation of the thermometer's white noise, 20 s samples.


def record(folder, out, *files, check=True):
    return run(BIN / "a351-correct", "record", *files, "--ensemble", "2", "--out", out, cwd=folder, check=check)


def analysed(folder, title, *files):
    """Runs `record` with its output in a folder named `title`, prints the segments and returns result.json."""
    record(folder, title, *files)
    result = read_json(folder / title / "result.json")
    print(f"{title}:", [(part["samples"], part["bridged"], part["begins_with"]) for part in result["segments"]],
          [part["reason"] for part in result["refused"]])
    return result


def demand_refused(folder, title, words, *files):
    bad = record(folder, title, *files, check=False)
    print(f"{title}: {bad.stderr.strip()}")
    demand(f"{title}: refused in one line with the reason, status 2, nothing written", bad.returncode == 2 and
           bad.stderr.count("\n") == 1 and words in bad.stderr and not (folder / title).exists())


def write(folder, table, change=lambda i, row: row):
    """Writes the rows of record.csv, each changed by `change`; rows for which it returns None are left out."""
    with open(folder / "changed.csv", "w", newline="") as file:
        out = csv.writer(file)
        out.writerow(COLUMNS)
        for i, row in enumerate(table):
            changed = change(i, [row[name] for name in COLUMNS])
            if changed is not None:
                out.writerow(changed)
    return "changed.csv"


def samples_of(result):
    return [part["samples"] for part in result["segments"]]


def begins(result):
    return [part["begins_with"] for part in result["segments"]]


with Scratch() as scratch:
    for name, start, more in (("evening", "2017-06-01T09:00:00Z", ""), ("night", "2017-06-01T14:20:00Z", POWER_CYCLE)):
        (scratch / f"{name}.toml").write_text(NIGHT.format(start=start) + more)
        run(BIN / "a351-sim", "survey", "--scenario", scratch / f"{name}.toml", "--seed", 721, "--out", scratch / name)
    result = analysed(scratch, "power cycle", "evening", "night")
    demand("a power cycle in the middle divides the record and is reported as a restart",
           len(result["segments"]) == 2 and begins(result)[1].endswith("a restart"))

    # A night without faults, from which the faulty ones are made.
    run(BIN / "a351-sim", "survey", "--scenario", "indoor", "--seed", 722, "--out", scratch / "whole")
    result = analysed(scratch, "no trouble", "whole")
    table = [row for row in rows(scratch / "no trouble" / "record.csv") if row["segment"]]
    count, middle = len(table), len(table) // 2
    demand("a night without faults is one segment", samples_of(result) == [count] and not result["refused"])

    def stepped(i, row):
        return [row[0], f"{float(row[1]) + (40.0 if i >= middle else 0.0):.6f}", row[2]]

    result = analysed(scratch, "step", write(scratch, table, stepped))
    demand("a step of 40 mGal divides the record at its place, and its size is found to 5 mGal",
           samples_of(result) == [middle, count - middle]
           and abs(float(begins(result)[1].removeprefix("step of ").removesuffix(" mGal")) - 40.0) < 5.0)

    for missing, is_divided in ((14, False), (16, True)):
        def gap(i, row):
            return None if middle <= i < middle + missing else row

        result = analysed(scratch, f"{missing} samples missing", write(scratch, table, gap))
        if is_divided:
            demand("a gap of 340 s divides the record, and no sample is interpolated",
                   begins(result)[1] == "gap of 340 s" and [part["bridged"] for part in result["segments"]] == [0, 0])
        else:
            demand("a gap of 300 s is bridged, and the bridged samples are counted", samples_of(result) == [count] and
                   result["segments"][0]["bridged"] == missing)

    stuck = 180

    def stuck_temperature(i, row):
        return [row[0], row[1], table[middle]["temperature_degc"]] if middle <= i < middle + stuck else row

    result = analysed(scratch, "temperature stuck for an hour", write(scratch, table, stuck_temperature))
    reason = f"the temperature is stuck at {float(table[middle]['temperature_degc']):.4f} degC"
    demand("an hour of stuck temperature is refused with its value, and the record before and after it is analysed",
           [part["reason"] for part in result["refused"]] == [reason] and len(result["segments"]) == 2 and
           sum(samples_of(result)) == count - stuck and begins(result)[1] == "end of the refused values")

    demand_refused(scratch, "temperature stuck throughout", reason, write(
        scratch, table, lambda i, row: [row[0], row[1], table[middle]["temperature_degc"]]))
    demand_refused(scratch, "a gap every two hours", "too short", write(scratch, table, lambda i, row: row if i % 360 > 20 else None))

    # An oven whose temperature does not change: the thermometer shows only its noise.
    noise = random.Random(7)
    start = datetime.datetime(2017, 6, 1, 9)
    still = [{"time_utc": f"{(start + datetime.timedelta(seconds=STEP_S * i)).isoformat()}Z",
              "acceleration_mgal": f"{979763.0 + noise.gauss(0.0, 1.5):.4f}",
              "temperature_degc": f"{42.5 + noise.gauss(0.0, THERMOMETER_DEGC):.6f}"} for i in range(count)]
    result = analysed(scratch, "constant temperature", write(scratch, still))
    paths = result["two_paths"]
    open_ones = [key for key, value in paths["parameters"].items() if not value["determined"]]
    print("not determined:", open_ones)
    demand("at constant temperature no band has a response",
           all(point["refused"] for way in ("spectrum", "modes") for point in result[f"response_by_{way}"]) and
           "shows no response" in result["causal_reading"])
    demand("at constant temperature no path and no lag is determined",
           {"level_mgal_per_degc", "fast_mgal_per_degc_per_h", "slow_mgal_per_degc", "fast_lag_s", "slow_lag_s"}
           <= set(open_ones) and not paths["static_slope_determined"])
