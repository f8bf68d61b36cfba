"""Measures errors and stated uncertainties at unknown stations when one, two or three stations are known.

Each seed draws a unit, and its day is simulated for every scenario.
A351_CALIBRATED=0: without calibrations, whose records take most of the time.

The survey is corrected with the default model.  Errors are those of gravity_mgal in stations.csv at the stations without a
reference, e/u is rms(error / u_gravity_mgal).
A calibration has the axis biases of a tilt series and the thermal response of two days, of the same unit.
"""

import collections
import concurrent.futures
import os
import shutil

from command_line import add_seeds, command_line, end_with
from simulated_units import TWO_DAYS, VALID_FROM, add_folder, correct, hide_references, kept, measure, rms_by_day, simulate
from programs import BIN, Scratch, read_json, rows, run

# Scenario and scatter of its units.  Promised errors in mGal for each number of known stations, without and with calibration.
CELLS = {("tsukuba", 0.25): ({1: 2.9, 2: 1.8, 3: 1.8}, {}), ("tsukuba", 0.6): ({1: 3.0, 2: 2.0, 3: 2.0}, {}),
         ("hot-afternoon", 0.25): ({1: 3.2, 2: 2.0, 3: 2.0}, {}),
         ("tilted", 0.25): ({1: 3.6, 2: 2.7, 3: 2.5}, {1: 2.9, 2: 1.8})}
KNOWN = {1: ["No.0"], 2: ["No.0", "No.7"], 3: ["No.0", "No.7", "No.12"]}
HONEST_POOLED, HONEST_CELL, LEAST_WITHIN_2U = (0.8, 1.15), (0.65, 1.35), 0.92


def calibration_of(folder, seed, scatter, days, has_biases):
    """Returns the option that uses the calibration of the seed's unit: its tilt series, with the thermal part of `days`."""
    # The biases of a seed are the same in all scenarios that have any; tsukuba and hot-afternoon have none.
    more = "" if has_biases else "[sensor]\nhorizontal_bias_max_mgal = 0.0\n"
    tilt = simulate(folder, "tilt-series", "tilt-series", seed, scatter, more)
    file = folder / f"calibration-{scatter}-{has_biases}.toml"
    run(BIN / "a351-correct", "calibrate", "--tilt", tilt, "--valid-from", VALID_FROM, "--out", file,
        *(["--merge", days[1]] if days else []))
    shutil.rmtree(tilt)
    return ["--calibration", file]


def look_at(scratch, seed):
    """Returns [scenario, scatter, known, is calibrated, model, [[error, u] of each unknown station]] of all surveys of a seed."""
    folder = scratch / str(seed)
    folder.mkdir()
    days_of, calibrations = {}, {}
    found = []
    for scenario, scatter in CELLS:
        options = [[]]
        if os.environ.get("A351_CALIBRATED") != "0":
            if scatter not in days_of:
                days_of[scatter] = measure(folder, f"days-{scatter}", "week", seed, scatter, TWO_DAYS)
            unit = (scatter, scenario == "tilted")
            if unit not in calibrations:
                calibrations[unit] = calibration_of(folder, seed, scatter, days_of[scatter], unit[1])
            options.append(calibrations[unit])
        day = simulate(folder, f"{scenario}-{scatter}", scenario, seed, scatter)
        for count, known in KNOWN.items():
            survey, truth = hide_references(day, known, f"known-{count}")
            for is_calibrated, option in enumerate(options):
                out = correct(day, survey, f"{count}-{is_calibrated}", *option)
                model = read_json(out / "result.json")["model"]
                errors = [[float(row["gravity_mgal"]) - truth[row["site"]], float(row["u_gravity_mgal"] or "nan")]
                          for row in rows(out / "stations.csv") if row["site"] not in known]
                found.append([scenario, scatter, count, bool(is_calibrated), model, errors])
        shutil.rmtree(day)
    shutil.rmtree(folder)
    print(f"unit {seed} done", flush=True)
    return found


def figures(days):
    """Returns error with its standard error, e/u and share within 2 u of days, each a list of [error, u]."""
    every = [one for day in days for one in day]
    return (*rms_by_day([error for error, _ in day] for day in days), rms_by_day([error / u for error, u in day] for day in days)[0],
            sum(abs(error) <= 2.0 * u for error, u in every) / len(every))


failures = []


def demand_within(name, value, low, high):
    if not low <= value <= high:
        failures.append(f"{name}: {value:.3f}, promised {low} to {high}")


line = command_line(__doc__, "few_datums.py 9501-9504")
add_seeds(line, "9501-9540")
add_folder(line)
options = line.parse_args()
cells, models = collections.defaultdict(dict), collections.Counter()
with Scratch() as scratch, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    store, part = options.keep or scratch, os.environ.get("A351_CALIBRATED", "1")
    for results in pool.map(lambda seed: kept(store / f"{seed}-{part}.json", lambda: look_at(scratch, seed)), options.seeds):
        for scenario, scatter, known, is_calibrated, model, errors in results:
            cells[is_calibrated, scenario, scatter].setdefault(known, []).append(errors)
            models[model] += 1


def show(name, days_of):
    """Prints a row of the table, and returns its figures by number of known stations."""
    found = {known: figures(days) for known, days in days_of.items()}
    print(f"{name:46}" + "".join(f"{error:13.2f} +- {u:.2f} {ratio:5.2f}" for error, u, ratio, _ in found.values()), flush=True)
    return found


print(f"{'rms error, mGal, and e/u; known:':46}" + "".join(f"{', '.join(known):>27}" for known in KNOWN.values()))
for (is_calibrated, scenario, scatter), days_of in cells.items():
    name = f"{scenario}, units within {100 * scatter:.0f} %{', calibrated' if is_calibrated else ''}"
    for known, (error, _, ratio, _) in show(name, days_of).items():
        demand_within(f"{name}, {known} known, e/u", ratio, *HONEST_CELL)
        if (most := CELLS[scenario, scatter][is_calibrated].get(known)) is not None:
            demand_within(f"{name}, {known} known, error", error, 0.0, most)
# The surveys of a unit are not independent of each other.
pooled = {known: [[one for days_of in cells.values() for one in days_of[known][k]] for k in range(len(options.seeds))] for known in KNOWN}
found = show("all", pooled)
print(f"{'within 2 u':46}" + "".join(f"{100.0 * within:25.1f} %" for *_, within in found.values()))
print(f"{len(options.seeds)} units; surveys by model: " + ", ".join(f"{model} {count}" for model, count in models.items()))
for known, (*_, ratio, within) in found.items():
    demand_within(f"{known} known, e/u", ratio, *HONEST_POOLED)
    demand_within(f"{known} known, within 2 u", within, LEAST_WITHIN_2U, 1.0)
end_with(failures)
