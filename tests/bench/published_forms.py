"""Measures the whole-day model on days of units that behave as other instruments do in the literature.

Each seed draws a unit within +-25 % and a day of each scenario, with
one set-up of 12 min in each occupation.  All stations are known; an error is that of a station left out.
A day is named if a test says that the model does not fit, or if the search for mistakes finds something.
Promised: the rms error is at most 1.7 mGal on the days that are not named.
"""

import concurrent.futures
import os
import shutil

from command_line import add_seeds, command_line, end_with
from simulated_units import correct, rms_by_day
from programs import BIN, Scratch, read_json, rows, run

SCENARIOS = ("warm-up", "three-links", "axis-biases", "quadratic", "drift-walk", "transport-step")
MISTAKES = {"moved_box", "other_name", "reference", "step", "bad_reading"}
MOST_MGAL = 1.7


def look_at(scratch, scenario, seed):
    """Returns the misfits of a day, its mistakes, and [error, u] of each station left out."""
    day = scratch / f"{scenario}-{seed}"
    run(BIN / "a351-sim", "survey", "--scenario", scenario, "--seed", seed, "--out", day)
    out = correct(day, day / "survey.toml", "result", "--model", "day", "--flags", "ignore")
    result = read_json(out / "result.json")
    misfits = {test["misfit"] for test in result["goodness_of_fit"]["tests"] if test["is_found"]}
    mistakes = {finding["kind"] for finding in result["findings"]} & MISTAKES
    errors = [(float(row["left_out_mgal"]) - float(row["reference_mgal"]), float(row["u_left_out_mgal"]))
              for row in rows(out / "stations.csv")]
    shutil.rmtree(day)
    return misfits, mistakes, errors


def text(days):
    return "{:.2f} +- {:.2f}".format(*rms_by_day(days))


line = command_line(__doc__, "published_forms.py 63001-63002 warm-up")
add_seeds(line, "63001-63006")
line.add_argument("scenarios", metavar="SCENARIO", nargs="*", default=SCENARIOS, help="scenarios of the days")
options = line.parse_args()
failures = []
print("scenario         days  misfit  mistake   rms left out, mGal   on days not named             e/u")
with Scratch() as scratch, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    for scenario in options.scenarios:
        days = list(pool.map(lambda seed, name=scenario: look_at(scratch, name, seed), options.seeds))
        quiet = [[error for error, _ in errors] for misfits, mistakes, errors in days if not misfits | mistakes]
        print(f"{scenario:15} {len(days):5} {sum(bool(day[0]) for day in days):7} {sum(bool(day[1]) for day in days):8} "
              f"{text([error for error, _ in errors] for *_, errors in days):>20} {text(quiet) if quiet else '-':>19} "
              f"{text([error / u for error, u in errors] for *_, errors in days):>15}", flush=True)
        if quiet and rms_by_day(quiet)[0] > MOST_MGAL:
            failures.append(f"{scenario}: {text(quiet)} mGal on days that are not named, promised {MOST_MGAL}")
end_with(failures)
