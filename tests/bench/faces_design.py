"""Compares what a351-correct design expects of set-ups in two faces with the bound of faces_bound.py, which has no code of the corrector.

Needs numpy.  Days of tsukuba, one known station, + - - + of three minutes.  The unit's share of the scale is known, by a
calibration with [faces], or not known.  Of a unit whose share is not known the bound knows that of flicker, drift and warm-up.
Promised: within 10 % of the bound.
"""

import json
import statistics

from command_line import add_days, command_line, end_with
from faces_bound import KNOWN, SHARES, Day, bound
from simulated_units import VALID_FROM, hide_references, rms
from programs import BIN, Scratch, rows, run

FACES, GRADIENT_mgal, MOST_OFF = "+--+", 1.0, 0.10
RESPONSE_mgal_per_degc, U_mgal_per_degc = -32.0, 0.1


def calibration(share):
    return (f'format = 1\nserial_number = "1"\nprogram = "faces_design"\nvalid_from_utc = "{VALID_FROM}"\n[faces]\n'
            'coefficients = ["bias_mgal", "scale_mgal", "bias_mgal_per_degc", "scale_mgal_per_degc"]\n'
            f"values = [0.0, 0.0, {RESPONSE_mgal_per_degc * (1.0 - share)}, {RESPONSE_mgal_per_degc * share}]\n"
            f"covariance = {[U_mgal_per_degc ** 2 * (row == column) for row in range(4) for column in range(4)]}\n")


def expected(folder, share):
    """Returns u of the unknown stations of the plan of a day.  @param share  None: not known."""
    hide_references(folder, {KNOWN}, "known")
    plan = folder / "plan.csv"
    lines = ["site,start_utc,set_ups,minutes_each,faces"]
    for row in rows(folder / "truth.csv"):
        if row["set_up"] == "1":
            lines.append(f"{row['site']},{row['start_utc'][:19]}Z,{len(FACES)},3,{FACES}")
    plan.write_text("\n".join(lines) + "\n")
    unit = folder / "unit.toml"
    if share is not None:
        unit.write_text(calibration(share))
    out = run(BIN / "a351-correct", "design", plan, "--sites", folder / "known.csv", "--json", "--out", folder / "design",
              *(["--unit", unit] if share is not None else [])).stdout
    return json.loads(out)["u_mgal"]


def main():
    line = command_line(__doc__, "faces_design.py 95001 2")
    add_days(line, 95001, 10)
    options = line.parse_args()
    seeds, failures = range(options.first, options.first + options.days), []
    with Scratch() as scratch:
        days = [Day(scratch, seed, FACES) for seed in seeds]
        for share in SHARES:
            for is_known in (True, False):
                least = rms(bound(day, FACES, share, is_known, GRADIENT_mgal) for day in days)
                ours = statistics.fmean(expected(scratch / f"{seed}-{len(FACES)}", share if is_known else None) for seed in seeds)
                name = f"{100 * share:.0f} % on the scale, {'known' if is_known else 'not known'}"
                if abs(ours / least - 1.0) > MOST_OFF:
                    failures.append(name)
                print(f"{name}: {ours:.2f} mGal expected, "
                      f"bound {least:.2f}, {ours / least:.2f} times", flush=True)
    end_with(failures)


main()
