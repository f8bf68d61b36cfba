"""Measures how well `calibrate --placement` finds the scatter of set-ups, and how often its limits contain the truth.

Each seed draws a unit within +-25 % whose
placement is between 0.6 and 2.4 mGal, evenly in its logarithm, and makes the scenario placement: twenty set-ups at one point in
an hour.  Promised: the true standard deviation is within the stated 95 % limits in 17 of 20.
"""

import concurrent.futures
import math
import os
import random
import shutil
import tomllib

from command_line import add_seeds, command_line, end_with
from simulated_units import rms, simulate
from programs import BIN, Scratch, run

LEAST_MGAL, GREATEST_MGAL = 0.6, 2.4
PROMISED_SHARE = 17 / 20


def truth_of(seed):
    """Returns the placement of a seed's unit, mGal."""
    return LEAST_MGAL * (GREATEST_MGAL / LEAST_MGAL) ** random.Random(f"placement {seed}").random()


def measured(scratch, seed):
    """Returns the table [placement] of the calibration of a seed's unit."""
    folder = scratch / str(seed)
    folder.mkdir()
    root = simulate(folder, "day", "placement", seed, 0.25, f"[slow_noise]\nplacement_mgal = {truth_of(seed)}\n")
    run(BIN / "a351-correct", "calibrate", "--placement", root, "--out", folder / "unit.toml")
    found = tomllib.loads((folder / "unit.toml").read_text())["placement"]
    shutil.rmtree(folder)
    return found


line = command_line(__doc__, "placement_bench.py 13001-13004")
add_seeds(line, "13001-13020")
seeds = line.parse_args().seeds
inside, logs = 0, []
with Scratch() as scratch, concurrent.futures.ThreadPoolExecutor(int(os.environ.get("A351_JOBS", os.cpu_count()))) as pool:
    for seed, found in zip(seeds, pool.map(lambda seed: measured(scratch, seed), seeds)):
        truth, (low, high) = truth_of(seed), found["limits_mgal"]
        is_inside = low <= truth <= high
        inside += is_inside
        logs.append(math.log(found["standard_deviation_mgal"] / truth))
        print(f"{seed}: {truth:.2f} mGal, found {found['standard_deviation_mgal']:.2f} ({low:.2f} to {high:.2f})"
              f"{'' if is_inside else ', outside'}", flush=True)
share = inside / len(logs)
print(f"{inside} of {len(logs)} within the 95 % limits, promised {PROMISED_SHARE:.0%}; rms of ln(found / truth) {rms(logs):.3f}, "
      f"mean {sum(logs) / len(logs):+.3f}")
end_with([f"{share:.0%} within the limits"] if share < PROMISED_SHARE else [])
