"""Measures whether differences between stations scatter as differences.csv says.

usage: differences.py [SEEDS]    (A351_BIN, A351_TOOLS)
SEEDS: default 9701-9740, which were not used while the differences were developed.  Each seed draws a unit within +-25 % and
a day of tsukuba, whose 14 stations are all known.  Each of the 91 differences is measured without the references of its two
stations.  Promised: their rms error is within 10 % of the rms of their uncertainties.
"""

import concurrent.futures
import os
import shutil
import sys

from simulated_units import correct, rms, seeds_of, simulate
from programs import Scratch, rows

PROMISED = 0.9, 1.1


def errors_and_uncertainties(scratch, seed):
    folder = scratch / str(seed)
    folder.mkdir()
    day = simulate(folder, "day", "tsukuba", seed, 0.25)
    out = correct(folder, day / "survey.toml", "result")
    found = [(float(row["residual_mgal"]), float(row["u_difference_mgal"])) for row in rows(out / "differences.csv")]
    shutil.rmtree(folder)
    return found


seeds = seeds_of(sys.argv[1] if len(sys.argv) > 1 else "9701-9740")
with Scratch() as scratch, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    every = [one for day in pool.map(lambda seed: errors_and_uncertainties(scratch, seed), seeds) for one in day]
error, u = rms(one[0] for one in every), rms(one[1] for one in every)
within = sum(abs(error) <= 2.0 * u for error, u in every) / len(every)
print(f"{len(every)} differences of {len(seeds)} days: rms error {error:.3f} mGal, rms of u {u:.3f} mGal, ratio {error / u:.3f}, "
      f"promised {PROMISED[0]} to {PROMISED[1]}; {100.0 * within:.1f} % within 2 u")
sys.exit(not PROMISED[0] <= error / u <= PROMISED[1])
