"""Simulated days of units whose thermal parameters are drawn, and calibrations measured on their records."""

import json
import math
import pathlib
import random
import shutil
import statistics
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "system"))
from programs import BIN, TOOLS, correct_survey, read_json, rms, rows, run, write_sites  # noqa: F401  TOOLS is for those that import this module.

UNIT = {"crystal_static_mgal_per_degc": -12.0, "crystal_dynamic_mgal_per_degc": -950.0, "crystal_tau_s": 43.0,
        "clock_mgal_per_degc": -20.0, "clock_tau_s": 2700.0, "warm_up_mgal": 36.0, "warm_up_tau_h": 2.5}
TWO_DAYS = "[schedule]\nduration_h = 48.0\n"
VALID_FROM = "2017-01-01T00:00:00Z"


def unit_of(seed, scatter):
    """Returns the thermal parameters of a seed's unit: those of the scenarios, each within +- scatter of its value."""
    draw = random.Random(seed)
    return {key: value * draw.uniform(1.0 - scatter, 1.0 + scatter) for key, value in UNIT.items()}


def assumed(place, count):
    """Returns the thermal parameters and the rest of the scenario of the day at a place among `count` days that together are the priors
    of the whole-day model (corrector/methods.md): each quantity in even steps of its distribution, in an order of its own."""
    draw = random.Random(count)

    def normal(mean, deviation):
        share = (draw.sample(range(count), count)[place] + 0.5) / count
        return mean + deviation * statistics.NormalDist().inv_cdf(share)

    def within(median, factor):
        return median * factor ** normal(0.0, 1.0)

    fast_lag_s = within(43.0, 1.5)
    unit = {"crystal_static_mgal_per_degc": normal(-12.0, 7.2), "crystal_dynamic_mgal_per_degc": -3600.0 * normal(11.3, 6.8) / fast_lag_s,
            "crystal_tau_s": fast_lag_s, "clock_mgal_per_degc": normal(-20.0, 12.0), "clock_tau_s": within(2700.0, 1.5),
            "warm_up_mgal": normal(0.0, 36.0), "warm_up_tau_h": UNIT["warm_up_tau_h"]}
    # The emulator draws a horizontal bias evenly within +- its maximum.
    return unit, (f"[sensor]\nhorizontal_bias_max_mgal = {within(300.0, 3.0) * 3.0 ** 0.5}\nscale = {normal(1.0, 0.002)}\n"
                  f"[slow_noise]\nplacement_mgal = {within(1.2, 2.0)}\nflicker_mgal = {within(1.2, 2.0)}\n"
                  f"drift_linear_mgal_per_h = {normal(0.0, 1.0)}\n")


def simulate(folder, name, base, seed, scatter, more="", serial="00000001"):
    """Simulates a day of the seed's unit and returns its folder."""
    return simulate_unit(folder, name, base, seed, unit_of(seed, scatter), more, serial)


def simulate_unit(folder, name, base, seed, unit, more="", serial="00000001"):
    """Simulates a day of a unit with these thermal parameters and returns its folder."""
    file = folder / f"{name}-scenario.toml"
    error = "".join(f"{key} = {value}\n" for key, value in unit.items())
    file.write_text(f'base = "{base}"\nname = "{name}"\n[temperature_error]\n{error}{more}')
    run(BIN / "a351-sim", "survey", "--scenario", file, "--seed", seed, "--serial", serial, "--out", folder / name)
    return folder / name


def measure(folder, name, base, seed, scatter, more=""):
    """Calibrates the seed's unit from a long record; returns the option that uses the file, empty if it was refused."""
    record = simulate(folder, name, base, seed, scatter, more)
    file = folder / f"{name}.toml"
    run(BIN / "a351-correct", "calibrate", record, "--out", file, "--valid-from", VALID_FROM, check=False)
    shutil.rmtree(record)
    return ["--calibration", file] if file.exists() else []


def correct(folder, survey, name, *options):
    """Corrects a day and returns the folder of the results."""
    correct_survey(survey, folder / name, *options)
    return folder / name


def hide_references(day, known, name):
    """Writes a survey file of the day in which only the sites `known` have gravity.

    @return  the file, and the true gravity by site
    """
    sites = rows(day / "sites.csv")
    write_sites(day / f"{name}.csv", sites, {row["site"]: row["gravity_mgal"] for row in sites if row["site"] in known})
    survey = day / f"{name}.toml"
    text = (day / "survey.toml").read_text()
    assert '"sites.csv"' in text
    survey.write_text(text.replace('"sites.csv"', f'"{name}.csv"'))
    return survey, {row["site"]: float(row["gravity_mgal"]) for row in sites}


def add_folder(line):
    """Adds the option --keep, the folder where kept() finds results."""
    line.add_argument("--keep", metavar="FOLDER", type=pathlib.Path,
                      help="keeps the results of each seed; those found there are not computed again")


def kept(file, compute):
    """Returns what compute() returns, computed now or read from the file of an earlier run."""
    if not file.exists():
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(json.dumps(compute()))
    return read_json(file)


def rms_by_day(days):
    """Returns the root mean square of the values of all days, and its standard error from days left out in turn (jackknife)."""
    days = [list(day) for day in days if day]
    every = rms(value for day in days for value in day)
    without = [rms(value for other in days if other is not day for value in other) for day in days] if len(days) > 1 else []
    return every, math.sqrt((len(days) - 1) * statistics.pvariance(without)) if without else math.nan
