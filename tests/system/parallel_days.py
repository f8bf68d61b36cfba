"""Corrects many days as jobs of GNU parallel: the results must have the same bytes as when corrected one by one.

A351_LONG=1: 50 simulated days of the publication; otherwise 2 short ones.
"""

import pathlib
import shutil
import time

from programs import BIN, IS_LONG, Scratch, demand, run, short_day, skip

DAYS = 50 if IS_LONG else 2
JOBS = 2

if shutil.which("parallel") is None:
    skip("GNU parallel is not installed")


def contents(folder):
    return {file.relative_to(folder): file.read_bytes() for file in pathlib.Path(folder).rglob("*") if file.is_file()}


with Scratch() as scratch:
    (scratch / "short.toml").write_text(short_day())
    scenario = "tsukuba" if IS_LONG else scratch / "short.toml"
    days = [scratch / f"day{seed:02d}" for seed in range(1, DAYS + 1)]
    for seed, day in enumerate(days, 1):
        run(BIN / "a351-sim", "survey", "--scenario", scenario, "--seed", seed, "--out", day)
    began = time.monotonic()
    for day in days:
        run(BIN / "a351-correct", "survey", "survey.toml", "--out", "result", cwd=day)
    one_by_one_s = time.monotonic() - began
    began = time.monotonic()
    run("parallel", "--will-cite", "-j", JOBS, f"cd {{}} && {BIN / 'a351-correct'} survey survey.toml --out together", ":::", *days)
    together_s = time.monotonic() - began
    print(f"{DAYS} days: one by one {one_by_one_s:.1f} s, {JOBS} in parallel {together_s:.1f} s")
    differing = [day.name for day in days if contents(day / "result") != contents(day / "together")]
    demand(f"days with differences in their {len(contents(days[0] / 'result'))} files: {differing or 'none'}", not differing)
    tables = {(day / "together" / "occupations.csv").read_bytes() for day in days}
    demand("the results of the days differ from each other", len(tables) == DAYS)
