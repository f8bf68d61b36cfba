"""Measures how much a calibration reduces the errors on simulated days.

Each seed draws a unit: thermal parameters within +-25 % of the scenario's, axis biases within +-2 Gal.

Every calibration is measured: `calibrate --tilt` on the scenario tilt-series, `calibrate FILE` on a night of 12 h (indoor)
and on two days with their temperature changes (week), all of the same unit.

One datum: nine occupations of seven stations; No.0, occupied three times, is the only datum.  The error is that of
stations.csv at the six unknown stations.  Without a calibration the model is the network with the priors of
a351-survey.toml(5), the only choice with one datum.

Thermal prior: the error is leave-one-station-out over 19 occupations.

Calibration of another unit, drawn within +-60 %, measured in two days and given this unit's serial number: its error, how
often the report says that the readings contradict it, and how often it increases the error of a day by more than is
allowed without a warning.
"""

import concurrent.futures
import os
import shutil

from command_line import add_seeds, command_line, end_with
from simulated_units import TWO_DAYS, VALID_FROM, add_folder, correct, hide_references, kept, measure, rms, simulate
from programs import BIN, Scratch, read_json, rows, run

LEAST_GAIN = 0.30  # Promised reduction of the error by axis biases, one datum.
MOST_LOSS = 0.03  # Largest allowed increase of the error by a thermal prior.
SCATTER = 0.25  # Relative scatter of the units.
OTHER_SCATTER = 0.6  # Relative scatter of the other units.
STAYS = ("No.0", "No.1", "No.2", "No.3", "No.0", "No.4", "No.5", "No.6", "No.0")
AMBIENT = (24.3, 23.4, 24.1, 23.8, 26.7, 30.6, 31.4, 31.7, 32.0)
NOTHING = "no calibration"
WHOLE_DAY = "19 occupations, leave-one-station-out"
FLAGS = "refused", "said to be contradicted", "said to be worse with it", "above and not said"  # counted in units
PRIORS = ("[prior]\nrate_mgal_per_degc_per_h = [10, 6]\ntemperature_mgal_per_degc = [-30, 15]\n"
          "time_mgal_per_h = [0, 1]\n")


def nine_stays():
    text = ""
    for i, (site, ambient) in enumerate(zip(STAYS, AMBIENT)):
        minutes = 35 * i
        text += (f'[[occupation]]\nsite = "{site}"\nnumber = {STAYS[:i + 1].count(site)}\n'
                 f'centre_utc = "2017-07-16T{minutes // 60:02}:{minutes % 60:02}:00Z"\nambient_degc = {ambient}\n')
    return text


def unknown_errors(out, truth):
    return [float(row["gravity_mgal"]) - truth[row["site"]] for row in rows(out / "stations.csv")
            if row["site"] != "No.0"]


def left_out_error(out):
    return rms(float(row["left_out_mgal"]) - float(row["reference_mgal"]) for row in rows(out / "occupations.csv"))


def is_contradicted(out, part):
    calibration = read_json(out / "result.json").get("calibration") or {}
    return calibration.get(part, {}).get("contradicted") is True


def is_called_worse(out):
    calibration = read_json(out / "result.json").get("calibration") or {}
    return calibration.get("worse_with_it") is True


def one_datum(folder, seed, axes, both, night, days):
    """Corrects nine occupations of the unit with different calibrations; returns the RMS error of each."""
    day = simulate(folder, "nine", "tilted", seed, SCATTER, nine_stays())
    plain, truth = hide_references(day, ["No.0"], "plain")
    survey = day / "priors.toml"
    survey.write_text(plain.read_text() + PRIORS)
    outs = {
        "network": correct(day, survey, "1", "--model", "network"),
        "network, axis biases": correct(day, survey, "2", "--model", "network", *axes),
        "auto, axis biases": correct(day, plain, "3", *axes),
        "auto, thermal of a night": correct(day, plain, "4", *night),
        "auto, thermal of two days": correct(day, plain, "5", *days),
        "auto, axis biases and thermal of two days": correct(day, plain, "6", *both),
    }
    return {name: rms(unknown_errors(out, truth)) for name, out in outs.items()}


def whole_day(folder, seed, calibrations):
    """Corrects 19 occupations of the unit; returns the error by calibration, and flags for the warnings of the report."""
    day = simulate(folder, "whole", "tilted", seed, SCATTER)
    errors, flags = {}, {}
    for i, (name, options) in enumerate(calibrations.items()):
        out = correct(day, day / "survey.toml", f"w{i}", *options)
        errors[name] = left_out_error(out)
        if name == NOTHING:
            continue
        part = "axis_bias" if name.startswith("axis") else "thermal"
        is_warned = [is_contradicted(out, part), is_called_worse(out)]
        flags[name] = dict(zip(FLAGS, [not options, *is_warned, errors[name] > (1.0 + MOST_LOSS) * errors[NOTHING] and not any(is_warned)]))
    return errors, flags


def look_at(scratch, seed):
    folder = scratch / str(seed)
    folder.mkdir()
    night, days = (measure(folder, "night", "indoor", seed, SCATTER),
                   measure(folder, "days", "week", seed, SCATTER, TWO_DAYS))
    other = measure(folder, "other", "week", seed + 100, OTHER_SCATTER, TWO_DAYS)
    tilt = simulate(folder, "tilt-series", "tilt-series", seed, SCATTER)
    calibrate = (BIN / "a351-correct", "calibrate", "--tilt", tilt, "--valid-from", VALID_FROM, "--out")
    axes, both, turned = folder / "axes.toml", folder / "both.toml", folder / "turned.toml"
    run(*calibrate, axes)
    run(*calibrate, both, *(["--merge", days[1]] if days else []))
    turned.write_text(axes.read_text().replace("values = [", "values = [-").replace("[--", "["))
    axes, both, turned = (["--calibration", file] for file in (axes, both, turned))

    errors, flags = whole_day(folder, seed, {
        NOTHING: [], "thermal of a night": night, "thermal of two days": days, "axis biases": axes,
        "axis biases and thermal of two days": both, "thermal of another unit": other, "axis biases with x turned": turned})
    found = {"one datum": one_datum(folder, seed, axes, both, night, days), WHOLE_DAY: errors}
    shutil.rmtree(folder)
    print(f"unit {seed}: " + "; ".join(f"{name} {value:.2f}" for group in found.values() for name, value in group.items()),
          flush=True)
    return [found, flags]


line = command_line(__doc__, "calibration_gain.py 8101-8104")
add_seeds(line, "8101-8120")
add_folder(line)
options = line.parse_args()
failures = []
with Scratch() as scratch, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    store = options.keep or scratch
    units = list(pool.map(lambda seed: kept(store / f"{seed}.json", lambda: look_at(scratch, seed)), options.seeds))

def error_of(group, name):
    """Returns the rms over the units of the rms error of a day, and how much smaller it is than that of the first arm, as a share."""
    first = next(iter(units[0][0][group]))
    error, reference = (rms(found[group][arm] for found, _ in units) for arm in (name, first))
    return error, 1.0 - error / reference


print(f"{len(units)} units\none datum, rms error, mGal, and % smaller than that of the first row")
for name in units[0][0]["one datum"]:
    error, gain = error_of("one datum", name)
    print(f"  {name:46} {error:6.2f} {100 * gain:6.1f}")
    if "axis biases" in name and gain < LEAST_GAIN:
        failures.append(f"{name}: error {100 * gain:.1f} % smaller, promised {100 * LEAST_GAIN:.0f} %")
print(f"{WHOLE_DAY}, mGal, % larger than without, units above {100 * MOST_LOSS:.0f} %; {', '.join(FLAGS)}")
for name in units[0][0][WHOLE_DAY]:
    error, gain = error_of(WHOLE_DAY, name)
    above = sum(found[WHOLE_DAY][name] > (1.0 + MOST_LOSS) * found[WHOLE_DAY][NOTHING] for found, _ in units)
    said = "".join(f"{sum(flags[name][flag] for _, flags in units):4}" for flag in FLAGS) if name != NOTHING else ""
    print(f"  {name:46} {error:6.2f} {-100 * gain + 0.0:+6.1f} {above:4} ;{said}")
    if name in ("thermal of a night", "thermal of two days") and -gain > MOST_LOSS:
        failures.append(f"{name}: error {-100 * gain:.1f} % larger, allowed {100 * MOST_LOSS:.0f} %")
end_with(failures)
