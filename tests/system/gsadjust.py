"""GSadjust reads gsadjust.csv: its stations must be the occupations, with the same values, deviations, times and tides.

A351_GSADJUST is the folder of GSadjust's source that holds main.py (https://code.usgs.gov/sgp/gsadjust).  The reader needs
NumPy and Matplotlib, the stations need PyQt5.
"""

import importlib
import os
import pathlib
import sys
import types

from programs import BIN, TOP, Scratch, demand, instant, rows, run, skip

if "A351_GSADJUST" not in os.environ:
    skip("A351_GSADJUST is not set; set it to the source folder of GSadjust")
SOURCE = pathlib.Path(os.environ["A351_GSADJUST"])
GOLDEN = TOP / "tests" / "golden" / "tsukuba"


def gsadjust(module):
    """Imports a module of GSadjust without opening its windows."""
    for package in ("gsadjust", "gsadjust.obstree"):
        if package not in sys.modules:
            sys.modules[package] = types.ModuleType(package)
            sys.modules[package].__path__ = [str(SOURCE / package.replace(".", "/"))]
    try:
        return importlib.import_module(module)
    except ImportError as error:
        skip(f"GSadjust in {SOURCE} cannot be imported: {error}")


read, loop = gsadjust("gsadjust.file.read"), gsadjust("gsadjust.obstree.loop")


def stations(file):
    """Returns the stations that GSadjust's window would list: one for consecutive lines of the same name."""
    with open(file) as text:
        readings = read.file_reader("csv", text)
    tree = loop.ObsTreeLoop("day")
    tree.populate(readings)
    return [tree.child(i) for i in range(tree.rowCount())]


def number(row, column):
    return float(row.get(column) or 0)


def compare(title, result):
    """Compares GSadjust's stations with occupations.csv; its values are in microgal, its times in days since 1970."""
    ours = [row for row in rows(result / "occupations.csv") if row["used"] == "1"]
    theirs = stations(result / "gsadjust.csv")
    demand(f"{title}: GSadjust's {len(theirs)} stations are the {len(ours)} occupations",
           [(station.station_name, station.station_count) for station in theirs]
           == [(row["site"], row["occupation"]) for row in ours])
    worst = {"value": 0.0, "deviation": 0.0, "tide": 0.0, "time": 0.0}
    for row, station in zip(ours, theirs):
        value = number(row, "acceleration_mgal") - number(row, "tide_mgal") + sum(
            number(row, f"{term}_correction_mgal") for term in ("temperature", "rate", "tilt"))
        time = instant(row["time_utc"]).timestamp()
        for what, difference in (("value", station.gmean / 1e3 - value),
                                 ("deviation", station.stdev() / 1e3 - number(row, "u_corrected_mgal")),
                                 ("tide", station.etc[0] / 1e3 + number(row, "tide_mgal")),
                                 ("time", station.tmean * 86400 - time)):
            worst[what] = max(worst[what], abs(difference))
    print(f"{title}: largest differences: " + ", ".join(f"{what} {size:.2g}" for what, size in worst.items()))
    # Both files are rounded to 1e-6 mGal, GSadjust's times to seconds; a value is the sum of five rounded numbers.
    demand(f"{title}: GSadjust's values, deviations and tides agree within 4e-6 mGal, its times within a second",
           max(worst["value"], worst["deviation"], worst["tide"]) < 4e-6 and worst["time"] < 1.001)


with Scratch() as scratch:
    run(BIN / "a351-sim", "survey", "--scenario", "tsukuba", "--seed", 3, "--out", scratch / "day")
    run(BIN / "a351-correct", "survey", "survey.toml", "--out", "result", cwd=scratch / "day")
    compare("a simulated day", scratch / "day" / "result")
    run(BIN / "a351-correct", "table", "--observations", GOLDEN / "observations.csv", "--sites", GOLDEN / "sites.csv",
        "--out", scratch / "table")
    compare("the published day", scratch / "table")
