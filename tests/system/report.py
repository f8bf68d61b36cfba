"""The report of a simulated day: well-formed, complete in one file with all figures, and readable without gnuplot."""

import collections
import json
import os
import re
import time
import xml.etree.ElementTree

from programs import BIN, Scratch, demand, rows, run

XLINK = "{http://www.w3.org/1999/xlink}href"
SVG = "{http://www.w3.org/2000/svg}"


def parse(file):
    return xml.etree.ElementTree.parse(file).getroot()


def drawn(file):
    """Returns the paths, marks and words of a figure; the groups around them also depend on earlier figures of gnuplot."""
    return re.findall(r"<path[^>]*>|<use[^>]*>|<text>.*?</text>", file.read_text())


with Scratch() as scratch:
    run(BIN / "a351-sim", "survey", "--scenario", "tsukuba", "--seed", 3, "--out", scratch / "day")
    began = time.monotonic()
    said = run(BIN / "a351-correct", "survey", scratch / "day" / "survey.toml", "--out", scratch / "out")
    print(f"tables and report of a day of 19 readings took {time.monotonic() - began:.1f} s")
    lines = said.stdout.splitlines()
    demand(f"the terminal has {len(lines)} lines, at most 40, of {max(map(len, lines))} columns, at most 120",
           len(lines) <= 40 and max(map(len, lines)) <= 120)
    demand("the first line says how well the stations are known", lines[0].startswith("14 stations; a new one is known to +- "))
    verbose = run(BIN / "a351-correct", "survey", scratch / "day" / "survey.toml", "--out", scratch / "out", "--verbose").stdout
    demand("with --verbose the models and coefficients follow", verbose.startswith("\n".join(lines[:-2])) and
           "t-rate-drift" in verbose and "fast_lag_s" in verbose)

    page = parse(scratch / "out" / "report.html")
    text = (scratch / "out" / "report.html").read_text()
    elements = list(page.iter())
    print(f"report.html: {len(text)} bytes, {len(elements)} elements")
    pictures = [element for element in elements if element.tag == SVG + "svg"]
    scripts = sorted(file.stem for file in (scratch / "out" / "figures").glob("*.gp"))
    demand(f"{len(pictures)} figures are in the report, one for each script (19 readings, 9 others)",
           len(pictures) == len(scripts) == 28)
    ids = collections.Counter(element.get("id") for element in elements if element.get("id"))
    demand(f"the {len(ids)} ids are unique", max(ids.values()) == 1)
    wanted = {element.get(XLINK) for element in elements if element.get(XLINK)}
    demand("every reference within the report has its target", all(name[1:] in ids for name in wanted))
    demand("the report loads nothing from elsewhere and has no scripts",
           not re.search(r"<script|src=|url\(h|@import|<link|href=\"[^#]", text))
    demand("the report contains no path of this machine", str(scratch) not in text)
    demand("its figures, scripts and data contain no path of this machine",
           all(str(scratch) not in file.read_text() for file in (scratch / "out" / "figures").iterdir()))

    table = rows(scratch / "out" / "occupations.csv")
    answer = text.split("<h2")[0]
    doubtful = {f"{row['site']} ({row['occupation']}), {row['grade']}: " for row in table if row["grade"] != "trust"}
    demand(f"before its first section the report names the {len(doubtful)} readings that are not to be trusted, with their grade",
           all(answer.count(name) == 1 for name in doubtful) and answer.count(", care: ") + answer.count(", repeat: ") == len(doubtful))
    demand("the map is before the first section", answer.count("<svg") == 1)
    order = ["trust", "care", "repeat"]
    best = {row["site"]: min((other["grade"] for other in table if other["site"] == row["site"]), key=order.index) for row in table}
    stations = json.loads((scratch / "out" / "stations.geojson").read_text())["features"]
    demand("stations.geojson gives each station the best grade of its readings",
           {station["properties"]["site"]: station["properties"]["grade"] for station in stations} == best)
    result = json.loads((scratch / "out" / "result.json").read_text())
    validated = {name: value for name, value in result["cross_validated"].items()
                 if name in ("loo_mgal", "loso_mgal") and value is not None}
    demand(f"the model {result['model']} is cross-validated", "loso_mgal" in validated)
    for name, value in validated.items():
        demand(f"{name} of result.json is in the report", f">{value:.2f}<" in text)
    demand("every input's checksum is in the report",
           all(f">{entry['crc32']:08x}<" in text for entry in result["inputs"]))

    # Draws the figures again from scripts and data alone, as an author of a paper would.
    again = scratch / "again"
    run("cp", "-r", scratch / "out" / "figures", again)
    for name in scripts:
        before = drawn(again / f"{name}.svg")
        (again / f"{name}.svg").unlink()
        run("gnuplot", f"{name}.gp", cwd=again)
        demand(f"{name}.gp alone draws the same {len(before)} strokes, marks and words",
               len(before) > 20 and drawn(again / f"{name}.svg") == before)

    empty = scratch / "empty"
    empty.mkdir()
    said = run(BIN / "a351-correct", "survey", scratch / "day" / "survey.toml", "--out", scratch / "bare",
               env={"PATH": str(empty)})
    demand("without gnuplot stderr says once that figures are missing", said.stderr.count("figures are missing") == 1)
    demand("without gnuplot the report says that figures are missing", "figures are missing: gnuplot is not installed" in
           (scratch / "bare" / "report.html").read_text())
    parse(scratch / "bare" / "report.html")
    for name in os.listdir(scratch / "out"):
        if name not in ("report.html", "figures"):
            demand(f"{name} is the same as with gnuplot",
                   (scratch / "bare" / name).read_bytes() == (scratch / "out" / name).read_bytes())
