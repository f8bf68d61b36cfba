"""Measures how often the whole-day model says that it does not fit a day.

The first DAYS seeds have ordinary days; from each of the first MISFIT the days with a misfit are made, too.  Each seed draws a unit
within +-25 % and a day of tsukuba, whose stations are all known.
- quadratic: the reading changes by 60 mGal/degC^2 times the square of the temperature.
- step: all readings after one drive, which is drawn, are off by 8 mGal.
- heavy tails: one set-up in five has a placement that is ten times as large.
A day is said not to fit by one of the three tests.  Days on which the search for mistakes finds something are counted too.
e/u is the rms of error divided by stated uncertainty, at stations left out in turn.
The bounds are the shares of steps and of heavy tails that the best possible tests would find in the first ordinary days
(misfit_bound.cpp).  They know the size of the noise; a test that does not finds fewer heavy tails (accuracy.md).
"""

import concurrent.futures
import os
import shutil

from command_line import add_days, at_least, command_line, end_with
from simulated_units import correct, rms_by_day, simulate
from programs import TOOLS, Scratch, read_json, rows, run

FALSE_ALARMS = 0.015  # of the bounds: that of the test for a step.
BOUNDS = {"step": ("step", 8), "heavy tails": ("gross", 0.2, 10)}
DAYS = {"ordinary": ("", None), "quadratic": ("crystal_quadratic_mgal_per_degc2 = 60.0\n", 0.9),
        "step": ("[slow_noise]\ntransport_step_mgal = 8.0\n", None),  # 90 % are above the bound.
        "heavy tails": ("[slow_noise]\nplacement_gross_share = 0.2\nplacement_gross_factor = 10.0\n", 0.9)}
MOST_FALSE = 0.05
NO_MISTAKES = ("misfit", "not_visited", "unusable_day")  # Kinds of findings that do not come from the search.


def look_at(scratch, name, seed):
    """Returns the misfits of a day, if it has a mistake, [[error, u]] of the stations left out, the bounds of an ordinary day."""
    folder = scratch / f"{name}-{seed}"
    folder.mkdir()
    day = simulate(folder, "day", "tsukuba", seed, 0.25, DAYS[name][0])
    out = correct(folder, day / "survey.toml", "result", "--model", "day")
    result = read_json(out / "result.json")
    found = {test["misfit"] for test in result["goodness_of_fit"]["tests"] if test["is_found"]}
    is_mistaken = any(finding["kind"] not in NO_MISTAKES for finding in result["findings"])
    errors = [(float(row["left_out_mgal"]) - float(row["reference_mgal"]), float(row["u_left_out_mgal"]))
              for row in rows(out / "stations.csv")]
    bounds = {}
    if name == "ordinary" and seed < first + misfit:
        bounds = {kind: float(run(TOOLS / "misfit-bound", day / "survey.toml", FALSE_ALARMS, *arguments).stdout)
                  for kind, arguments in BOUNDS.items()}
    shutil.rmtree(folder)
    return found, is_mistaken, errors, bounds


line = command_line(__doc__, "misfits.py 10601 8 4")
add_days(line, 10601, 200)
line.add_argument("misfit", metavar="MISFIT", nargs="?", type=at_least(1), default=40, help="number of days with each misfit")
options = line.parse_args()
first, ordinary, misfit = options.first, options.days, options.misfit
failures = []
with Scratch() as scratch, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    print("days                curvature  step  tails  said, %  mistakes  either  error, mGal         e/u")
    for name, (_, promised) in DAYS.items():
        count = ordinary if name == "ordinary" else misfit
        days = list(pool.map(lambda seed: look_at(scratch, name, seed), range(first, first + count)))
        share = sum(bool(found) for found, *_ in days) / count
        curvature, step, tails = (sum(kind in found for found, *_ in days) for kind in ("curvature", "step", "tails"))
        mistaken = sum(is_mistaken for _, is_mistaken, *_ in days)
        either = sum(bool(found) or is_mistaken for found, is_mistaken, *_ in days)
        (error, of_error), (ratio, of_ratio) = (rms_by_day([one(*station) for station in day] for *_, day, _ in days)
                                                for one in (lambda e, u: e, lambda e, u: e / u))
        print(f"{f'{count} {name}':19} {curvature:9} {step:5} {tails:6} {100.0 * share:8.1f} {mistaken:9} {either:7} {error:5.2f} +- {of_error:.2f} "
              f"{ratio:4.2f} +- {of_ratio:.2f}", flush=True)
        for kind in BOUNDS:
            bounds = [of_day[kind] for *_, of_day in days if of_day]
            if bounds:
                print(f"    the best possible test with {100.0 * FALSE_ALARMS} % false alarms would find {kind} on "
                      f"{100.0 * sum(bounds) / len(bounds):.1f} % of {len(bounds)} days", flush=True)
        if name == "ordinary" and share > MOST_FALSE:
            failures.append(f"said on {100.0 * share:.1f} % of ordinary days, promised at most {100.0 * MOST_FALSE:.0f} %")
        if promised is not None and share < promised:
            failures.append(f"{name}: said on {100.0 * share:.1f} %, promised {100.0 * promised:.0f} %")
end_with(failures)
