"""Measures time and memory of `record` for a week at one point with 50 Hz, with statistics, page and figures.

Runs it three times and checks its progress bars on a terminal.

usage: record_speed.py [HOURS]    (A351_BIN, A351_TOOLS); default 168, simulated in a minute
"""

import os
import pathlib
import pty
import resource
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "system"))
from programs import BIN, Scratch, read_json, run

RUNS = 3
PROMISED_S = 20.0  # Elapsed time on two cores.
FIGURES = 8


def measured(folder, out):
    """Runs `record` and returns elapsed and CPU time in s, peak memory in MB, and its output on a terminal."""
    ours, theirs = pty.openpty()
    began, before = time.monotonic(), resource.getrusage(resource.RUSAGE_CHILDREN)
    process = subprocess.Popen([BIN / "a351-correct", "record", folder, "--out", out], stdout=subprocess.DEVNULL,
                               stderr=theirs)
    os.close(theirs)
    seen = b""
    while True:
        try:
            part = os.read(ours, 65536)
        except OSError:  # The program has closed its end.
            break
        seen += part
    os.close(ours)
    if process.wait() != 0:
        sys.exit(f"record ended with {process.returncode}: {seen.decode()}")
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu_s = used.ru_utime + used.ru_stime - before.ru_utime - before.ru_stime
    return time.monotonic() - began, cpu_s, used.ru_maxrss / 1024, seen.decode()


hours = float(sys.argv[1]) if len(sys.argv) > 1 else 168.0
with Scratch() as scratch:
    scenario = scratch / "week.toml"
    scenario.write_text(f'base = "week"\nname = "week"\n[schedule]\nduration_h = {hours}\n')
    run(BIN / "a351-sim", "survey", "--scenario", scenario, "--seed", 3, "--out", scratch / "root")
    for _ in range(RUNS):
        wall_s, cpu_s, memory_mb, seen = measured(scratch / "root", scratch / "out")
        bars = [label for label in ("read", "decompose") if f"{label} [" in seen]
        print(f"{hours:.0f} h at 50 Hz: wall {wall_s:.1f} s (promised for a week < {PROMISED_S:.0f} s), "
              f"processor {cpu_s:.1f} s, peak {memory_mb:.0f} MB, progress bars: {', '.join(bars) or 'none'}", flush=True)
    samples = sum(part["samples"] for part in read_json(scratch / "out" / "result.json")["segments"])
    figures = len(list((scratch / "out" / "figures").glob("*.svg")))
    print(f"{samples} samples of 20 s analysed, {figures} figures")
    if samples < 0.99 * hours * 180 or figures != FIGURES:
        sys.exit("the result is not complete, so the time is not valid")
