"""Measures whether differences between stations scatter as differences.csv and joint-differences.csv say.

Each seed draws a unit within +-25 % and two days of tsukuba with it, a month apart.  Each of the 91 differences of a day is
measured without the references of its two stations.
Promised: the rms error of the differences of single days is within 10 % of the rms of their uncertainties.  The same is printed
of the differences of both days together.
"""

import concurrent.futures
import os
import re
import shutil

from command_line import add_seeds, command_line, end_with
from simulated_units import correct, hide_references, rms, rms_by_day, simulate, unit_of
from programs import BIN, TOP, Scratch, rows, run

PROMISED = 0.9, 1.1
SECOND_DAY = 1_000_000  # Far from the seeds of units and first days.


def simulate_a_month_later(folder, name, seed):
    """Simulates tsukuba a month later with the seed's unit; returns its folder."""
    text = (TOP / "config" / "scenarios" / "tsukuba.toml").read_text().replace("2017-07-", "2017-08-")
    for key, value in unit_of(seed, 0.25).items():
        text, count = re.subn(rf"^{key} = .*$", f"{key} = {value}", text, flags=re.MULTILINE)
        assert count == 1, key
    scenario = folder / f"{name}-scenario.toml"
    scenario.write_text(text.replace('name = "tsukuba"', f'name = "{name}"', 1))
    run(BIN / "a351-sim", "survey", "--scenario", scenario, "--seed", SECOND_DAY + seed, "--out", folder / name)
    return folder / name


def errors_and_uncertainties(scratch, seed):
    """Returns the differences of both days, and those of the joint table."""
    folder = scratch / str(seed)
    folder.mkdir()
    surveys = []
    for root, model in ((simulate(folder, "first", "tsukuba", seed, 0.25), "day"),
                        (simulate_a_month_later(folder, "second", seed), second_model)):
        truth = {row["site"]: float(row["gravity_mgal"]) for row in rows(root / "sites.csv")}
        survey = hide_references(root, known or truth, root.name)[0]
        survey.write_text(survey.read_text().replace('model = "auto"', f'model = "{model}"'))
        surveys.append(survey)
    out = correct(folder, surveys[0], "result", surveys[1])

    def errors(file):
        return [(float(row["difference_mgal"]) - truth[row["to"]] + truth[row["from"]], float(row["u_difference_mgal"]))
                for row in rows(file)]

    single = [one for file in sorted(out.glob("*/differences.csv")) for one in errors(file)]
    found = single, errors(out / "joint-differences.csv")
    shutil.rmtree(folder)
    return found


def ratio_of(name, units):
    every = [one for unit in units for one in unit]
    (error, u_error), u = rms_by_day([error for error, _ in unit] for unit in units), rms(one[1] for one in every)
    within = sum(abs(error) <= 2.0 * u for error, u in every) / len(every)
    print(f"{len(every)} differences {name}: rms error {error:.3f} +- {u_error:.3f} mGal, rms of u {u:.3f} mGal, ratio {error / u:.3f}; "
          f"{100.0 * within:.1f} % within 2 u")
    return error / u


line = command_line(__doc__, "differences.py 9701-9704 No.0,No.7")
add_seeds(line, "9701-9740")
line.add_argument("known", metavar="KNOWN", nargs="?", default="",
                  help="sites whose gravity is known, joined by commas; default or empty: all 14")
line.add_argument("second_model", metavar="MODEL", nargs="?", default="day", help="model of the second day")
options = line.parse_args()
known, second_model = list(filter(None, options.known.split(","))), options.second_model
with Scratch() as scratch, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    every = list(pool.map(lambda seed: errors_and_uncertainties(scratch, seed), options.seeds))
ratio = ratio_of("of single days", [single for single, _ in every])
ratio_of("of two days together", [joint for _, joint in every])
end_with([] if PROMISED[0] <= ratio <= PROMISED[1] else
         [f"ratio of single days {ratio:.3f}, promised {PROMISED[0]} to {PROMISED[1]}"])
