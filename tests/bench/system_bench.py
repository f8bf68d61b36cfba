"""Measures whole programs: CPU time and memory of the daemon at 50 Hz in real time, and a survey day at 1000x."""

import json
import os
import pathlib
import signal
import subprocess
import sys
import time
import urllib.request

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "system"))
from programs import BIN, TOP, Scratch, daemon_config, read_json, run

REAL_TIME_SECONDS = 60


def cpu_seconds(pid):
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def peak_memory_mb(pid):
    for line in pathlib.Path(f"/proc/{pid}/status").read_text().splitlines():
        if line.startswith("VmHWM"):
            return int(line.split()[1]) / 1024
    return float("nan")


def journaled():
    with urllib.request.urlopen("http://127.0.0.1:28351/api/status", timeout=2) as reply:
        return json.load(reply)["journaled"]


def row(name, value, promise):
    print(f"{name:<52} {value:>16}   promised {promise}")


with Scratch() as scratch:
    (scratch / "a351d.toml").write_text(daemon_config(28351))
    sim = subprocess.Popen([BIN / "a351-sim", "device", "--link", "sensor"], cwd=scratch,
                           stderr=subprocess.DEVNULL)
    daemon = subprocess.Popen([BIN / "a351d", "--config", "a351d.toml"], cwd=scratch,
                              stderr=subprocess.DEVNULL)
    time.sleep(5)
    first = journaled()
    before, began = cpu_seconds(daemon.pid), time.monotonic()
    time.sleep(REAL_TIME_SECONDS)
    recorded = journaled() - first
    row(f"a351d at 50 Hz: samples journaled in {REAL_TIME_SECONDS} s", str(recorded), str(50 * REAL_TIME_SECONDS))
    share = (cpu_seconds(daemon.pid) - before) / (time.monotonic() - began)
    row("a351d at 50 Hz: share of one core", f"{100 * share:.2f} %", "< 1 %")
    row("a351d at 50 Hz: peak memory", f"{peak_memory_mb(daemon.pid):.1f} MB", "< 60 MB")
    for process in (daemon, sim):
        process.send_signal(signal.SIGTERM)
        process.wait(timeout=30)

with Scratch() as scratch:
    began = time.monotonic()
    run(TOP / "sim" / "demo", "tsukuba", "--out", scratch / "day")
    seconds = time.monotonic() - began
    report = read_json(scratch / "day" / "report.json")
    row("survey day at 1000x: time with correction", f"{seconds:.1f} s", "day < 60 s")
    row("survey day at 1000x: mean rate of nominal", f"{report['mean_rate_real_hz'] / 500:.2f} %",
        ">= 95 %")
    row("survey day at 1000x: largest lateness", f"{1e3 * report['largest_lateness_real_s']:.1f} ms", "-")
    began = time.monotonic()
    run(BIN / "a351-correct", "survey", scratch / "day" / "survey.toml", "--model", "paper", "--out",
        scratch / "result")
    row("correction of 19 occupations, model paper", f"{time.monotonic() - began:.2f} s", "< 2 s")
    began = time.monotonic()
    run(BIN / "a351-sim", "survey", "--scenario", "tsukuba", "--seed", 1, "--out", scratch / "root")
    row("a351-sim survey: a day written directly", f"{time.monotonic() - began:.1f} s", "-")
