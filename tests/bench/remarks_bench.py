"""Measures whether readings with a remark are worse than those without.

Each seed gives a day of tsukuba, hot-afternoon and roadside with one and two set-ups, of a unit within +-25 %.
An error is the value against the truth: `day` predicts each reading without the reference of its station, the linear models
without the reading, `paper` has used it.  A remark is counted by its sentence without its numbers.
Printed per remark with 20 readings and more: readings with it, their error rms, that of all others, and the difference, with standard
errors from days left out in turn.  A remark on the quality of a reading stays only if its readings are worse by more than two of them.
"""

import concurrent.futures
import math
import os
import re
import shutil

from command_line import add_seeds, command_line
from simulated_units import correct, rms, simulate
from programs import Scratch, rows

KINDS = [(scenario, setups) for scenario in ("tsukuba", "hot-afternoon", "roadside") for setups in (1, 2)]
FEWEST = 20


def error_of(model, reading, truth_mgal):
    if model == "day":
        return float(reading["left_out_mgal"]) - truth_mgal
    error = float(reading["corrected_mgal"]) - truth_mgal
    return error if model == "paper" else error / (1.0 - float(reading["leverage"]))


def remarks_of(reading):
    """Returns the remarks of a reading, and its grade."""
    reasons = re.sub(r"-?\d+(\.\d+)?", "#", reading["grade_reason"]).split("; ")
    flags = [f"flag {flag}" for flag in reading["flags"].split(";") if flag]
    return {f"grade {reading['grade']}", *flags, *filter(None, reasons)}


def look_at(scratch, models, seed, kind):
    """Returns (error, remarks) of the readings of a day by model."""
    scenario, setups = kind
    folder = scratch / f"{scenario}-{setups}-{seed}"
    folder.mkdir()
    day = simulate(folder, "day", scenario, seed, 0.25, f"[schedule]\nsetups = {setups}\n")
    truth = {row["site"]: float(row["gravity_mgal"]) for row in rows(day / "truth.csv")}
    found = {}
    for model in models:
        table = rows(correct(folder, day / "survey.toml", model, "--model", model) / "occupations.csv")
        found[model] = [(error_of(model, reading, truth[reading["site"]]), remarks_of(reading)) for reading in table]
    shutil.rmtree(folder)
    return found


def jackknifed(days, value):
    """Returns a value of all days, and its standard error from that of all but one."""
    parts = [value(days[:k] + days[k + 1:]) for k in range(len(days))]
    mean = sum(parts) / len(parts)
    return value(days), math.sqrt((len(days) - 1) / len(days) * sum((part - mean) ** 2 for part in parts))


def errors(days, remark, has_it):
    return [error for day in days for error, remarks in day if (remark in remarks) == has_it] or [0.0]


def show(model, days):
    print(f"\n{model}: {sum(map(len, days))} readings of {len(days)} days\n"
          f"{'readings':>8}  {'with, mGal':>12}  {'without':>12}  {'difference':>13}  remark")
    counts = {}
    for day in days:
        for _, remarks in day:
            for remark in remarks:
                counts[remark] = counts.get(remark, 0) + 1
    for remark, count in sorted(counts.items(), key=lambda one: (one[0].split()[0] == "grade", -one[1])):
        if count < FEWEST:
            continue
        values = [jackknifed(days, lambda some: rms(errors(some, remark, True))),
                  jackknifed(days, lambda some: rms(errors(some, remark, False))),
                  jackknifed(days, lambda some: rms(errors(some, remark, True)) - rms(errors(some, remark, False)))]
        difference, error = values[2]
        word = "WORSE" if difference > 2.0 * error else "not worse"
        print(f"{count:8}" + "".join(f"  {value:6.2f} +-{error:4.2f}" for value, error in values) + f"  {word}: {remark}", flush=True)


line = command_line(__doc__, "remarks_bench.py 93001-93002 day", has_promises=False)
add_seeds(line, "93001-93015")
line.add_argument("models", metavar="MODEL", nargs="*", default=["day", "paper"], help="models of the correction")
options = line.parse_args()
seeds, models = options.seeds, options.models
with Scratch() as scratch, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    days = list(pool.map(lambda job: look_at(scratch, models, *job), [(seed, kind) for kind in KINDS for seed in seeds]))
for model in models:
    show(model, [day[model] for day in days])
