"""The results depend on the input alone, not on threads, processes beside it, locale, time zone, truth files or the order of rows.

Threads: one core and seven threads; A351_LONG=1: also one and two threads on all cores.
"""

import random
import re
import shutil
import time

from programs import BIN, IS_LONG, IS_SANITIZED, TOOLS, TOP, Scratch, contents, demand, read_json, run, together

GOLDEN = TOP / "tests" / "golden" / "tsukuba"
FILES = {"occupations.csv", "stations.csv", "models.csv", "result.json", "stations.geojson", "gsadjust.csv",
         "report.html"}
RECORD_FILES = {"unit.toml", "result/record.csv", "result/response.csv", "result/result.json", "result/record.html",
                "result/figures/response.svg", "result/figures/modes.svg"}
# Not under sanitizers, because a sanitizer must be the first preloaded library.
THREADS = () if IS_SANITIZED else (1, 2, 7) if IS_LONG else (7,)


def foreign(scratch):
    """Returns an environment with another time zone and, if possible, a locale with a decimal comma."""
    environment = {"TZ": "Asia/Tokyo"}
    made = None
    if shutil.which("localedef"):
        made = run("localedef", "-i", "de_DE", "-f", "UTF-8", scratch / "de_DE.UTF-8", check=False)
    if (scratch / "de_DE.UTF-8").exists():
        environment |= {"LOCPATH": str(scratch), "LC_ALL": "de_DE.UTF-8"}
        point = run("locale", "decimal_point", env=environment).stdout.strip()
        demand(f"the foreign locale has a decimal comma: {point!r}", point == ",")
    else:
        print("the foreign locale is skipped, because none with a decimal comma can be made here:",
              made.stderr.strip() if made else "no localedef")
    return environment


def content(folder, promised=FILES):
    """Returns the bytes of every file in the folder; demands that the promised files are among them."""
    files = contents(folder)
    demand(f"{folder.name}: all promised files exist", promised <= set(files))
    return files


def without_checksums(files):
    """Removes the checksums of the input files, which differ if the order of their rows differs."""
    return {**files, "result.json": re.sub(rb'"crc32": \d+', b'"crc32": 0', files["result.json"]),
            "report.html": re.sub(rb">[0-9a-f]{8}<", b"><", files["report.html"])}


def demand_equal(title, first, second):
    different = sorted(name for name in first.keys() | second.keys() if first.get(name) != second.get(name))
    demand(f"{title}: {len(first)} files are byte for byte equal (different: {different or 'none'})", not different)


def shuffled(source, target, seed):
    lines = source.read_text().splitlines()
    body = lines[1:]
    random.Random(seed).shuffle(body)
    demand(f"{target.name}: the rows are in another order", body != lines[1:])
    target.write_text("\n".join([lines[0], *body]) + "\n")


with Scratch() as scratch:
    root = scratch / "day"
    run(BIN / "a351-sim", "survey", "--scenario", "tsukuba", "--seed", 11, "--out", root)
    again = scratch / "again"
    run(BIN / "a351-sim", "survey", "--scenario", "tsukuba", "--seed", 11, "--out", again,
        env={"TZ": "America/Lima"})
    result = run("diff", "-r", root, again, check=False)
    demand("the same seed writes the same journal, archive, events, tables and truth",
           result.returncode == 0)

    abroad = foreign(scratch)
    run(BIN / "a351-correct", "survey", root / "survey.toml", "--out", scratch / "first")
    run("sh", "-c", f"rm -f {root}/truth*")
    survey = BIN / "a351-correct", "survey", root / "survey.toml", "--out"
    together(lambda: run(*survey, scratch / "second", env=abroad), lambda: run("taskset", "1", *survey, scratch / "third"))
    first = content(scratch / "first")
    demand_equal("other locale and time zone, no truth files, beside another process", first, content(scratch / "second"))
    demand_equal("one core", first, content(scratch / "third"))
    model = read_json(scratch / "first" / "result.json")["model"]
    demand(f"{len(first)} files including figures, corrected by the model {model}",
           model == "day" and "figures/map.svg" in first)
    for cores in THREADS:
        out = scratch / f"threads-{cores}"
        run(BIN / "a351-correct", "survey", root / "survey.toml", "--out", out,
            env={"LD_PRELOAD": str(TOOLS / "libcore-count.so"), "A351_CORES": str(cores)})
        demand_equal(f"{cores} threads", first, content(out))

    # The same day from a table of occupations, with the rows of occupations and sites in order and shuffled.
    day = {"ordered": scratch / "ordered", "shuffled": scratch / "shuffled"}
    for folder in day.values():
        folder.mkdir()
        (folder / "data").symlink_to(root)
        (folder / "amendments.toml").write_text(
            '[[exclude]]\nsite = "No.2"\noccupation = 1\nreason = "unsteady"\n')
        (folder / "survey.toml").write_text(
            '[survey]\nname = "day"\nroot = "data"\nsites = "sites.csv"\noccupations = "occupations.csv"\n'
            'amendments = "amendments.toml"\nbase = "No.0"\n')
    # No.1 has no coordinates: the mean of the other sites, which is used instead, must not depend on their order.
    sites = re.sub(r"^No\.1,[^,]*,[^,]*,[^,]*,", "No.1,,,,", (GOLDEN / "sites.csv").read_text(), flags=re.M)
    (day["ordered"] / "sites.csv").write_text(sites)
    shutil.copy(root / "schedule.csv", day["ordered"] / "occupations.csv")
    for seed, name in enumerate(("sites.csv", "occupations.csv")):
        shuffled(day["ordered"] / name, day["shuffled"] / name, seed)
    for name, environment in (("ordered", {}), ("shuffled", abroad)):
        run(BIN / "a351-correct", "survey", day[name] / "survey.toml", env=environment)
    results = {name: without_checksums(content(folder / "result")) for name, folder in day.items()}
    demand_equal("rows of occupations and sites shuffled", results["ordered"], results["shuffled"])

    for name in ("sites.csv", "observations.csv"):
        shuffled(GOLDEN / name, scratch / name, 3)
    for name, folder, environment in (("table", GOLDEN, {}), ("table-shuffled", scratch, abroad)):
        for tide in ("given", "direct"):
            run(BIN / "a351-correct", "table", "--sites", folder / "sites.csv", "--observations",
                folder / "observations.csv", "--tide", tide, "--out", scratch / f"{name}-{tide}",
                "--figures", "pdf", "--figures", "png", env=environment)
        time.sleep(1.1)  # A PDF holds the second in which it was made, unless a351 removes it.
    pictures = list((scratch / "table-given" / "figures").glob("*.p[dn][fg]"))
    demand(f"the compared files include {len(pictures)} figures as PDF or PNG", pictures or not shutil.which("gnuplot"))
    for tide in ("given", "direct"):
        demand_equal(f"rows of observations and sites shuffled, tide {tide}",
                     *(without_checksums(content(scratch / f"{name}-{tide}"))
                       for name in ("table", "table-shuffled")))

    # A long record and the calibration from it.
    run(BIN / "a351-sim", "survey", "--scenario", "indoor", "--seed", 511, "--out", scratch / "night")

    def measured(name, *before, env=None):
        """Runs calibrate and record in a folder of that name and returns the bytes of their files."""
        folder = scratch / name
        folder.mkdir()
        run(*before, BIN / "a351-correct", "calibrate", scratch / "night", "--out", "unit.toml", env=env, cwd=folder)
        run(*before, BIN / "a351-correct", "record", scratch / "night", "--ensemble", 8, "--apply", "unit.toml", "--out",
            "result", env=env, cwd=folder)
        return content(folder, RECORD_FILES)

    here = measured("here")
    demand_equal("record and calibrate: other locale and time zone", here, measured("there", env=abroad))
    demand_equal("record and calibrate: one core", here, measured("one core", "taskset", "1"))
    for cores in THREADS:
        demand_equal(f"record and calibrate: {cores} threads", here, measured(
            f"{cores} cores", env={"LD_PRELOAD": str(TOOLS / "libcore-count.so"), "A351_CORES": str(cores)}))
