"""The correction is a function of its input alone: not of threads, locale, time zone or truth files."""

import filecmp

from programs import BIN, Scratch, demand, run

with Scratch() as scratch:
    root = scratch / "day"
    run(BIN / "a351-sim", "survey", "--scenario", "tsukuba", "--seed", 11, "--out", root)
    again = scratch / "again"
    run(BIN / "a351-sim", "survey", "--scenario", "tsukuba", "--seed", 11, "--out", again,
        env={"TZ": "America/Lima"})
    result = run("diff", "-r", root, again, check=False)
    demand("the same seed writes the same journal, archive, events, tables and truth",
           result.returncode == 0)

    run(BIN / "a351-correct", "survey", root / "survey.toml", "--out", scratch / "first")
    run("sh", "-c", f"rm -f {root}/truth*")
    run("localedef", "-i", "de_DE", "-f", "UTF-8", scratch / "de_DE.UTF-8")
    run(BIN / "a351-correct", "survey", root / "survey.toml", "--out", scratch / "second",
        env={"TZ": "Asia/Tokyo", "LOCPATH": str(scratch), "LC_ALL": "de_DE.UTF-8"})
    run("taskset", "1", BIN / "a351-correct", "survey", root / "survey.toml", "--out",
        scratch / "third")
    names = ["occupations.csv", "stations.csv", "models.csv", "result.json"]
    for other in ("second", "third"):
        same, different, missing = filecmp.cmpfiles(scratch / "first", scratch / other, names,
                                                    shallow=False)
        demand(f"{other} run: {', '.join(same)} equal to the byte", sorted(same) == sorted(names))
