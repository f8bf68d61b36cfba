"""`calibrate` from simulated nights, and `record --apply` on another night of the same unit.

The response must be true within its errors; further tests: the warm-up after power-on, merging, and refused input.
"""

import math
import re

from programs import BIN, Scratch, demand, read_json, refused, rows, run

CORRECT = BIN / "a351-correct"
# Temperature errors of the simulated unit; none has the value that the fit expects.
UNIT = {"crystal_static_mgal_per_degc": -15.0, "crystal_dynamic_mgal_per_degc": -850.0, "crystal_tau_s": 52.0,
        "clock_mgal_per_degc": -16.0, "clock_tau_s": 2200.0, "warm_up_mgal": 42.0, "warm_up_tau_h": 2.1}
NIGHT = 'base = "indoor"\nname = "unit"\n[temperature_error]\n' + "".join(f"{key} = {value}\n" for key, value in UNIT.items())
FROM_POWER_ON = NIGHT + """[schedule]
duration_h = 24.0
[sensor]
power_on_before_start_h = 0.25
[oven]
run_in_h = 0.25
"""
POWER_ON = "2017-06-01T08:45:00Z"


def calibrate(folder, *arguments):
    return run(CORRECT, "calibrate", *arguments, cwd=folder)


def numbers(text, table, key):
    part = text.split(f"[{table}]")[1].split(f"{key} = [")[1].split("]")[0]
    return [float(number) for number in part.replace(",", " ").split()]


def warm_up_h(text):
    return float(text.split("after_power_on_h = ")[1].split()[0])


with Scratch() as scratch:
    (scratch / "power-on.toml").write_text(FROM_POWER_ON)
    (scratch / "unit.toml").write_text(NIGHT)
    run(BIN / "a351-sim", "survey", "--scenario", scratch / "unit.toml", "--seed", 511, "--out", scratch / "night")
    run(BIN / "a351-sim", "survey", "--scenario", scratch / "power-on.toml", "--seed", 512, "--out", scratch / "first")

    found = calibrate(scratch, "night", "--out", "night.toml").stdout
    print(found)
    text = (scratch / "night.toml").read_text()
    values, covariance = numbers(text, "thermal", "values"), numbers(text, "thermal", "covariance")
    errors = [math.sqrt(covariance[6 * k]) for k in range(5)]
    demand("the calibration names the unit, its files and the start of its validity", 'serial_number = "00000001"' in text and
           'name = "station.xml"' in text and 'valid_from_utc = "2017-06-01T09:0' in text)
    lag_s, error_s = map(float, re.search(r"lag of the fast path: (\S+) \+- (\S+) s\n", found).groups())
    print(f"fast lag {lag_s} +- {error_s} s, true {UNIT['crystal_tau_s']}")
    demand("the fast lag is true within two standard errors, and the error is less than half of the prior's",
           abs(lag_s - UNIT["crystal_tau_s"]) < 2.0 * error_s < math.log(2.0) * lag_s)
    demand("the slow lag, which one night does not determine, has a large error", errors[4] > 10.0)
    demand("without --power-on the calibration has no warm-up", "[warm_up]" not in text)
    calibrate(scratch, "night", next((scratch / "night" / "archive").rglob("*BNZ.D.*")), "--out", "again.toml")
    demand("a day file given with its root counts as the same record, and a second run gives the same bytes",
           (scratch / "again.toml").read_text() == text)

    found = calibrate(scratch, "first", "--power-on", POWER_ON, "--within", "2", "--out", "first.toml").stdout
    print(found)
    first = (scratch / "first.toml").read_text()
    truth = UNIT["warm_up_tau_h"] * math.log(UNIT["warm_up_mgal"] / 2.0)
    print(f"within 2 mGal: {warm_up_h(first):.1f} h, true {truth:.1f} h")
    demand("the calibrated end of the warm-up is between the true hour and twice that",
           truth - 0.5 < warm_up_h(first) < 2.0 * truth)
    calibrate(scratch, "night", "--merge", "first.toml", "--out", "merged.toml")
    merged = (scratch / "merged.toml").read_text()
    demand("merging keeps the parts that were not measured again", warm_up_h(merged) == warm_up_h(first) and
           numbers(merged, "thermal", "values") == values)

    calibrate(scratch, "night", "--valid-from", "2017-05-01T00:00:00Z", "--valid-to", "2018-05-01T00:00:00Z", "--out",
              "valid.toml")
    valid = (scratch / "valid.toml").read_text()
    demand("the validity is that of the options", 'valid_from_utc = "2017-05-01T00:00:00.0' in valid and
           'valid_to_utc = "2018-05-01T00:00:00.0' in valid)
    (scratch / "another.toml").write_text(text.replace("00000001", "00000002"))
    (scratch / "later.toml").write_text(NIGHT + '[schedule]\nstart_utc = "2017-06-03T09:00:00Z"\nduration_h = 1.0\n')
    run(BIN / "a351-sim", "survey", "--scenario", scratch / "later.toml", "--seed", 513, "--out", scratch / "another")
    metadata = scratch / "another" / "metadata" / "station.xml"
    metadata.write_text(metadata.read_text().replace("00000001", "00000002"))

    # The same record without metadata.
    run(BIN / "a351-correct", "record", "night", "--ensemble", "2", "--out", "night-csv", cwd=scratch)
    for arguments, words in (
            (("night-csv/record.csv",), "serial number"),
            (("night", "--within", "1"), "switched on"),
            (("night", "--power-on", "2017-06-01T05:00:00Z", "--within", "1"), "switched on"),
            (("night", "--power-on", "today"), "--power-on"),
            (("night", "--valid-from", "2018-05-01T00:00:00Z", "--valid-to", "2018-05-01T00:00:00Z"), "--valid-to = "),
            (("night", "--merge", "another.toml"), "serial_number = 00000002: another unit"),
            (("night", "another"), "allowed: one unit"),
            ((), "no record and no series")):
        refused(words, CORRECT, "calibrate", *arguments, "--out", "bad", cwd=scratch)

    def apply(record, calibration, out):
        run(CORRECT, "record", record, "--apply", calibration, "--ensemble", "20", "--out", out, cwd=scratch)

    apply("first", "night.toml", "applied")
    applied = read_json(scratch / "applied" / "result.json")["applied"]
    cycle = next(band["rms_mgal"] for band in applied["bands"] if band["shortest_s"] == 600.0)
    print(applied["calibration"], cycle)
    demand("result.json says that the calibration is from other records",
           "measured from other records" in applied["calibration"])
    demand("the fast path from one night reduces the oven's cycle in another record by a fifth",
           cycle["parametric"] < 0.8 * cycle["before"])
    demand("Allan deviations reach up to a quarter of the record",
           applied["allan"][0]["averaging_s"] == 20.0 and applied["allan"][-1]["averaging_s"] > 10000.0)
    table = rows(scratch / "applied" / "record.csv")
    filled = [row for row in table if row["parametric_mgal"] and row["by_modes_mgal"]]
    demand("record.csv has both series for every sample of the segment",
           len(filled) == sum(row["segment"] == "1" for row in table) > 4000)
    page = (scratch / "applied" / "record.html").read_text()
    demand("the page shows both corrections", "With the calibration" in page and "Allan deviation before and after" in page)
    apply("night", "night.toml", "in-sample")
    demand("result.json says that a calibration is applied in sample",
           "in sample" in read_json(scratch / "in-sample" / "result.json")["applied"]["calibration"])
    (scratch / "other.toml").write_text(text.replace("00000001", "00000002"))
    refused("00000002", CORRECT, "record", "night", "--apply", "other.toml", "--out", "bad", cwd=scratch)
    demand("what is refused writes nothing", not (scratch / "bad").exists())
