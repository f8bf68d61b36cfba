"""Measures the time of whole programs beside plain loops, and beside the programs of an earlier commit.

In each run every work is done in turn by both programs, and both loops run, so that a load of the host meets all of them.
A time is that of the processor, children included; it is divided by that of the loop of arithmetic in the same run.
Promised: no work takes more than 1.05 times as long as with the earlier program.
"""

import os
import pathlib
import platform
import re
import resource
import statistics
import subprocess
import sys

from command_line import at_least, command_line, end_with
import simulated_units  # noqa: F401  finds the modules of tests/system
from programs import BIN, TOOLS, Scratch, read_json, rows, run

SLOWER = 1.05
READINGS = 19


def used_s(command, env=None):
    """Runs a command and returns its processor time in s."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([str(part) for part in command], check=True, env={**os.environ, **(env or {})}, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def spread(values):
    return f"{statistics.median(values):.2f} ({min(values):.2f} to {max(values):.2f})"


def works(scratch, hours):
    """Returns the arguments and the environment of each work, by its name."""
    day, week, nowhere = scratch / "day", scratch / "record", scratch / "no-gnuplot"
    nowhere.mkdir()
    run(BIN / "a351-sim", "survey", "--scenario", "tsukuba", "--seed", 3, "--out", day)
    (scratch / "record.toml").write_text(f'base = "week"\nname = "record"\n[schedule]\nduration_h = {hours}\n')
    run(BIN / "a351-sim", "survey", "--scenario", scratch / "record.toml", "--seed", 3, "--out", week)
    plain = {"PATH": str(nowhere)}
    survey = ["survey", day / "survey.toml", "--out"]
    return {
        "survey day, t-rate-drift, no figures": ([*survey, scratch / "a", "--model", "t-rate-drift"], plain),
        "survey day, t-rate-drift, report and figures": ([*survey, scratch / "b", "--model", "t-rate-drift"], {}),
        "survey day, auto, report and figures": ([*survey, scratch / "c", "--model", "auto"], {}),
        f"record of {hours:g} h at 50 Hz, page and figures": (["record", week, "--out", scratch / "d"], {}),
    }


def require_results(scratch, hours):
    for name, model, drawn in (("a", "t-rate-drift", False), ("b", "t-rate-drift", True), ("c", "day", True)):
        result = read_json(scratch / name / "result.json")
        if (result["model"], len(rows(scratch / name / "occupations.csv")), "<svg" in (scratch / name / "report.html").read_text()) != \
                (model, READINGS, drawn):
            sys.exit(f"{name}: the result is not the expected one, so the time is not valid")
    samples = sum(part["samples"] for part in read_json(scratch / "d" / "result.json")["segments"])
    if samples < (hours - 0.1) * 180:  # It begins with a few minutes without a value.
        sys.exit(f"the record has {samples} samples, so the time is not valid")


def main():
    line = command_line(__doc__, "speed.py --hours 4 --runs 2")
    line.add_argument("--beside", metavar="FOLDER", type=pathlib.Path, help="folder with the a351-correct of an earlier commit")
    line.add_argument("--hours", metavar="H", type=at_least(4.0, float), default=24.0,
                      help="length of the record at 50 Hz, h; below 3 h in one piece it cannot be analysed")
    line.add_argument("--runs", metavar="N", type=at_least(1), default=5, help="runs of each work")
    options = line.parse_args()
    model = re.search(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text())
    print(f"{model[1] if model else platform.machine()}, {os.cpu_count()} cores; {options.runs} runs, median (least to largest)")
    with Scratch() as scratch:
        todo = works(scratch, options.hours)
        ours, theirs, loops = {name: [] for name in todo}, {name: [] for name in todo}, {"arithmetic": [], "memory": []}
        for _ in range(options.runs):
            for name in loops:
                loops[name].append(used_s([TOOLS / "plain_loops", name]))
            for name, (command, env) in todo.items():
                if options.beside:
                    theirs[name].append(used_s([options.beside / "a351-correct", *command], env))
                ours[name].append(used_s([BIN / "a351-correct", *command], env))
        require_results(scratch, options.hours)

    print("plain loops: " + ", ".join(f"{name} {spread(times)} s" for name, times in loops.items()))
    print(f"{'work':<46}{'s of the processor':>22}{'/ arithmetic':>22}{'/ earlier program':>22}")
    slower, largest = [], 0.0
    for name, times in ours.items():
        ratios = [mine / other for mine, other in zip(times, theirs[name])]
        print(f"{name:<46}{spread(times):>22}{spread([mine / loop for mine, loop in zip(times, loops['arithmetic'])]):>22}"
              f"{spread(ratios) if ratios else '-':>22}")
        largest = max([largest, *(statistics.median(ratios) for _ in ratios[:1])])
        if ratios and statistics.median(ratios) > SLOWER:
            slower.append(f"{name}: {statistics.median(ratios):.2f} times as long as the earlier program")
    if options.beside:
        print(f"largest ratio to the earlier program: {largest:.2f}")
    end_with(slower)


if __name__ == "__main__":
    main()
