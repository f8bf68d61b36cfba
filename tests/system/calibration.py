"""Axis biases, scale and placement of a unit, measured on simulated series and used on a survey day of the same unit."""

import math
import re
import shutil
import tomllib

from programs import BIN, TOP, Scratch, demand, read_json, refused, rows, run

SEED = 4
CORRECT = BIN / "a351-correct"


def correct(*arguments, cwd=None):
    return run(CORRECT, *arguments, cwd=cwd)


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
    terms = ("tide", "bias", "static", "dynamic", "clock", "warm_up", "placement", "flicker", "resonant", "white", "drift", "ripple", "scale", "tilt")
    norms = {(float(row["about_y_deg"]), float(row["about_x_deg"])): sum(float(row[f"{term}_mgal"]) for term in terms)
             for row in rows(series / "truth.csv")}
    return [(norms[up] - norms[down]) / 2.0 for up, down in
            (((90.0, 0.0), (-90.0, 0.0)), ((0.0, -90.0), (0.0, 90.0)), ((0.0, 0.0), (0.0, 180.0)))]


def keys(value):
    """Returns all keys of a table and of the tables in it."""
    if isinstance(value, list):
        return set().union(*map(keys, value))
    return value.keys() | set().union(*map(keys, value.values())) if isinstance(value, dict) else set()


with Scratch() as scratch:
    for scenario in ("tilt-series", "placement", "tilted"):
        run(BIN / "a351-sim", "survey", "--scenario", scenario, "--seed", SEED, "--out", scratch / scenario)
    print(correct("calibrate", "--tilt", "tilt-series", "--out", "c.toml", cwd=scratch).stdout)
    text = (scratch / "c.toml").read_text()
    unit = tomllib.loads(text)
    page = (TOP / "protocol" / "unit" / "calibration-format.md").read_text()
    lacking = sorted(key for key in keys(unit) if f"`{key}`" not in page and f"`[{key}]`" not in page and f"`[[{key}]]`" not in page)
    demand(f"the file is TOML; of {len(keys(unit))} keys the format page lacks {lacking or 'none'}", not lacking)
    values, covariance = unit["axis_bias"]["values"], unit["axis_bias"]["covariance"]
    for k, (axis, truth) in enumerate(zip("xy", true_biases(scratch / "tilt-series"))):
        error = math.sqrt(covariance[3 * k])
        print(f"{axis}: {values[k]:.1f} +- {error:.1f} mGal/g, true {truth:.1f}")
        demand(f"the bias of {axis} is within three standard errors of the truth", abs(values[k] - truth) < 3.0 * error)
        demand(f"the standard error of the bias of {axis} is {error:.1f} mGal/g, below 40", error < 40.0)
    correct("calibrate", "--tilt", "tilt-series", "--out", "again.toml", cwd=scratch)
    demand("a second run gives the same bytes", (scratch / "again.toml").read_text() == text)

    (scratch / "ended.toml").write_text(text.replace("[axis_bias]", 'valid_to_utc = "2017-01-01T00:00:00Z"\n\n[axis_bias]', 1)
                                        .replace('valid_from_utc = "2017', 'valid_from_utc = "2016'))
    merge = ("calibrate", "--tilt", "tilt-series", "--merge", "ended.toml", "--out")
    # A validity that ended before the tilt series.
    refused("ended.toml: valid_to_utc", CORRECT, *merge, "no.toml", cwd=scratch)
    correct(*merge, "merged.toml", "--valid-to", "2030-01-01T00:00:00Z", cwd=scratch)

    merged = (scratch / "merged.toml").read_text()
    demand("a data file that both calibrations used is listed once", merged.count("[[data]]") == text.count("[[data]]") > 4)
    shutil.copytree(scratch / "tilt-series", scratch / "copy")
    for again in ("tilt-series", "copy"):
        refused("each reading once", CORRECT, "calibrate", "--tilt", "tilt-series", again, "--out", "no.toml", cwd=scratch)

    for bad in (("calibrate", "--tilt", "tilt-series", "--out", "tilt-series/"),
                ("calibrate", "--tilt", "tilt-series", "--out", "c.toml/c.toml"),
                ("record", "tilt-series", "--out", "c.toml")):
        refused(f"--out = {bad[-1]}", CORRECT, *bad, cwd=scratch)

    survey = ("survey", "tilted/survey.toml", "--out", "result", "--calibration")
    correct(*survey, "c.toml", cwd=scratch)
    result = read_json(scratch / "result" / "result.json")
    demand("the result names the calibration", result["settings"]["calibration"] == "c.toml" and
           result["calibration"]["serial_number"] == "00000001" and
           any(file["role"] == "calibration" for file in result["inputs"]))
    demand("the biases were used as a prior and the readings do not contradict them",
           result["calibration"]["axis_bias"]["use"] == "prior" and
           not result["calibration"]["axis_bias"]["contradicted"] and result["calibration"]["thermal"] is None)
    report = (scratch / "result" / "report.html").read_text()
    demand("the report names the calibration", "calibration of unit 00000001" in report)
    demand("the report mentions no contradiction", "contradict" not in report)
    warnings = " ".join(result["settings"]["warnings"])
    demand("a day after the start of the validity gives no warning", "validity of the calibration" not in warnings)

    (scratch / "turned.toml").write_text(text.replace("values = [", "values = [-").replace("[--", "["))
    correct(*survey, "turned.toml", cwd=scratch)
    demand("biases with the wrong sign are reported as contradicted",
           "s axis biases: chi-square" in (scratch / "result" / "report.html").read_text())
    (scratch / "late.toml").write_text(text.replace("valid_from_utc = \"2017", "valid_from_utc = \"2018"))
    demand("a day before the validity gives a warning",
           "validity of the calibration" in correct(*survey, "late.toml", cwd=scratch).stderr)

    print(correct("calibrate", "--placement", "placement", "--merge", "c.toml", "--out", "both.toml", cwd=scratch).stdout)
    both = tomllib.loads((scratch / "both.toml").read_text())
    placement = both["placement"]
    lacking = sorted(key for key in keys(placement) if f"`{key}`" not in page)
    demand(f"the format page names all keys of the placement but {lacking or 'none'}", not lacking)
    low, high = placement["limits_mgal"]
    print(f"placement {placement['standard_deviation_mgal']:.2f} mGal, 95 % limits {low:.2f} to {high:.2f}, true 1.2")
    demand("the true placement is within the limits, which are at most a factor of 4 apart", low < 1.2 < high < 4.0 * low)
    demand("the biases are merged", both["axis_bias"]["values"] == unit["axis_bias"]["values"])
    correct(*survey, "both.toml", cwd=scratch)
    demand("the placement is a prior of the survey",
           read_json(scratch / "result" / "result.json")["calibration"]["placement"]["use"] == "prior")
    for series in ("--placement", "--tilt"):
        refused("one point", CORRECT, "calibrate", series, "tilted/survey.toml", "--out", "no.toml", cwd=scratch)

    run(BIN / "a351-sim", "survey", "--scenario", "tumble", "--seed", SEED, "--out", scratch / "tumble")
    print(found := correct("calibrate", "--tumble", "tumble", "--out", "tumble.toml", cwd=scratch).stdout)
    for axis, truth in zip("xyz", true_tumble(scratch / "tumble")):
        value, error = map(float, re.search(rf"^  {axis}: .*; bias (\S+) \+- (\S+) mGal,", found, re.M).groups())
        demand(f"the bias of {axis} is {value} +- {error} mGal, within three standard errors of the true {truth:.1f}", abs(value - truth) < 3.0 * error < 20.0)
    scale = tomllib.loads((scratch / "tumble.toml").read_text())["scale"]
    demand(f"the scale is {scale['value']:.7f} +- {scale['standard_error']:.7f}, true 1",
           abs(scale["value"] - 1.0) < 3.0 * scale["standard_error"] < 3e-5)
    correct("calibrate", "--placement", "placement", "--merge", "tumble.toml", "--out", "with-scale.toml", cwd=scratch)
    demand("the scale is merged", tomllib.loads((scratch / "with-scale.toml").read_text())["scale"] == scale)
    better = tomllib.loads((scratch / "tumble.toml").read_text())["axis_bias"]
    demand("the biases of the tumble are more certain than those of the tilt series",
           better["covariance"][0] + better["covariance"][3] < covariance[0] + covariance[3])
    for way in (("--tilt", "tilt-series", "--tumble", "tumble"), ("--tumble", "tumble", "--merge", "c.toml"),
                ("--tilt", "tilt-series", "--merge", "tumble.toml")):
        said = correct("calibrate", *way, "--out", "best.toml", cwd=scratch)
        demand(f"with {' '.join(way)} they are written, and the program says so",
               tomllib.loads((scratch / "best.toml").read_text())["axis_bias"] == better and
               "horizontal axes, written from tumble" in said.stdout)
    shutil.copytree(scratch / "tumble", scratch / "rough")
    sites = rows(scratch / "rough" / "sites.csv")
    names = [name for name in sites[0] if name != "u_gravity_mgal"]
    (scratch / "rough" / "sites.csv").write_text("".join(",".join(line) + "\n" for line in [names, *([site[name] for name in names] for site in sites)]))
    said = correct("calibrate", "--tumble", "rough", "--out", "rough.toml", cwd=scratch)
    print(said.stderr.strip())
    demand("a gravity without uncertainty gives a warning of one line", said.stderr.count("\n") == 1 and "lacks that of gravity" in said.stderr)
    (scratch / "turned-axis.toml").write_text(text.replace("values = [", "values = [-").replace("[--", "["))
    said = correct("calibrate", "--tumble", "tumble", "--merge", "turned-axis.toml", "--out", "best.toml", cwd=scratch).stderr
    demand(f"contradicting biases are named: {said.strip()}", "the axis biases of turned-axis.toml are" in said)
    refused("is no calibration file", CORRECT, "calibrate", "--tumble", "tumble", "--out", "tumble/sites.csv", cwd=scratch)
    refused("--power-on: has no effect", CORRECT, "calibrate", "--tilt", "tilt-series", "--power-on", "2017-06-02T00:00:00Z", "--out", "no.toml", cwd=scratch)
    table = (scratch / "tumble" / "sites.csv").read_text()
    (scratch / "tumble" / "sites.csv").write_text(table.replace("979763", "983200"))
    said = correct("calibrate", "--tumble", "tumble", "--out", "wrong.toml", cwd=scratch)
    print(said.stderr.strip())
    demand("a gravity that does not fit its place gives a warning", "normal gravity" in said.stderr and "979763" in table)
    refused("no position with x up", CORRECT, "calibrate", "--tumble", "tilt-series", "--out", "no.toml", cwd=scratch)

    (scratch / "other.toml").write_text(text.replace("00000001", "00000002"))
    refused("unit 00000002", CORRECT, "survey", "tilted/survey.toml", "--out", "no.toml", "--calibration", "other.toml", cwd=scratch)
    demand("what is refused writes nothing", not (scratch / "no.toml").exists())
