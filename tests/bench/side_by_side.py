"""Measures how well the scale of the sensor is found beside a reference gravimeter.

Each seed draws a unit within +-25 %, a scale with a standard deviation of 1 %, and a day of tsukuba without published gravity.
A gravimeter reads each occupation with 0.01 mGal, a drift, and a scale of its own that is off by 1e-4 (standard deviation).
The prior of the sensor's scale is 1 +- 0.02.  u/known is the standard uncertainty of the scale, divided by the one of a day
with known noise and response (known_scale.cpp).
The first day is corrected with the usual prior too, to show what the result says of it.
"""

import concurrent.futures
import os
import random
import shutil
import statistics

from command_line import add_days, command_line, end_with
from simulated_units import correct, hide_references, simulate
from programs import TOOLS, Scratch, instant, read_json, rows, run

PRIOR_SD = 0.02
SCALE_SD = 0.01
METER_MGAL = 0.01
METER_SCALE_SD = 1e-4
PLACEMENT_MGAL, FLICKER_MGAL = 1.2, 1.2  # of config/scenarios/tsukuba.toml
MOST_WIDER = 1.15


def write_meter(day, seed):
    """Writes the readings of a gravimeter at the occupations of the day, as `a351-correct import` does."""
    draw = random.Random(f"meter {seed}")
    scale = draw.gauss(1.0, METER_SCALE_SD)
    lines = ["site,occupation,outlier,time_utc,earth_tide_mgal,acceleration_mgal,temperature_degc,instrument,loop"]
    start = gravity = None
    for row in rows(day / "truth.csv"):
        time = instant(row["start_utc"])
        start, gravity = start or time, gravity or float(row["gravity_mgal"])
        hours = (time - start).total_seconds() / 3600.0
        reading = 2500.0 + scale * (float(row["gravity_mgal"]) - gravity) + 0.02 * hours + draw.gauss(0.0, METER_MGAL)
        lines.append(f'{row["site"]},{row["occupation"]},0,{row["start_utc"]},0,{reading:.5f},,METER-1,1')
    (day / "meter.csv").write_text("\n".join(lines) + "\n")


def look_at(scratch, seed):
    """Returns the true scale, the result of the day, the known standard error of the scale, and what the usual prior says."""
    folder = scratch / str(seed)
    folder.mkdir()
    truth = random.Random(f"scale {seed}").gauss(1.0, SCALE_SD)
    day = simulate(folder, "day", "tsukuba", seed, 0.25, f"[sensor]\nscale = {truth}\n")
    write_meter(day, seed)
    survey, _ = hide_references(day, [], "compared")
    text = survey.read_text() + '\n[reference]\nobservations = "meter.csv"\n'
    usual = None
    if seed == first:
        survey.write_text(text)
        usual = read_json(correct(folder, survey, "usual", "--model", "day") / "result.json")
    survey.write_text(text + f"\n[prior]\nscale = [1, {PRIOR_SD}]\n")
    result = read_json(correct(folder, survey, "result", "--model", "day") / "result.json")
    known = float(run(TOOLS / "known-scale", survey, PLACEMENT_MGAL, FLICKER_MGAL).stdout)
    shutil.rmtree(folder)
    return truth, result, known, usual


line = command_line(__doc__, "side_by_side.py 62001 3")
add_days(line, 62001, 20)
options = line.parse_args()
first, count = options.first, options.days
within = wider = narrower = 0
ratios = []
with Scratch() as scratch, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    for seed, (truth, result, known, usual) in zip(range(first, first + count),
                                                   pool.map(lambda seed: look_at(scratch, seed), range(first, first + count))):
        scale, both = result["scales"][0], result["side_by_side"]
        low, high = scale["limits_95"]
        ratios.append(scale["u"] / known)
        within += low <= truth <= high
        wider += ratios[-1] > MOST_WIDER
        narrower += scale["u"] < PRIOR_SD
        print(f"{seed}: scale {truth:.5f}, found {scale['value']:.5f} +- {scale['u']:.5f}, {100.0 * scale['prior_share']:.0f} % prior, "
              f"u/known {ratios[-1]:.2f}; ours minus theirs {both['scatter_mgal']:.2f} mGal rms", flush=True)
        if usual is not None:
            scale = usual["scales"][0]
            print(f"{seed} with the usual prior: found {scale['value']:.5f} +- {scale['u']:.5f}, {100.0 * scale['prior_share']:.0f} % prior")
least = count * 17 // 20
failures = []
print(f"scale within its 95 % limits on {within} of {count} days, must be at least {least}")
print(f"u/known in the mean {statistics.fmean(ratios):.2f}, must be at most {MOST_WIDER}; {min(ratios):.2f} to {max(ratios):.2f}, "
      f"above it on {wider} days, because the noise of a day is estimated from its few set-ups")
print(f"limits narrower than the prior's on {narrower} of {count} days, must be all")
if within < least:
    failures.append("the scale is outside its limits too often")
if statistics.fmean(ratios) > MOST_WIDER:
    failures.append(f"the limits are more than {100.0 * (MOST_WIDER - 1.0):.0f} % wider than with everything known")
if narrower < count:
    failures.append("the limits are not narrower than those of the prior")
end_with(failures)
