"""GSadjust reads gsadjust.csv: its stations are our occupations, with their values, deviations, times and tides.

A351_GSADJUST names the folder of its source that holds main.py (https://code.usgs.gov/sgp/gsadjust); its reader needs
NumPy and Matplotlib, its stations PyQt5.
"""

import datetime
import importlib
import os
import pathlib
import sys
import types

from programs import BIN, TOP, Scratch, demand, rows, run, skip

if "A351_GSADJUST" not in os.environ:
    skip("A351_GSADJUST names no source of GSadjust")
SOURCE = pathlib.Path(os.environ["A351_GSADJUST"])
GOLDEN = TOP / "tests" / "golden" / "tsukuba"


def gsadjust(module):
    """Of its package, whose windows are not opened."""
    for package in ("gsadjust", "gsadjust.obstree"):
        if package not in sys.modules:
            sys.modules[package] = types.ModuleType(package)
            sys.modules[package].__path__ = [str(SOURCE / package.replace(".", "/"))]
    try:
        return importlib.import_module(module)
    except ImportError as error:
        skip(f"GSadjust of {SOURCE}: {error}")


read, loop = gsadjust("gsadjust.file.read"), gsadjust("gsadjust.obstree.loop")


def stations(file):
    """What its window would list: one for each run of lines of one name."""
    with open(file) as text:
        readings = read.file_reader("csv", text)
    tree = loop.ObsTreeLoop("day")
    tree.populate(readings)
    return [tree.child(i) for i in range(tree.rowCount())]


def number(row, column):
    return float(row.get(column) or 0)


def compare(title, result):
    """Its figures are in microgal, its times in days since 1970."""
    ours = [row for row in rows(result / "occupations.csv") if row["used"] == "1"]
    theirs = stations(result / "gsadjust.csv")
    demand(f"{title}: its {len(theirs)} stations are the {len(ours)} occupations",
           [(station.station_name, station.station_count) for station in theirs]
           == [(row["site"], row["occupation"]) for row in ours])
    worst = {"value": 0.0, "deviation": 0.0, "tide": 0.0, "time": 0.0}
    for row, station in zip(ours, theirs):
        value = number(row, "acceleration_mgal") - number(row, "tide_mgal") + sum(
            number(row, f"{term}_correction_mgal") for term in ("temperature", "rate", "tilt"))
        time = datetime.datetime.fromisoformat(row["time_utc"].replace("Z", "+00:00")).timestamp()
        for what, difference in (("value", station.gmean / 1e3 - value),
                                 ("deviation", station.stdev() / 1e3 - number(row, "u_corrected_mgal")),
                                 ("tide", station.etc[0] / 1e3 + number(row, "tide_mgal")),
                                 ("time", station.tmean * 86400 - time)):
            worst[what] = max(worst[what], abs(difference))
    print(f"{title}: largest differences: " + ", ".join(f"{what} {size:.2g}" for what, size in worst.items()))
    # Both files have 1e-6 mGal and GSadjust has whole seconds; the value is the sum of five rounded numbers.
    demand(f"{title}: its values, deviations and tides are ours within 4e-6 mGal, its times within a second",
           max(worst["value"], worst["deviation"], worst["tide"]) < 4e-6 and worst["time"] < 1.001)


with Scratch() as scratch:
    run(BIN / "a351-sim", "survey", "--scenario", "tsukuba", "--seed", 3, "--out", scratch / "day")
    run(BIN / "a351-correct", "survey", "survey.toml", "--out", "result", cwd=scratch / "day")
    compare("a simulated day", scratch / "day" / "result")
    run(BIN / "a351-correct", "table", "--observations", GOLDEN / "observations.csv", "--sites", GOLDEN / "sites.csv",
        "--out", scratch / "table")
    compare("the published day", scratch / "table")
