"""The temperature of an outer oven reaches the whole-day model and the long record of a simulated double oven."""

import shutil
import sys

from programs import BIN, Scratch, demand, read_json, rows, run

SLOPES = ("outer_level_mgal_per_degc", "outer_slow_mgal_per_degc", "outer_lag_s")
UNUSED = "the temperature of the outer oven is not used: it has a gap of more than 10 min"


def corrected(day, name):
    result = run(BIN / "a351-correct", "survey", day / "survey.toml", "--model", "day", "--out", day / name, env={"PATH": str(day)})
    json = read_json(day / name / "result.json")
    return {one["name"]: one for one in json["coefficients"]}, [one["name"] for one in json["inputs"]], result.stderr


def main():
    with Scratch() as scratch:
        day = scratch / "day"
        run(BIN / "a351-sim", "survey", "--scenario", "double-oven", "--seed", 5, "--out", day)
        found, inputs, said = corrected(day, "with")
        print("survey:", {name: found[name]["value"] for name in SLOPES})
        demand("the model has the outer oven's slopes and its lag", all(name in found for name in SLOPES) and UNUSED not in said)
        demand("LK4 is one of the inputs", any(".LK4.D." in file for file in inputs))

        run(BIN / "a351-correct", "record", day, "--out", day / "record", env={"PATH": str(day)})
        paths = read_json(day / "record" / "result.json")["two_paths"]["outer_oven"]
        print("record:", {name: (one["value"], one["standard_error"]) for name, one in paths.items()})
        demand("the long record has them too", set(paths) == set(SLOPES))
        table = rows(day / "record" / "record.csv")
        demand("record.csv has the temperature of the outer oven", all(abs(float(row["outer_degc"]) - 38.0) < 1.6 for row in table))

        for channel in day.glob("archive/*/*/*/LK4.D"):
            shutil.rmtree(channel)
        found, inputs, said = corrected(day, "without")
        demand("without its samples the model has neither, and says so", not any(name in found for name in SLOPES) and UNUSED in said)


if __name__ == "__main__":
    sys.exit(main())
