"""A day without noise and temperature effects: every corrected value must be the simulated gravity."""

from programs import BIN, Scratch, demand, rows, run

with Scratch() as scratch:
    day = scratch / "day"
    run(BIN / "a351-sim", "survey", "--scenario", "ideal", "--seed", 7, "--out", day)
    run(BIN / "a351-correct", "survey", day / "survey.toml", "--out", day / "result")
    truth = {(row["site"], row["occupation"]): float(row["gravity_mgal"]) for row in rows(day / "truth.csv")}
    table = rows(day / "result" / "occupations.csv")
    demand(f"all {len(truth)} occupations are in the table", len(table) == len(truth) == 19)
    errors = [abs(float(row["corrected_mgal"]) - truth[row["site"], row["occupation"]]) for row in table]
    demand(f"largest error of a corrected value {max(errors):.4f} mGal, limit 0.01", max(errors) <= 0.01)
