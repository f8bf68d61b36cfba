"""Files as other people bring them: each case of tests/golden/foreign/cases.toml has the result that it states."""

import pathlib
import shutil
import tomllib

from programs import BIN, Scratch, demand, rows, run

FOREIGN = pathlib.Path(__file__).resolve().parents[1] / "golden" / "foreign"


def stays_of(file):
    return "; ".join(f"{row['site']} {row['occupation']} {row['readings']}" for row in rows(file))


def check(case, top, day):
    folder = top / case["name"]
    folder.mkdir(exist_ok=True)
    if "day/" in case["run"]:
        shutil.rmtree(folder / "day", ignore_errors=True)
        shutil.copytree(day, folder / "day")
    result = run("sh", "-c", f"PATH={BIN}:$PATH; {case['run']}", check=False, cwd=folder)
    said = result.stdout + result.stderr
    title = f"{case['name']}, {case['run'].splitlines()[0]}"
    is_expected = result.returncode == case.get("status", 0)
    demand(f"{title}: status {result.returncode}" + ("" if is_expected else "\n" + said), is_expected)
    for part in case.get("says", []):
        demand(f"{title}: '{part}' is said", part in " ".join(said.split()) or part in said)
    for part in case.get("never", []):
        demand(f"{title}: '{part}' is not said", part not in said)
    if "stays" in case:
        stays = stays_of(folder / "x" / "observations.csv")
        demand(f"{title}: the stays are {stays}", stays == case["stays"])
    for file, parts in case.get("files", {}).items():
        text = (folder / file).read_text()
        for part in parts:
            demand(f"{title}: {file} has '{part}'", part in text)
    if "same" in case:
        one, other = (folder / file for file in case["same"])
        demand(f"{title}: {one.name} is that of the day as it was", one.read_bytes() == other.read_bytes())


with Scratch() as scratch:
    top, day = scratch / "foreign", scratch / "day"
    shutil.copytree(FOREIGN, top)
    run(BIN / "a351-sim", "survey", "--scenario", "ideal", "--out", day)
    run(BIN / "a351-correct", "survey", day / "survey.toml", "--out", day / "result")
    for case in tomllib.loads((FOREIGN / "cases.toml").read_text())["case"]:
        check(case, top, day)
