"""The pages on the corrector's tables describe every column and key that is written, and their formulas hold."""

import json
import re

from programs import BIN, TOP, Scratch, demand, rows, run

GOLDEN = TOP / "tests" / "golden" / "tsukuba"
PAGE, RECORD_PAGE = (TOP / "corrector" / name for name in ("result/table-format.md", "long_record/long_record.md"))
# Keys whose contents the pages do not list: options of the run, parts of a calibration and of a network.
ASIDE = {"settings", "calibration", "network"}
# Largest error of a formula, in mGal: five or more numbers are rounded to six decimals each.
ROUNDING_MGAL = 5e-6


def keys(value):
    """Returns all keys of an object and of the objects in it, except those in ASIDE."""
    if isinstance(value, list):
        return set().union(*map(keys, value)) if value else set()
    if not isinstance(value, dict):
        return set()
    return value.keys() | set().union(*(keys(part) for name, part in value.items() if name not in ASIDE))


def demand_named(title, written, page, heading=""):
    """Demands that a page names all these columns and keys, after a heading if one is given."""
    described = page.read_text().partition(heading)[2] if heading else page.read_text()
    lacking = sorted(written - set(re.findall(r"`([a-z0-9_]+)`", described)))
    demand(f"{title}: of {len(written)} columns and keys {page.name} describes all but {lacking or 'none'}", not lacking)


def columns(result, *tables):
    return set().union(*(rows(result / f"{table}.csv")[0].keys() for table in tables))


def check_names(title, result):
    written = keys(json.loads((result / "result.json").read_text()))
    demand_named(title, written | columns(result, "occupations", "stations", "models"), PAGE)


def check_formulas(title, result):
    """Tests the formulas as the page gives them; corrections are the columns whose names end in _correction_mgal."""
    occupations = [row for row in rows(result / "occupations.csv") if row["corrected_mgal"]]
    added = [column for column in occupations[0] if column.endswith("_correction_mgal")]
    worst = 0.0
    for row in occupations:
        value = {column: float(cell) for column, cell in row.items() if column.endswith("_mgal") and cell}
        without_tide = value["acceleration_mgal"] - value["tide_mgal"]
        reduced = without_tide + value.get("height_correction_mgal", 0.0) + value.get("pressure_correction_mgal", 0.0)
        worst = max(worst, abs(without_tide + sum(value.get(column, 0.0) for column in added) - value["corrected_mgal"]))
        if "reference_mgal" in value:
            worst = max(worst, abs(value["corrected_mgal"] - value["reference_mgal"] - value["residual_mgal"]),
                        abs(reduced - value["reference_mgal"] - value["difference_mgal"]))
    demand(f"{title}: {len(occupations)} rows, {len(added)} corrections: the formulas hold within {worst:.1e} mGal, "
           f"limit {ROUNDING_MGAL:g}",
           worst < ROUNDING_MGAL)


def check_json(title, result):
    """Tests that the rows of result.json have the values of the tables."""
    whole = json.loads((result / "result.json").read_text())
    for table in ("occupations", "stations", "models"):
        written = [row for row in rows(result / f"{table}.csv") if table != "occupations" or row["time_utc"]]
        demand(f"{title}: {table}: the {len(written)} rows of CSV and JSON are the same", len(written) == len(whole[table]) and all(
            cell == "" if value is None else cell == str(int(value)) if isinstance(value, bool)
            else abs(float(cell) - value) < 1e-6 if isinstance(value, float) else cell == str(value)
            for row, full in zip(written, whole[table]) for cell, value in ((row[key], full[key]) for key in full)))


with Scratch() as scratch:
    run(BIN / "a351-sim", "survey", "--scenario", "tsukuba", "--seed", 3, "--out", scratch / "day")
    for model in ("day", "t-rate-drift-axes", "paper"):
        run(BIN / "a351-correct", "survey", "survey.toml", "--model", model, "--out", model, cwd=scratch / "day")
    run(BIN / "a351-correct", "table", "--observations", GOLDEN / "observations.csv", "--sites", GOLDEN / "sites.csv",
        "--model", "network", "--out", scratch / "day" / "network")
    (scratch / "day" / "pressure.csv").write_text(
        "time,pressure_hpa\n" + "".join(f"2017-07-{day}T{hour:02}:00:00Z,{980 - hour}\n" for day in (15, 16) for hour in range(0, 24, 2)))
    reduced = (scratch / "day" / "survey.toml").read_text().replace(
        "[survey]\n", '[survey]\ninstrument_height_m = 0.25\npressure = "pressure.csv"\nbouguer_density_kg_per_m3 = 2670\n')
    (scratch / "day" / "reduced.toml").write_text(reduced)
    run(BIN / "a351-correct", "survey", "reduced.toml", "--model", "day", "--out", "reduced", cwd=scratch / "day")
    for model in ("day", "t-rate-drift-axes", "paper", "network", "reduced"):
        for check in (check_names, check_formulas, check_json):
            check(model, scratch / "day" / model)
    so_far = json.loads(run(BIN / "a351-correct", "survey", scratch / "day",
                             "--sites", scratch / "day" / "sites.csv", "--json").stdout)
    demand(f"the gravity so far has {len(so_far['stays'])} stays", so_far["stays"])
    demand_named("gravity so far", keys(so_far), PAGE, "## Gravity so far")
    run(BIN / "a351-correct", "record", scratch / "day", "--ensemble", 4, "--out", scratch / "record")
    written = json.loads((scratch / "record" / "result.json").read_text()).keys()
    demand_named("record", written | columns(scratch / "record", "record", "response"), RECORD_PAGE)
