"""Three days of a sensor whose clock is 20 ppm fast, behind a USB adapter with a 16 ms latency timer.

Readers must join the days to one trace, and the times must be as accurate as stated, also with records of 1 s.  The short form
ends two hours after the second midnight, so that it has files of three days too; A351_LONG=1: 72 h.
"""

from programs import BIN, IS_LONG, IS_SANITIZED, TOOLS, Scratch, compare_truth, demand, fields, one_site, run
from with_obspy import HINT, has_obspy

if has_obspy():
    import numpy
    import obspy
else:
    obspy = None
    print(f"{HINT}: only libmseed joins the traces")

LINE = """[clock]
error_ppm = 20.0
declared_rate_hz = 50.001
record_age_s = AGE
[line]
latency_timer_ms = 16.0
latency_timer_ppm = 30.0
usb_poll_ms = 1.0
jitter_ms = 0.3
stall_per_h = 1.0
"""


def joined(root, channel):
    result = fields(run(TOOLS / "mseed-traces", root / "archive", channel).stdout)
    print(root.name, result)
    return result


def merged_by_obspy(root, channel):
    """Merges the channel's day files; returns the numbers of traces and samples, and True if they are those of the files."""
    stream = obspy.Stream()
    for file in sorted(root.glob(f"archive/*/*/*/{channel}.D/*")):
        stream += obspy.read(str(file))
    days = [trace.data for trace in stream]
    stream.merge()
    print(root.name, f"ObsPy {obspy.__version__}:", stream)
    data = numpy.ma.compressed(stream[0].data)
    return len(stream), len(data), numpy.array_equal(data, numpy.concatenate(days))


def survey(scratch, hours, age_s=60):
    """Simulates the record and re-times it; returns both data roots.  `age_s` is the longest time in a record."""
    root, better = scratch / f"live-{hours}-{age_s}", scratch / f"re-timed-{hours}-{age_s}"
    (scratch / "three-days.toml").write_text(one_site("quiet", "2017-07-15T18:00:00Z", hours) + LINE.replace("AGE", str(age_s)))
    run(BIN / "a351-sim", "survey", "--scenario", scratch / "three-days.toml", "--seed", 5, "--out", root)
    print(run(BIN / "a351-correct", "retime", root, "--out", better).stdout.strip())
    return root, better


with Scratch() as scratch:
    hours = 6 if IS_SANITIZED else 72 if IS_LONG else 32
    for root in survey(scratch, hours):
        for channel in ("BNZ", "BN1", "BN2", "BK1"):
            found = joined(root, channel)
            demand(f"{root.name}: {channel}: the days form one trace", found["traces"] == "1")
            demand(f"{root.name}: {channel}: merging loses no sample",
                   found["samples"] == found["recorded"] and int(found["samples"]) > 0.9999 * hours * 3600 * 50)
            if obspy:
                demand(f"{root.name}: {channel}: ObsPy merges the days to one trace with every sample",
                       merged_by_obspy(root, channel) == (1, int(found["samples"]), True))
            demand(f"{root.name}: {channel}: the end differs by {found['end_error_s']} s from start and rate, limit 0.010",
                   abs(float(found["end_error_s"])) < 0.010)

    sizes = {}
    for age_s in (60, 1):
        live, better = survey(scratch, 3, age_s)
        for root, limit_ms in ((live, 4.5), (better, 1.0)):
            counted = compare_truth(root / "archive", live / "truth.bin").values()
            worst_ms = max(1e3 * one["largest_time_error_s"] for one in counted)
            demand(f"{root.name}: largest time error of a sample {worst_ms:.3f} ms, limit {limit_ms}", worst_ms < limit_ms)
            demand(f"{root.name}: no sample is missing, and no record boundary steps", all(one["missing"] == one["steps"] == 0 for one in counted))
        sizes[age_s] = sum(file.stat().st_size for file in (live / "archive").rglob("*.D.*"))
    print(f"archive of three hours: {sizes[60] / 1e6:.1f} MB, with records of 1 s {sizes[1] / 1e6:.1f} MB, "
          f"{sizes[1] / sizes[60]:.1f} times as large")
