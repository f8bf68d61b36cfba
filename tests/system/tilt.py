"""The tilt of a horizontal axis as a quantity of `record` and `export`: an emulated history of levelling comes back, and both programs
give the angle that follows from the three axes; bad input is refused.
"""

import math

from programs import BIN, Scratch, demand, read_json, refused, rows, run

ANGLES_DEG = [0.0, 0.01, -0.005]  # about y: x rises by sin
HISTORY = f"""base = "indoor"
name = "tilt-history"
[schedule]
lead_in_h = 6.0
lead_out_min = 330.0
jitter_s = 0.0
[sensor]
levelling_sigma_deg = 0.0
[[site]]
name = "pile"
longitude_deg = 139.7
latitude_deg = 35.7
altitude_m = 30.0
gravity_mgal = 979763.0
[[occupation]]
site = "pile"
number = 1
centre_utc = "2017-06-02T01:00:00Z"
length_s = {3.2 * 3600 * len(ANGLES_DEG)}
ambient_degc = 26.0
about_y_deg = {ANGLES_DEG}
about_x_deg = {[0.0] * len(ANGLES_DEG)}
"""
FROM, TO = "2017-06-02T00:00:00Z", "2017-06-02T00:10:00Z"


def exporting(folder, channel, form, *more):
    return (BIN / "a351-correct", "export", folder / "pile", "--from", FROM, "--to", TO, "--channel", channel, "--rate", 1,
            "--format", form, *more, "--out", folder / f"{channel}.csv")


def exported(folder, channel, *more):
    run(*exporting(folder, channel, "csv", *more))
    return rows(folder / f"{channel}.csv")


def recording(folder, *arguments):
    return BIN / "a351-correct", "record", folder / "pile", *arguments, "--out", folder / "out"


with Scratch() as scratch:
    (scratch / "history.toml").write_text(HISTORY)
    run(BIN / "a351-sim", "survey", "--scenario", scratch / "history.toml", "--seed", 4, "--out", scratch / "pile")
    text = run(*recording(scratch, "--quantity", "tilt-x", "--figure-width", "84mm")).stdout
    print(text, end="")
    table = rows(scratch / "out" / "record.csv")
    tilt = read_json(scratch / "out" / "result.json")["tilt"]
    truth = rows(scratch / "pile" / "truth.csv")
    means = []
    for set_up in truth:
        parts = [float(row["corrected_urad"]) for row in table
                 if set_up["start_utc"] < row["time_utc"] < set_up["end_utc"] and row["corrected_urad"]]
        means.append(sum(parts) / len(parts))
    wanted = [1e6 * math.radians(float(row["about_y_deg"])) for row in truth]
    errors = [(mean - means[0]) - (angle - wanted[0]) for mean, angle in zip(means, wanted)]
    demand(f"changes of the tilt differ from the emulated ones by {', '.join(f'{error:+.2f}' for error in errors[1:])} urad, limit 1",
           len(means) == 3 and max(map(abs, errors)) < 1.0)
    demand(f"the emulated axis has no effect of the temperature: {tilt['slope_urad_per_degc']:.1f} +- "
           f"{tilt['slope_error_urad_per_degc']:.1f} urad/degC, limit 3 u",
           abs(tilt["slope_urad_per_degc"]) < 3.0 * tilt["slope_error_urad_per_degc"])
    demand("page, figure and data are there", all((scratch / "out" / name).exists() for name in (
        "record.html", "figures/tilt-x.svg", "figures/tilt-x.dat")) and not (scratch / "out" / "response.csv").exists())

    axes = []
    for channel in ("BN1", "BN2", "BNZ"):
        axes.append([float(row["mgal"]) for row in exported(scratch, channel, "--unit", "mgal")])
    for name, (x, y, z) in (("tilt-x", axes), ("tilt-y", (axes[1], axes[0], axes[2]))):
        values = [float(row["urad"]) for row in exported(scratch, name)]
        own = [1e6 * math.asin(one / math.sqrt(one * one + two * two + three * three)) for one, two, three in zip(x, y, z)]
        worst = max(abs(one - other) for one, other in zip(values, own))
        demand(f"export of {name}: {len(values)} values are asin(axis / norm) of the exported axes within {worst:.1e} urad, limit 1e-6",
               len(values) == len(own) == 600 and worst < 1e-6)
    near = [float(row["tilt_urad"]) for row in table if FROM <= row["time_utc"] < TO]
    mean_x = sum(float(row["urad"]) for row in rows(scratch / "tilt-x.csv")) / 600
    demand(f"its mean is that of record within {abs(mean_x - sum(near) / len(near)):.2f} urad, limit 1",
           abs(mean_x - sum(near) / len(near)) < 1.0)

    for word, command in (("allowed: urad", exporting(scratch, "tilt-x", "csv", "--unit", "mgal")),
                          ("not a tilt", exporting(scratch, "BNZ", "csv", "--unit", "urad")),
                          ("allowed: csv", exporting(scratch, "tilt-y", "mseed")),
                          ("--quantity", recording(scratch, "--quantity", "tilt-z")),
                          ("--mode: has no effect", recording(scratch, "--quantity", "tilt-x", "--mode", "3"))):
        refused(word, *command)
