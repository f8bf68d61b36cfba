"""Axis biases, scale and placement of a unit, measured on simulated series and used on a survey day of the same unit.

tests/unit/series and calibration_use_test.cpp have what is refused and what is contradicted.
"""

import math
import re
import tomllib

from programs import BIN, TOP, Scratch, demand, read_json, rows, run

SEED = 4
TERMS = ("tide", "bias", "static", "dynamic", "clock", "warm_up", "placement", "flicker", "resonant", "white", "drift",
         "ripple", "scale", "tilt")


def correct(*arguments, check=True, cwd=None):
    return run(BIN / "a351-correct", *arguments, check=check, cwd=cwd)


def refused(scratch, words, *arguments):
    """Demands that arguments that end in --out FILE are refused in one line with these words; nothing is written."""
    result = correct(*arguments, check=False, cwd=scratch)
    demand(f"refused: {result.stderr.strip()}", result.returncode == 2 and words in result.stderr
           and result.stderr.count("\n") == 1
           and not (scratch / arguments[-1]).exists())


def true_biases(series):
    """Returns the biases of x and y in mGal/g, computed from the effect of tilts by 2 degrees in truth.csv.

    The effect is the bias times the sine of the angle, so it changes sign with the tilt.
    """
    sine = math.sin(math.radians(2.0))
    odd = {"x": 0.0, "y": 0.0}
    for row in rows(series / "truth.csv"):
        tilt_mgal = float(row["tilt_mgal"])
        odd["x"] += tilt_mgal * float(row["about_y_deg"]) / 8.0
        odd["y"] -= tilt_mgal * float(row["about_x_deg"]) / 8.0
    return [odd["x"] / sine, odd["y"] / sine]


def true_tumble(series):
    """Returns the biases of x, y and z in mGal: half the difference of the norms up and down in truth.csv."""
    norms = {(float(row["about_y_deg"]), float(row["about_x_deg"])): sum(float(row[f"{term}_mgal"]) for term in TERMS)
             for row in rows(series / "truth.csv")}
    return [(norms[up] - norms[down]) / 2.0 for up, down in
            (((90.0, 0.0), (-90.0, 0.0)), ((0.0, -90.0), (0.0, 90.0)), ((0.0, 0.0), (0.0, 180.0)))]


def keys(value):
    """Returns all keys of a table and of the tables in it."""
    if isinstance(value, list):
        return set().union(*map(keys, value))
    return value.keys() | set().union(*map(keys, value.values())) if isinstance(value, dict) else set()


def demand_described(unit):
    page = (TOP / "protocol" / "unit" / "calibration-format.md").read_text()
    lacking = sorted(key for key in keys(unit) if not re.search(rf"`\[*{re.escape(key)}\]*`", page))
    demand(f"of {len(keys(unit))} keys the format page lacks {lacking or 'none'}", not lacking)


with Scratch() as scratch:
    for scenario in ("tilt-series", "placement", "tilted", "tumble"):
        run(BIN / "a351-sim", "survey", "--scenario", scenario, "--seed", SEED, "--out", scratch / scenario)

    def calibrated(name, *arguments):
        correct("calibrate", *arguments, "--out", name, cwd=scratch)
        return tomllib.loads((scratch / name).read_text())

    unit = calibrated("c.toml", "--tilt", "tilt-series")
    values, covariance = unit["axis_bias"]["values"], unit["axis_bias"]["covariance"]
    for k, (axis, truth) in enumerate(zip("xy", true_biases(scratch / "tilt-series"))):
        error = math.sqrt(covariance[3 * k])
        demand(f"the bias of {axis} is {values[k]:.1f} +- {error:.1f} mGal/g, true {truth:.1f} within three errors",
               abs(values[k] - truth) < 3.0 * error < 120.0)
    text = (scratch / "c.toml").read_text()
    (scratch / "ended.toml").write_text(text.replace("[axis_bias]", 'valid_to_utc = "2017-01-01T00:00:00Z"\n\n[axis_bias]', 1)
                                        .replace('valid_from_utc = "2017', 'valid_from_utc = "2016'))
    refused(scratch, "ended.toml: valid_to_utc", "calibrate", "--tilt", "tilt-series", "--merge", "ended.toml", "--out",
            "no.toml")
    refused(scratch, "each reading once", "calibrate", "--tilt", "tilt-series", "tilt-series", "--out", "no.toml")
    refused(scratch, "one point", "calibrate", "--tilt", "tilted/survey.toml", "--out", "no.toml")
    refused(scratch, "--out = c.toml/c.toml", "calibrate", "--tilt", "tilt-series", "--out", "c.toml/c.toml")

    both = calibrated("both.toml", "--placement", "placement", "--merge", "c.toml")
    demand_described(both)
    low, high = both["placement"]["limits_mgal"]
    demand(f"the true placement, 1.2 mGal, is within {low:.2f} to {high:.2f}, which are at most a factor of 4 apart",
           low < 1.2 < high < 4.0 * low)
    demand("the biases are merged", both["axis_bias"]["values"] == values)
    survey = ("survey", "tilted/survey.toml", "--calibration", "both.toml", "--out", "result")
    correct(*survey, cwd=scratch)
    result = read_json(scratch / "result" / "result.json")
    used = result["calibration"]
    demand("the result names the calibration", result["settings"]["calibration"] == "both.toml"
           and used["serial_number"] == "00000001"
           and any(file["role"] == "calibration" for file in result["inputs"]))
    demand("biases and placement were used as priors and the readings do not contradict them",
           used["placement"]["use"] == "prior"
           and used["axis_bias"]["use"] == "prior" and not used["axis_bias"]["contradicted"]
           and used["thermal"] is None)
    report = (scratch / "result" / "report.html").read_text()
    demand("the report names the calibration and no contradiction", "calibration of unit 00000001" in report
           and "contradict" not in report)
    (scratch / "other.toml").write_text(text.replace("00000001", "00000002"))
    refused(scratch, "unit 00000002", "survey", "tilted/survey.toml", "--calibration", "other.toml", "--out", "other")

    print(found := correct("calibrate", "--tumble", "tumble", "--out", "tumble.toml", cwd=scratch).stdout)
    for axis, truth in zip("xyz", true_tumble(scratch / "tumble")):
        value, error = map(float, re.search(rf"^  {axis}: .*; bias (\S+) \+- (\S+) mGal,", found, re.M).groups())
        demand(f"the bias of {axis} is {value} +- {error} mGal, within three standard errors of the true {truth:.1f}",
               abs(value - truth) < 3.0 * error < 20.0)
    tumble = tomllib.loads((scratch / "tumble.toml").read_text())
    demand_described(tumble)
    scale, better = tumble["scale"], tumble["axis_bias"]
    demand(f"the scale is {scale['value']:.7f} +- {scale['standard_error']:.7f}, true 1",
           abs(scale["value"] - 1.0) < 3.0 * scale["standard_error"] < 3e-5)
    demand("the biases of the tumble are more certain than those of the tilt series",
           better["covariance"][0] + better["covariance"][3] < covariance[0] + covariance[3])
    best = calibrated("best.toml", "--tilt", "tilt-series", "--tumble", "tumble", "--merge", "both.toml")
    demand("with all series the scale is merged and the biases are those of the tumble", best["scale"] == scale
           and best["axis_bias"] == better)
    table = (scratch / "tumble" / "sites.csv").read_text()
    (scratch / "tumble" / "sites.csv").write_text(table.replace("979763", "983200"))
    said = correct("calibrate", "--tumble", "tumble", "--out", "wrong.toml", cwd=scratch)
    demand(f"a gravity that does not fit its place gives a warning: {said.stderr.strip()}",
           "normal gravity" in said.stderr and "979763" in table)
