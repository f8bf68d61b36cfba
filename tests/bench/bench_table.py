"""Runs all benchmarks one after another and prints a table of promised and measured values.

It is the target `bench`, and takes a quarter of an hour.  No time is promised in seconds: a ratio compares two measurements of the
same run, so that another machine has about the same one.
"""

import os
import pathlib
import re
import subprocess
import sys

from command_line import at_least, command_line
from simulated_units import TOOLS
from programs import BIN, TOP

HERE = pathlib.Path(__file__).resolve().parent
GOLDEN = TOP / "tests" / "golden" / "tsukuba"

FIRST_SEED = 5001  # Seeds from 5001 on were not used while the corrector was developed: survey_accuracy.py.

line = command_line(__doc__, "bench_table.py --days 20", has_promises=False)
line.add_argument("--days", metavar="N", type=at_least(1), default=1,
                  help="simulated days for each scenario; 20, for which the promises are made, take half an hour more")
line.add_argument("--read", metavar="FILE", type=pathlib.Path, help="prints only the table, from the output of an earlier run")
line.add_argument("--beside", metavar="FOLDER", type=pathlib.Path,
                  help="folder with the a351-correct of an earlier commit, for speed.py")
options = line.parse_args()

OUTCOMES = {0: "kept", 77: "skipped"}  # Exit status of a system test: tests/system/programs.py.
PYTHON = [sys.executable]
COMMANDS = [
    [TOOLS / "micro_bench"], [TOOLS / "eemd_accuracy"], [*PYTHON, HERE / "eemd_peers.py"], [*PYTHON, HERE / "decimation_peer.py"],
    [TOOLS / "plant_statistics_bench"], [TOOLS / "long_record_bench"],
    [BIN / "a351-correct", "table", "--sites", GOLDEN / "sites.csv", "--observations", GOLDEN / "observations.csv", "--model",
     "t-rate-drift", "--flags", "ignore", "--out", TOOLS / "published-table"],
    [*PYTHON, HERE / "survey_accuracy.py", f"{FIRST_SEED}-{FIRST_SEED + options.days - 1}"],
    [*PYTHON, HERE / "system_bench.py"], [*PYTHON, HERE / "speed.py", *(["--beside", options.beside] if options.beside else [])],
    ["env", "A351_LONG=1", TOOLS / "timing_test", "times behind*"], [*PYTHON, TOP / "tests/system/kill_daemon.py"],
    [TOOLS / "daemon_test", "after a power cut*"], [*PYTHON, TOP / "tests/system/same_bytes.py"],
    *([*PYTHON, TOP / "tests/system" / f"{name}.py"]
      for name in ("obspy_reads", "ringserver", "gsadjust", "stranger_reads")),
]

DAY = r"{}, units within {} %, {} set-ups?\n(?:.*\n)*?    {}: ([\d.]+)"
# Name of the promise, promised value, and pattern of the measured value in the output.
PROMISES = [
    ("published table, 19 rows kept, in sample", "<= 2.03 mGal", r"t-rate-drift: RMS ([\d.]+ mGal)"),
    ("  the same, leave-one-station-out", "no limit", r"t-rate-drift: RMS .*, ([\d.]+ mGal) \(leave-one-station-out\)"),
    ("simulated days of each scenario", "20", r"^  mean over (\d+) days"),
    ("tsukuba, out of sample, mean of the days", "<= 1.6 mGal", DAY.format("tsukuba", 25, 1, "out of sample")),
    ("  in sample", "<= 1.25 mGal", DAY.format("tsukuba", 25, 1, "in sample")),
    ("tilted, out of sample, mean of the days", "<= 1.6 mGal", DAY.format("tilted", 25, 1, "out of sample")),
    ("hot-afternoon, out of sample, mean of the days", "<= 1.7 mGal", DAY.format("hot-afternoon", 25, 1, "out of sample")),
    ("two set-ups per station, mean of the days", "<= 1.15 mGal", DAY.format("tsukuba", 25, 2, "out of sample")),
    ("ideal day", "<= 0.01 mGal", DAY.format("ideal", 0, 1, "out of sample")),
    ("killed at speed 1: samples lost before the kill", "<= 10",
     r"factor 1: .*\n?.*of any before the kill (\d+)"),
    ("100 power cuts: oldest sample lost, before its cut", "<= 1.0 s", r"the oldest fed ([\d.]+ s) before its cut"),
    ("time stamps behind a 16 ms timer, p99 after 600 s, ms", "<= 1", r"^16 ms timer +p50 [\d.]+ p99 ([\d.]+)"),
    ("  behind a 1 ms timer", "<= 0.3", r"^1 ms timer +p50 [\d.]+ p99 ([\d.]+)"),
    ("  the stated uncertainty covers", ">= 95 %", r"^16 ms, busy host .* covers ([\d.]+ %)"),
    ("daemon at 50 Hz, processor time of a minute / arithmetic", "no limit", r"a minute / plain arithmetic +([\d.]+)"),
    ("daemon at 50 Hz, peak memory", "< 60 MB", r"peak memory +([\d.]+ MB)"),
    ("survey day at 1000x, mean rate of 50 000 frames/s", "no limit", r"mean rate of nominal +([\d.]+ %)"),
    ("EEMD 5400 x 160, times faster than libeemd, same run", ">= 7 (floor 4)", r"^5400 x 160 +[\d.]+ +[\d.]+ +([\d.]+ times)"),
    ("  the same, / plain arithmetic", "no limit", r"^5400 x 160 +[\d.]+ +([\d.]+)"),
    ("  gain of a second thread / gain of plain arithmetic", ">= 0.95", r"second thread: .* ratio ([\d.]+)"),
    ("decimation, times faster than SciPy", ">= 2", r"ns: ([\d.]+) times"),
    *((f"{work}, / plain arithmetic", "no limit", rf"^{work} +\S+ \(.*?\) +(\S+ \(.*?\))")
      for work in ("survey day, t-rate-drift, no figures", "survey day, t-rate-drift, report and figures",
                   "survey day, auto, report and figures", "record of 24 h at 50 Hz, page and figures")),
    ("largest ratio to the earlier programs (--beside)", "<= 1.05", r"^largest ratio to the earlier program: ([\d.]+)"),
    ("same input, same bytes", "kept", r"^same_bytes.py: (\w+)"),
    ("archive and StationXML open in ObsPy", "kept", r"^obspy_reads.py: (\w+)"),
    ("ringserver to slarchive, byte by byte", "kept", r"^ringserver.py: (\w+)"),
    ("gsadjust.csv read by GSadjust", "kept", r"^gsadjust.py: (\w+)"),
    ("journal, miniSEED, events read by format pages alone", "kept", r"^stranger_reads.py: (\w+)"),
]


def measured():
    """Runs all commands, prints their output as it arrives, and returns it."""
    text = ""
    for command in COMMANDS:
        print("\n$", " ".join(pathlib.Path(part).name if i < 2 else str(part) for i, part in enumerate(map(str, command))), flush=True)
        with subprocess.Popen([str(part) for part in command], stdout=subprocess.PIPE, text=True,
                              env={**os.environ, "A351_TOOLS": str(TOOLS), "A351_BIN": str(BIN)}) as process:
            for line in process.stdout:
                print(line, end="", flush=True)
                text += line
        name = pathlib.Path(command[1] if command[0] == sys.executable else command[0]).name
        ended = f"{name}: {OUTCOMES.get(process.returncode, 'FAILED')}\n"
        print(ended, end="")
        text += ended
    return text


text = options.read.read_text() if options.read else measured()
print(f"\n{'promise':<58}{'promised':>16}{'measured':>16}")
for title, promised, pattern in PROMISES:
    found = re.search(pattern, text, re.M)
    print(f"{title:<58}{promised:>16}{found[1] if found else 'not measured':>16}")
