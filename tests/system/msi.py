"""msi, the inspector of libmseed's makers, reads archive and export: traces without gaps, and every sample correct.

msi is searched in PATH or named by A351_MSI (https://github.com/EarthScope/msi).
"""

import array
import os
import shutil
import struct

from programs import BIN, ONE_SITE, Scratch, demand, rows, run, skip

# A record across midnight with a clock error: two day files of each channel.
SCENARIO = """base = "quiet"
name = "midnight"
[schedule]
start_utc = "2017-07-15T23:30:00Z"
duration_h = 1.0
[clock]
error_ppm = 20.0
declared_rate_hz = 50.001
""" + ONE_SITE
FROM, TO = "2017-07-15T23:50:00Z", "2017-07-16T00:10:00Z"

msi = shutil.which(os.environ.get("A351_MSI") or "msi")
if msi is None:
    skip("msi is not in PATH; install it or set A351_MSI")
version = run(msi, "-V")
print((version.stdout + version.stderr).strip())


def traces(files):
    """Returns start, end, gap ("==": none), rate and samples of each trace: the last columns of msi's lines."""
    result = run(msi, "-tg", "-tf", 1, *files)
    demand(f"msi reports no error in {len(files)} files {result.stderr.strip()}", not result.stderr.strip())
    print(result.stdout, end="")
    return [line.split()[-5:] for line in result.stdout.splitlines() if line.startswith("FDSN:")]


def samples(files, scratch):
    """Returns the samples unpacked by msi, which also verifies the check values of Steim-2."""
    result = run(msi, "-b", scratch / "samples", *files)
    demand(f"msi unpacks them without an error {result.stderr.strip()}", not result.stderr.strip())
    return array.array("i", (scratch / "samples").read_bytes())


def truth(file):
    """Returns x, y, z and temperature in the order in which they were made: sim/truth/truth-format.md."""
    made = list(struct.iter_unpack("<q4iHHIB7x", file.read_bytes()[16:]))
    demand("every frame arrived", all(row[-1] == 0 for row in made))
    return {channel: array.array("i", [row[i] for row in made])
            for i, channel in enumerate(("BN1", "BN2", "BNZ", "BK1"), 1)}


with Scratch() as scratch:
    root = scratch / "day"
    (scratch / "midnight.toml").write_text(SCENARIO)
    run(BIN / "a351-sim", "survey", "--scenario", scratch / "midnight.toml", "--seed", 3, "--out", root)
    made = truth(root / "truth.bin")
    channels = sorted(file.name.split(".")[0] for file in root.glob("archive/*/*/*/*.D"))
    for channel in channels:
        files = sorted(root.glob(f"archive/*/*/*/{channel}.D/*"))
        found = traces(files)
        demand(f"{channel}: two day files are one trace without a gap", len(files) == 2 and len(found) == 1)
        if channel in made:
            counts = samples(files, scratch)
            demand(f"{channel}: its {len(counts)} samples are the first of {len(made[channel])} that the sensor made",
                   len(counts) == int(found[0][4]) and counts == made[channel][:len(counts)]
                   and len(counts) > 0.99 * len(made[channel]))
    demand(f"channels {', '.join(made)} and slow channels were checked", made.keys() < set(channels))

    for form in ("mseed", "csv"):
        run(BIN / "a351-correct", "export", root, "--from", FROM, "--to", TO, "--channel", "BNZ", "--rate", 50,
            "--format", form, "--out", scratch / f"grid.{form}")
    found = traces([scratch / "grid.mseed"])
    demand("the export is one trace of exactly 50 Hz on the grid", found == [
        ["2017-07-15T23:50:00.000000", "2017-07-16T00:09:59.980000", "==", "50", "60000"]])
    rounding = [count - float(row["counts"]) for count, row in
                zip(samples([scratch / "grid.mseed"], scratch), rows(scratch / "grid.csv"), strict=True)]
    demand(f"the counts differ from the values of the CSV by at most {max(map(abs, rounding)):.3f}, rounding allows 0.5",
           max(map(abs, rounding)) <= 0.5)
