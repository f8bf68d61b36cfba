"""Measures how often the mistakes of operators are named, and how often something false is said of a day without one.

CLEAN days of tsukuba, tilted, hot-afternoon and roadside in turn have no mistake.  On DAYS days of the first three at most MOST
mistakes of each kind are made, one at a time (mistake_trials.cpp).  Each seed draws a unit within +-25 %.
Each day is printed with its trials / named / otherwise / in a headline.
"""

import collections
import concurrent.futures
import os
import shutil

from command_line import at_least, command_line, end_with
from simulated_units import simulate
from programs import TOOLS, Scratch, run

# Share of the trials in which the mistake is named.
PROMISED = {"reference_8": 0.95, "reference_20": 0.95, "reference_50": 0.95, "swap": 0.95, "other_name": 0.95,
            "clear_step_3": 0.95, "clear_step_5": 0.95, "clear_step_10": 0.95, "clear_step_100": 0.95}
MOST_SAID, MOST_HEADLINES = 0.05, 0.005  # of clean days


def trials(scratch, scenario, seed, most):
    """Returns trials, named, otherwise, otherwise in a headline, by kind."""
    folder = scratch / f"{scenario}-{seed}-{most}"
    folder.mkdir()
    day = simulate(folder, "day", scenario, seed, 0.25)
    lines = run(TOOLS / "mistake-trials", day / "survey.toml", most).stdout.splitlines()
    shutil.rmtree(folder)
    return {kind: [int(number) for number in numbers] for kind, *numbers in (line.split() for line in lines)}


line = command_line(__doc__, "mistakes_bench.py 28001 4 3 2")
line.add_argument("first", metavar="FIRST_SEED", nargs="?", type=at_least(0), default=28001,
                  help="seed of the first day; the default ones were not used in development")
for name, default, meaning in (("clean", 200, "number of days without a mistake"), ("days", 6, "number of days with mistakes"),
                               ("most", 6, "largest number of mistakes of each kind on a day")):
    line.add_argument(name, metavar=name.upper(), nargs="?", type=at_least(0), default=default, help=meaning)
options = line.parse_args()
first, clean, days, most = options.first, options.clean, options.days, options.most
jobs = [(("tsukuba", "tilted", "hot-afternoon", "roadside")[k % 4], first + k, 0) for k in range(clean)]
jobs += [(("tsukuba", "hot-afternoon", "tilted")[k % 3], first + clean + k, most) for k in range(days)]
totals = collections.defaultdict(lambda: [0, 0, 0, 0])
with Scratch() as scratch, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    for job, counts in zip(jobs, pool.map(lambda job: trials(scratch, *job), jobs)):
        said = ", ".join(f"{kind} {'/'.join(map(str, numbers))}" for kind, numbers in counts.items() if sum(numbers))
        print(f"seed {job[1]}: {job[0]}: {said}", flush=True)
        for kind, numbers in counts.items():
            totals[kind] = [one + other for one, other in zip(totals[kind], numbers)]
failures = []
print("mistake          trials  named  something else  in a headline")
for kind, (count, named, otherwise, headlines) in totals.items():
    if not count:
        continue
    if kind.startswith("attainable"):
        print(f"{kind:16} the best possible test names {100.0 * named / count:.1f} %")
        continue
    print(f"{kind:16} {count:6} {named if kind != 'clean' else '-':>6} {otherwise:15} {headlines:14}")
    if kind == "clean" and (otherwise > MOST_SAID * count or headlines > MOST_HEADLINES * count):
        failures.append(f"something is said of {otherwise} of {count} days without a mistake, in a headline of {headlines}")
    if (promised := PROMISED.get(kind)) is not None and named < promised * count:
        failures.append(f"{kind}: named in {named} of {count}, promised {100.0 * promised:.0f} %")
end_with(failures)
