"""Measures what the temperature of an outer oven brings: the same simulated days, corrected with and without it.

Days: the scenario double-oven; each seed draws a unit within +-25 %.  Without: the channel LK4 is taken out of the archive.
Errors: out of sample, each station left out in turn.  The interval is that of the ratio of the mean errors over days, from
4000 bootstrap samples of the days.
Promised: an error that is 5 % smaller where the wall acts, and not larger where it does not.
"""

import concurrent.futures
import os
import random
import shutil
import statistics

from command_line import add_seeds, command_line, end_with
from simulated_units import correct, rms
from programs import BIN, Scratch, read_json, rows, run

BOOTSTRAPS = 4000


def look_at(day, out):
    """Returns the rms error of the left-out readings, the share of them within u, and the slow slope found with its error."""
    correct(day, day / "survey.toml", out, "--model", "day", "--flags", "ignore")
    table = rows(day / out / "occupations.csv")
    errors = [float(row["left_out_mgal"]) - float(row["reference_mgal"]) for row in table]
    coefficients = {one["name"]: one for one in read_json(day / out / "result.json")["coefficients"]}
    found = coefficients.get("outer_slow_mgal_per_degc")
    return {"error": rms(errors),
            "inside": statistics.fmean(abs(error) <= float(row["u_corrected_mgal"]) for error, row in zip(errors, table)),
            "slope": (found["value"], found["standard_error"]) if found else None}


def measure(scratch, slope, seed):
    day = scratch / f"{slope}-{seed}"
    scenario = scratch / f"{day.name}.toml"
    scenario.write_text(f'base = "double-oven"\nname = "double-oven"\n[outer_oven]\nreading_mgal_per_degc = {slope}\n'
                        "[temperature_error]\nunit_scatter = 0.25\n")
    run(BIN / "a351-sim", "survey", "--scenario", scenario, "--seed", seed, "--out", day)
    effects = [float(row["outer_oven_mgal"]) for row in rows(day / "truth.csv")]
    found = {"effect": statistics.pstdev(effects), "with": look_at(day, "with")}
    for channel in day.glob("archive/*/*/*/LK4.D"):
        shutil.rmtree(channel)
    found["without"] = look_at(day, "without")
    shutil.rmtree(day)
    return found


def ratio(days):
    """Returns mean error with over mean error without, and its 95 % interval over the days."""
    pairs = [(day["with"]["error"], day["without"]["error"]) for day in days]
    one = lambda sample: sum(a for a, _ in sample) / sum(b for _, b in sample)  # noqa: E731
    chance = random.Random(1)
    drawn = sorted(one(chance.choices(pairs, k=len(pairs))) for _ in range(BOOTSTRAPS))
    return one(pairs), drawn[round(0.025 * BOOTSTRAPS)], drawn[round(0.975 * BOOTSTRAPS) - 1]


def main():
    line = command_line(__doc__, "double_oven.py 71001-71004 60")
    add_seeds(line, "71001-71020")
    line.add_argument("slopes", metavar="SLOPE", nargs="*", type=float, default=[60.0, 0.0],
                      help="what the outer wall does to the reading, mGal/degC")
    options = line.parse_args()
    seeds, failures = options.seeds, []
    with Scratch() as scratch, concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        for slope in options.slopes:
            days = []
            for seed, day in zip(seeds, pool.map(lambda seed: measure(scratch, slope, seed), seeds)):
                days.append(day)
                value, error = day["with"]["slope"]
                print(f"seed {seed}: {slope:g} mGal/degC: error with {day['with']['error']:.3f}, without {day['without']['error']:.3f} "
                      f"mGal; slope {value:.1f} +- {error:.1f}; effect on the stays {day['effect']:.2f} mGal rms", flush=True)
            change, low, high = ratio(days)
            print(f"{slope:g} mGal/degC, {len(days)} days: " + ", ".join(
                f"{arm} {statistics.fmean(day[arm]['error'] for day in days):.3f} mGal "
                f"({100 * statistics.fmean(day[arm]['inside'] for day in days):.0f} % within u)" for arm in ("with", "without"))
                + f"; with over without {change:.3f} (95 % interval {low:.3f} to {high:.3f})", flush=True)
            if slope != 0.0 and change > 0.95:
                failures.append(f"{slope:g} mGal/degC: the error is not 5 % smaller")
            if slope == 0.0 and low > 1.0:
                failures.append("where the outer temperature says nothing, the error is larger")
    end_with(failures)


if __name__ == "__main__":
    main()
