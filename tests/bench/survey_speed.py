"""Measures the time from a day's records at 50 Hz to table and report, in three runs of each kind."""

import pathlib
import resource
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "system"))
from programs import BIN, Scratch, read_json, rows, run

RUNS = 3
READINGS = 19
# Kind, its --model, the model that is applied, True if figures are drawn, promised time in s.
KINDS = [("a named linear model, no figures", "t-rate-drift", "t-rate-drift", False, 2.0),
         ("auto: the whole-day model, no figures", "auto", "day", False, 6.0),
         ("auto: the whole-day model, report and figures", "auto", "day", True, 10.0)]


def cpu_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


with Scratch() as scratch:
    day = scratch / "day"
    run(BIN / "a351-sim", "survey", "--scenario", "tsukuba", "--seed", 3, "--out", day)
    nowhere = scratch / "no-gnuplot"
    nowhere.mkdir()
    print(f"{'a tsukuba day of 19 occupations at 50 Hz':<48} {'wall s':>18} {'cpu s':>18}")
    for title, asked, applied, has_figures, promise_s in KINDS:
        walls, cpus = [], []
        for _ in range(RUNS):
            began, before = time.monotonic(), cpu_seconds()
            run(BIN / "a351-correct", "survey", day / "survey.toml", "--model", asked, "--out", scratch / "out",
                env={} if has_figures else {"PATH": str(nowhere)})
            walls.append(time.monotonic() - began)
            cpus.append(cpu_seconds() - before)
        result = read_json(scratch / "out" / "result.json")
        drawn = "<svg" in (scratch / "out" / "report.html").read_text()
        if (result["model"], len(rows(scratch / "out" / "occupations.csv")), drawn) != (applied, READINGS, has_figures):
            sys.exit(f"{title}: the result is not the expected one, so the time is not valid")
        print(f"{title:<48} " + " ".join(f"{' '.join(f'{value:.2f}' for value in values):>18}" for values in (walls, cpus)) +
              f"   promised < {promise_s:.0f} s", flush=True)
