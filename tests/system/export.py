"""`export`: values on an exact 50 Hz grid of UTC, the same in both formats and with the sensor's mean; bad input is refused.

Also the status of `export` and `retime` if their input is damaged.
"""

import datetime

from programs import BIN, TOOLS, TOP, Scratch, demand, instant, refused, rows, run

FROM, TO = "2017-07-15T23:50:00Z", "2017-07-16T00:10:00Z"
SECONDS = 1200


def exporting(root, out, rate, form, channel="BNZ", *more):
    return (BIN / "a351-correct", "export", root, "--from", FROM, "--to", TO, "--channel", channel, "--rate", rate, "--format", form,
            "--out", out, *more)


def export(*arguments, check=True):
    return run(*exporting(*arguments), check=check)


with Scratch() as scratch:
    root = scratch / "day"
    run(BIN / "a351-sim", "survey", "--scenario", "ideal", "--seed", 3, "--out", root)
    print(export(root, scratch / "grid.csv", 50, "csv").stdout, end="")
    grid = rows(scratch / "grid.csv")
    demand(f"{len(grid)} values across midnight, none missing", len(grid) == 50 * SECONDS)
    first = instant(FROM)
    demand("each time is a whole multiple of 20 ms", all(
        row["time_utc"] == (first + datetime.timedelta(milliseconds=20 * i)).strftime("%Y-%m-%dT%H:%M:%S.%f000Z")
        for i, row in enumerate(grid)))

    archived = export(root, scratch / "slow.csv", 1, "csv")
    slow = [float(row["counts"]) for row in rows(scratch / "slow.csv")]
    fast = [float(row["counts"]) for row in grid]
    means = [sum(fast[50 * i - 25:50 * i + 25]) / 50 for i in range(1, SECONDS)]
    offset = sum(a - b for a, b in zip(slow[1:], means)) / len(means)
    demand(f"values at 1 Hz and means of 50 Hz differ by {offset:+.4f} counts on average, limit 0.05", abs(offset) < 0.05)

    for unit, least, most in (("mg", 950.0, 1050.0), ("mgal", 970000.0, 990000.0)):
        export(root, scratch / f"{unit}.csv", 1, "csv", "BNZ", "--unit", unit)
        values = [float(row[unit]) for row in rows(scratch / f"{unit}.csv")]
        ratios = {value / counts for value, counts in zip(values, slow)}
        demand(f"in {unit} the vertical axis has {values[0]:.4f}, and every value the same scale",
               least < values[0] < most and max(ratios) - min(ratios) < 1e-12 * max(ratios))

    export(root, scratch / "grid.mseed", 50, "mseed")
    traces = run(TOOLS / "mseed-traces", scratch, "grid.mseed").stdout
    print(traces, end="")
    found = dict(part.split("=") for part in traces.split())
    demand("libmseed joins the records to one trace with the correct end time",
           found["traces"] == "1" and int(found["samples"]) == 50 * SECONDS and abs(float(found["end_error_s"])) < 2e-6)
    raw = (scratch / "grid.mseed").read_bytes()
    demand("the location code is 10 and the rate 50 Hz", raw[13:15] == b"10" and raw[32:36] == b"\0\x32\0\1")

    for rate, channel, form, unit, word in ((60, "BNZ", "csv", "counts", "--rate = 60"), (50, "BNX", "csv", "counts", "no samples of BNX"),
                                            (7.5, "BNZ", "csv", "counts", "a whole number from 1 to 1000"),
                                            (50, "BK1", "csv", "mg", "BK1 is not a channel of acceleration"),
                                            (50, "BNZ", "mseed", "mgal", "whole counts"), (50, "BNZ", "wav", "counts", "--format")):
        refused(word, *exporting(root, scratch / "refused", rate, form, channel, "--unit", unit))
    day_file = next(root.rglob("*.BNZ.D.2017.196"))
    whole = day_file.read_bytes()
    at = len(whole) - 5 * 512
    day_file.write_bytes(whole[:at] + bytes(512) + whole[at + 512:])
    damaged = export(root, scratch / "damaged.csv", 50, "csv", check=False)
    demand("an export of a damaged archive ends with status 4", damaged.returncode == 4)
    print(damaged.stderr + damaged.stdout, end="")
    demand("a damaged record is reported once, with its offset", damaged.stderr.count("\n") == 1 and
           damaged.stderr.endswith(f"{day_file.name}: offset {at}: 512 bytes are not a record\n"))
    left = {row["time_utc"]: row["counts"] for row in rows(scratch / "damaged.csv")}
    good = {row["time_utc"]: row["counts"] for row in grid}
    kept = sum(left.get(time) == counts for time, counts in good.items())
    demand(f"{len(good) - kept} of {len(good)} values are lost with the damaged record, the others are unchanged",
           0 < len(good) - kept < 1000)

    demand("a refused export leaves no file", not list(scratch.glob("refused*")))

    again = bytearray(whole[-20 * 512:])  # After the clock was set back; later by 5 ms, in 0.1 ms.
    for at in range(28, len(again), 512):
        again[at:at + 2] = ((int.from_bytes(again[at:at + 2], "big") + 50) % 10000).to_bytes(2, "big")
    day_file.write_bytes(whole + again)
    twice = export(root, scratch / "twice.csv", 50, "csv")
    print(twice.stderr, end="")
    demand("instants that occur twice are named in one line", twice.stderr.count("\n") == 1
           and "instants from 2017-07-15T23:5" in twice.stderr and "occur twice" in twice.stderr)
    written = [row["time_utc"] for row in rows(scratch / "twice.csv")]
    demand("their values are there twice", len(written) - len(set(written)) > 1000)

# A journal is re-timed as far as it can be read.
LOG = TOP / "tests" / "golden" / "logs" / "clean_start.a351j"
with Scratch() as scratch:
    segment = scratch / "data" / "journal" / "00000001_20260301T130000Z.a351j"
    segment.parent.mkdir(parents=True)
    whole = LOG.read_bytes()
    for title, content, status, is_written in (("whole", whole, 0, True),
                                               ("flipped", whole[:5000] + bytes([whole[5000] ^ 1]) + whole[5001:], 4, True),
                                               ("unreadable", bytes(len(whole)), 1, False)):
        segment.write_bytes(content)
        retimed = run(BIN / "a351-correct", "retime", scratch / "data", "--out", scratch / title, check=False)
        print(retimed.stderr + retimed.stdout, end="")
        demand(f"re-timing a journal that is {title} ends with status {status}", retimed.returncode == status)
        demand(f"it writes {'an archive' if is_written else 'nothing'}", (scratch / title).exists() == is_written)
