"""Compares the uncertainty that `a351-correct design` expects with errors and uncertainties of simulated days of the same plan.

Each seed draws a day of tsukuba's weather for every plan.  Nothing is fitted to the days: the design
knows the plan and a usual unit only.

Errors are those of gravity_mgal in stations.csv at the stations without a reference, u is u_gravity_mgal there.  Promised: the
expected uncertainty is within 15 % of the rms error, and the model is `day`.
"""

import concurrent.futures
import datetime
import json
import os
import shutil
import tomllib

from command_line import add_seeds, command_line, end_with
from simulated_units import add_folder, assumed, correct, hide_references, kept, rms_by_day, simulate_unit, unit_of
from programs import BIN, TOP, Scratch, instant, read_json, rows, run, write_sites

START, EVERY_MIN = "2017-07-15T23:30:00Z", 35
ROUND = ("No.0", "No.1", "No.2", "No.3", "No.4", "No.7", "No.5", "No.6", "No.8", "No.9", "No.0")
LOOP = ("No.0", "No.1", "No.2", "No.3", "No.0", "No.1", "No.2", "No.3", "No.0")
# Name: visits, set-ups, minutes each, known stations.
PLANS = {"1 x 12 min": (ROUND, 1, 12.0, ("No.0", "No.7")), "2 x 6 min": (ROUND, 2, 6.0, ("No.0", "No.7")),
         "4 x 3 min": (ROUND, 4, 3.0, ("No.0", "No.7")), "one datum, two loops": (LOOP, 1, 12.0, ("No.0",))}
PROMISED = 0.85, 1.15
CALIBRATION = """format = 1
serial_number = "00000001"
program = "design_bench"
valid_from_utc = "2017-01-01T00:00:00Z"
[placement]
standard_deviation_mgal = 1.2
limits_mgal = [1.14, 1.26]
[[data]]
name = "made up"
sha256 = "0000000000000000000000000000000000000000000000000000000000000000"
"""


def instants(count):
    first = instant(START)
    return [first + datetime.timedelta(minutes=EVERY_MIN * k) for k in range(count)]


def text_of(time):
    return time.strftime("%Y-%m-%dT%H:%M:%SZ")


def ambient_at(time):
    """Returns the air temperature in the box at a time of tsukuba, a straight line between its stays."""
    stays = tomllib.loads((TOP / "config" / "scenarios" / "tsukuba.toml").read_text())["occupation"]
    knots = [(instant(stay["centre_utc"]), stay["ambient_degc"]) for stay in stays]
    if time <= knots[0][0]:
        return knots[0][1]
    for (before, low), (after, high) in zip(knots, knots[1:]):
        if time <= after:
            return low + (high - low) * (time - before) / (after - before)
    return knots[-1][1]


def scenario_of(visits, set_ups, minutes_each):
    """Returns the schedule of a plan in the form of a scenario."""
    lines = ["[schedule]", "lead_in_h = 8.0", "jitter_s = 0.0", f"setups = {set_ups}"]
    for k, (site, start) in enumerate(zip(visits, instants(len(visits)))):
        centre = start + datetime.timedelta(minutes=set_ups * minutes_each / 2.0)
        lines += ["[[occupation]]", f'site = "{site}"', f"number = {visits[:k].count(site) + 1}",
                  f'centre_utc = "{text_of(centre)}"', f"length_s = {60.0 * set_ups * minutes_each}",
                  f"ambient_degc = {ambient_at(centre):.2f}"]
    return "\n".join(lines) + "\n"


def expected_u(folder, plan):
    """Returns the uncertainty that the design of a plan gives, rms over the unknown stations."""
    visits, set_ups, minutes_each, known = PLANS[plan]
    lines = ["site,start_utc,set_ups,minutes_each"]
    lines += [f"{site},{text_of(start)},{set_ups},{minutes_each}" for site, start in zip(visits, instants(len(visits)))]
    (folder / "plan.csv").write_text("\n".join(lines) + "\n")
    table = rows(TOP / "tests" / "golden" / "tsukuba" / "sites.csv")
    write_sites(folder / "sites.csv", table, {row["site"]: row["gravity_mgal"] for row in table if row["site"] in known})
    return json.loads(run(BIN / "a351-correct", "design", "plan.csv", "--sites", "sites.csv", "--json", cwd=folder).stdout)["u_mgal"]


def look_at(scratch, seed, plan):
    """Returns model and [error, u] of each unknown station of a day."""
    visits, set_ups, minutes_each, known = PLANS[plan]
    folder = scratch / f"{seed}-{list(PLANS).index(plan)}"
    folder.mkdir()
    unit, more = assumed(seeds.index(seed), len(seeds)) if noise == "assumed" else (unit_of(seed, 0.25), "")
    day = simulate_unit(folder, "day", "tsukuba", seed, unit, more + scenario_of(visits, set_ups, minutes_each))
    survey, truth = hide_references(day, known, "known")
    (folder / "unit.toml").write_text(CALIBRATION)
    out = correct(folder, survey, "result", *(["--calibration", folder / "unit.toml"] if noise == "calibrated" else []))
    found = [read_json(out / "result.json")["model"],
             [[float(row["gravity_mgal"]) - truth[row["site"]], float(row["u_gravity_mgal"])]
              for row in rows(out / "stations.csv") if row["site"] not in known]]
    shutil.rmtree(folder)
    print(f"seed {seed}: {plan} done", flush=True)
    return found


line = command_line(__doc__, "design_bench.py 12001-12004 2 --keep results")
add_seeds(line, "12001-12040")
add_folder(line)
line.add_argument("plan", metavar="PLAN", nargs="?", default="", help=f"the first letters of a plan: {', '.join(PLANS)}; default: all")
line.add_argument("noise", metavar="NOISE", nargs="?", choices=("usual", "assumed", "calibrated"), default="usual",
                  help="usual: placement and flicker of 1.2 mGal and a unit within +-25 %%; assumed: unit and noise from the priors of a "
                       "day; calibrated: usual with the placement known to the day, from a calibration")
options = line.parse_args()
seeds, noise, failures = options.seeds, options.noise, []
with Scratch() as scratch, concurrent.futures.ThreadPoolExecutor(int(os.environ.get("A351_JOBS", os.cpu_count()))) as pool:
    store = options.keep or scratch
    print(f"{'mGal':20} expected       rms error  expected / error        rms of u  expected / u")
    for k, plan in ((k, plan) for k, plan in enumerate(PLANS) if plan.startswith(options.plan)):
        expected = expected_u(scratch, plan)
        results = list(pool.map(lambda seed, k=k, plan=plan: kept(store / f"{noise}-{seed}-{k}.json", lambda: look_at(scratch, seed, plan)), seeds))
        (error, of_error), (stated, of_stated) = (rms_by_day([row[place] for row in day] for _, day in results) for place in (0, 1))
        print(f"{plan:20} {expected:8.2f} {error:8.2f} +- {of_error:.2f} {expected / error:9.2f} +- {expected / error * of_error / error:.2f} "
              f"{stated:8.2f} +- {of_stated:.2f} {expected / stated:13.2f}", flush=True)
        if noise == "usual" and not PROMISED[0] <= expected / error <= PROMISED[1]:
            failures.append(f"{plan}: expected / error {expected / error:.2f}, promised {PROMISED[0]} to {PROMISED[1]}")
        if other := {model for model, _ in results} - {"day"}:
            failures.append(f"{plan}: other models than day: {', '.join(sorted(other))}")
end_with(failures)
