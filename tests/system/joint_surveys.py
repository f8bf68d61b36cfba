"""Adjusts a box of two sensors and another day of one of them together: the order of the surveys has no effect on the bytes, the joint
values agree with the truth."""

import json

from programs import BIN, TOP, Scratch, correct_survey, demand, rows, run, write_sites

KNOWN = {"No.0", "No.7", "No.12"}


def simulate(folder, name, seed, serial, more="", text=None):
    scenario = folder / f"{name}.toml"
    scenario.write_text(text or f'base = "tsukuba"\nname = "{name}"\n{more}')
    run(BIN / "a351-sim", "survey", "--scenario", scenario, "--seed", seed, "--serial", serial, "--out", folder / name)
    table = rows(folder / name / "sites.csv")
    write_sites(folder / name / "known.csv", table, {row["site"]: row["gravity_mgal"] for row in table if row["site"] in KNOWN})
    survey = folder / name / "survey.toml"
    survey.write_text(survey.read_text().replace('"sites.csv"', '"known.csv"'))
    return survey


def joined(folder, name, *surveys):
    correct_survey(surveys[0], folder / name, *surveys[1:], "--model", "day")
    return {file: (folder / name / file).read_bytes()
            for file in ("joint.csv", "joint-differences.csv", "joint.json", "joint.html", "history.csv", "terms.csv")}


with Scratch() as scratch:
    box = "[box]\nseed = 4001\nplacement_share = 1.0\n"
    first = simulate(scratch, "first", 4002, "00000011", box)
    second = simulate(scratch, "second", 4003, "00000012", box)
    starts = [[row["start_utc"] for row in rows(survey.parent / "schedule.csv")] for survey in (first, second)]
    demand("the sensors of a box have the same stays", starts[0] == starts[1])
    # The same course a month later, of the first sensor alone.
    text = (TOP / "config" / "scenarios" / "tsukuba.toml").read_text()
    third = simulate(scratch, "third", 4005, "00000011", text=text.replace('name = "tsukuba"', 'name = "third"').replace("2017-07-", "2017-08-"))

    one = joined(scratch, "one", first, second, third)
    other = joined(scratch, "other", third, second, first)
    demand("the order of three surveys has no effect on the joint files", one == other)
    joint = json.loads(one["joint.json"])
    demand(f"method {joint['method']}, {len(joint['units'])} units, {len(joint['surveys'])} surveys",
           joint["method"] == "adjustment" and len(joint["units"]) == 2 and len(joint["surveys"]) == 3)
    low, high = joint["placement_share"]["limits_95"]
    demand(f"the common share of the placement, 1, is within {low:.2f} to {high:.2f}", low > 0.3 and high == 1.0)
    truth = {row["site"]: float(row["gravity_mgal"]) for row in rows(first.parent / "sites.csv")}
    ratios = [abs(row["gravity_mgal"] - truth[row["site"]]) / row["u_gravity_mgal"] for row in joint["stations"]]
    demand(f"errors are up to {max(ratios):.1f} times u", max(ratios) < 4.0)
    alone = {row["site"]: float(row["u_gravity_mgal"]) for row in rows(scratch / "one" / "first-4002" / "stations.csv")}
    worse = [row["site"] for row in joint["stations"] if row["site"] not in KNOWN and row["u_gravity_mgal"] > alone[row["site"]]]
    demand(f"stations with a larger u than on one day: {worse or 'none'}", not worse)

    demand("the page has the terms of the units", b">The units</h2>" in one["joint.html"])
    history = rows(scratch / "one" / "history.csv")
    demand(f"the history has {[(row['serial_number'], row['name']) for row in history]}",
           [(row["serial_number"], row["name"][:5]) for row in history] == [("00000011", "first"), ("00000011", "third"), ("00000012", "secon")])
    for row in history:
        alone = json.loads((scratch / "one" / row["name"] / "result.json").read_text())
        terms = {term["name"]: term["value"] for term in alone["coefficients"]}
        demand(f"{row['name']}: the history has the terms of the day alone, constant {terms['constant_mgal']:.1f} mGal",
               all(abs(float(row[name]) - terms[name]) < 1e-6 for name in ("constant_mgal", "slow_lag_s", "placement_mgal"))
               and row["start_utc"] == min(stay["start_utc"] for stay in alone["occupations"]))
    demand("the terms of the first unit are of two days",
           [row["days"] for row in rows(scratch / "one" / "terms.csv") if row["term"] == "constant_mgal"] == ["2", "1"])
