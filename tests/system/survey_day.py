"""A simulated survey day through emulator, pty, daemon, archive and corrector, against the truth."""

import sys

from programs import IS_SANITIZED, TOP, Scratch, compare_truth, demand, read_json, rows, run

scenario = sys.argv[1]
# Sanitized programs run several times slower; at 1000x they would fall behind for hours of the day.
speed = "150" if IS_SANITIZED else "1000"

with Scratch() as scratch:
    out = scratch / "day"
    demo = run(TOP / "sim" / "demo", scenario, "--seed", "7", "--speed", speed, "--out", out)
    print(demo.stdout)
    demand("the demo prints its own day's RMS of Error_1",
           "RMS of Error (1), before the drift step: " in demo.stdout)
    demand("the demo prints the table beside the truth", "Beside the simulated truth" in demo.stdout)

    truth = {(row["site"], row["occupation"]): row for row in rows(out / "truth.csv")}
    table = rows(out / "result" / "occupations.csv")
    demand("all 19 occupations are in the table", len(table) == 19 and len(truth) == 19)
    if scenario == "ideal":
        errors = [abs(float(row["corrected_mgal"])
                      - float(truth[row["site"], row["occupation"]]["gravity_mgal"]))
                  for row in table]
        demand(f"every corrected value within 0.01 mGal of truth (largest {max(errors):.4f})",
               max(errors) <= 0.01)

    channels = compare_truth(out / "data" / "archive", out / "truth.bin")
    demand("four channels are archived", len(channels) == 4)
    for name, counted in channels.items():
        demand(f"{name}: 0 of {counted['truth']:.0f} samples missing, altered or duplicated",
               counted["missing"] == counted["altered"] == counted["duplicated"] == 0
               and counted["matched"] == counted["truth"] > 0)
        demand(f"{name}: no record boundary steps by more than half a sample", counted["steps"] == 0)

    report = read_json(out / "report.json")
    print("emulator:", report)
    if not IS_SANITIZED:
        ratio = report["mean_rate_real_hz"] / (50.0 * float(speed))
        demand(f"mean rate at {speed}x is {100 * ratio:.2f} % of nominal (>= 95)", ratio >= 0.95)
