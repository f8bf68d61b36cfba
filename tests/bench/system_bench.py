"""Measures processor time and memory of the daemon at 50 Hz in real time, and the rate of a survey day at 1000x.

The time is divided by that of the loop of arithmetic of speed.py in the same run.
"""

import os
import pathlib
import signal
import subprocess
import time

from command_line import command_line
from speed import used_s
from programs import BIN, TOOLS, TOP, Scratch, answer, daemon_config, read_json, run, unused_port

REAL_TIME_SECONDS = 60


def cpu_seconds(pid):
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def peak_memory_mb(pid):
    for line in pathlib.Path(f"/proc/{pid}/status").read_text().splitlines():
        if line.startswith("VmHWM"):
            return int(line.split()[1]) / 1024
    return float("nan")


def row(name, value, promise):
    print(f"{name:<56} {value:>12}   promised {promise}")


command_line(__doc__, "system_bench.py", has_promises=False).parse_args()
loop_s = used_s([TOOLS / "plain_loops", "arithmetic"])
port = unused_port()
with Scratch() as scratch:
    (scratch / "a351d.toml").write_text(daemon_config(port))
    sim = subprocess.Popen([BIN / "a351-sim", "device", "--link", "sensor"], cwd=scratch,
                           stderr=subprocess.DEVNULL)
    daemon = subprocess.Popen([BIN / "a351d", "--config", "a351d.toml"], cwd=scratch,
                              stderr=subprocess.DEVNULL)
    time.sleep(5)
    first = answer(port, "/api/status")["journaled"]
    before = cpu_seconds(daemon.pid)
    time.sleep(REAL_TIME_SECONDS)
    recorded = answer(port, "/api/status")["journaled"] - first
    row(f"a351d at 50 Hz: samples journaled in {REAL_TIME_SECONDS} s", str(recorded), str(50 * REAL_TIME_SECONDS))
    row("a351d at 50 Hz: processor time of a minute / plain arithmetic", f"{(cpu_seconds(daemon.pid) - before) / loop_s:.2f}", "-")
    row("a351d at 50 Hz: peak memory", f"{peak_memory_mb(daemon.pid):.1f} MB", "< 60 MB")
    for process in (daemon, sim):
        process.send_signal(signal.SIGTERM)
        process.wait(timeout=30)

with Scratch() as scratch:
    run(TOP / "sim" / "demo", "tsukuba", "--out", scratch / "day")
    report = read_json(scratch / "day" / "report.json")
    row("survey day at 1000x: mean rate of nominal", f"{report['mean_rate_real_hz'] / 500:.2f} %", "-")
    row("survey day at 1000x: largest lateness", f"{1e3 * report['largest_lateness_real_s']:.1f} ms", "-")
