"""The figures of a day, a table and a record in print, by poppler: width as asked, letters of 6.5 to 10 pt, fonts embedded, no two
texts on each other, none turned or outside.

The short form draws each language in one width, and no figure of several days.
"""

import itertools
import re
import shutil
import xml.etree.ElementTree

from programs import BIN, IS_LONG, TOP, Scratch, demand, rows, run, skip

GOLDEN = TOP / "tests" / "golden" / "tsukuba"
PT_PER_MM = 72 / 25.4
ALLOWED_PT = (6.5, 10.0)
SUPERSCRIPTS = re.compile("[⁰¹²³⁴-⁹⁻]+")
# The box of a word has room above capitals and below the baseline, in shares of its height.
ABOVE, BELOW = 0.15, 0.12


def words(pdf):
    """Returns the page's width and height and the words as (text, left, top, right, bottom), pt."""
    page = xml.etree.ElementTree.fromstring(run("pdftotext", "-bbox", pdf, "-").stdout)
    page = next(page.iter("{http://www.w3.org/1999/xhtml}page"))
    boxes = []
    for word in page:
        left, top, right, bottom = (float(word.get(key)) for key in ("xMin", "yMin", "xMax", "yMax"))
        height = bottom - top
        boxes.append((word.text, left, top + ABOVE * height, right, bottom - BELOW * height))
    return float(page.get("width")), float(page.get("height")), boxes


def letters_pt(pdf):
    """Returns the sizes of the letters, pt."""
    zoom = 3  # the greatest that poppler takes; sizes are whole numbers
    layout = run("pdftohtml", "-xml", "-i", "-zoom", zoom, "-stdout", pdf).stdout
    return [int(size) / zoom for size in re.findall(r'<fontspec [^>]*size="(\d+)"', layout)]


def faults(pdf, width_mm):
    width, height, boxes = words(pdf)
    if abs(width / PT_PER_MM - width_mm) > 0.5:
        yield f"{width / PT_PER_MM:.1f} mm wide"
    fonts = run("pdffonts", pdf).stdout.splitlines()[2:]
    if not fonts or any(line.split()[-5] != "yes" for line in fonts):
        yield "a font is not embedded"
    for size in letters_pt(pdf):
        if not ALLOWED_PT[0] <= size <= ALLOWED_PT[1]:
            yield f"letters of {size:.1f} pt"
    for text, left, top, right, bottom in boxes:
        if left < 0 or top < 0 or right > width or bottom > height:
            yield f"{text!r} is outside"
        if len(text) > 2 and bottom - top > right - left:
            yield f"{text!r} is turned"
    for one, other in itertools.combinations(boxes, 2):
        if SUPERSCRIPTS.fullmatch(one[0]) or SUPERSCRIPTS.fullmatch(other[0]):
            continue
        if one[1] < other[3] and other[1] < one[3] and one[2] < other[4] and other[2] < one[4]:
            yield f"{one[0]!r} and {other[0]!r} touch"


def draw(scratch, language, width_mm):
    folder = scratch / f"{language}-{width_mm}"
    both_days = [("joint", "survey", scratch / "day" / "survey.toml", scratch / "other" / "survey.toml")] if IS_LONG else []
    options = ("--figures", "pdf", "--figure-width", f"{width_mm}mm", "--out")
    for name, *arguments in (("day", "survey", scratch / "day" / "survey.toml"), ("night", "record", scratch / "night"),
                             ("tilt", "record", scratch / "night", "--quantity", "tilt-y"),
                             ("table", "table", "--sites", GOLDEN / "sites.csv", "--observations", GOLDEN / "observations.csv",
                              "--model", "paper"),
                             ("plan", "design", scratch / "plan.csv", "--sites", scratch / "unknown.csv"),
                             *both_days):
        run(BIN / "a351-correct", *arguments, *options, folder / name, env={"A351_LANG": language})
    pictures = sorted(folder.glob("*/figures/*.pdf"))
    scripts = sorted(folder.glob("*/figures/*.gp"))
    demand(f"{language}, {width_mm} mm: each of the {len(scripts)} figures has a script, data or those of others, SVG and PDF",
           len(pictures) == len(scripts) >= 40 and all(script.with_suffix(".svg").exists() for script in scripts))
    demand(f"{language}, {width_mm} mm: no mark has the scale zero, which viewers of SVG refuse",
           not any("scale(0.00)" in pdf.with_suffix(".svg").read_text() for pdf in pictures))
    found = [f"{pdf.parent.parent.name}/{pdf.stem}: {fault}" for pdf in pictures for fault in faults(pdf, width_mm)]
    print(*found[:20], sep="\n")
    demand(f"{language}, {width_mm} mm: width, fonts, letters and places are as a journal wants them", not found)


if not shutil.which("pdftotext"):
    skip("no pdftotext (Debian: poppler-utils)")
with Scratch() as scratch:
    run(BIN / "a351-sim", "survey", "--scenario", "tsukuba", "--seed", 7, "--out", scratch / "day")
    if IS_LONG:
        run(BIN / "a351-sim", "survey", "--scenario", "tsukuba", "--seed", 8, "--out", scratch / "other")
    run(BIN / "a351-sim", "survey", "--scenario", "indoor", "--seed", 7, "--out", scratch / "night")
    visits = [row["site"] for row in rows(GOLDEN / "observations.csv")]
    (scratch / "plan.csv").write_text("site,start_utc,set_ups,minutes_each\n" + "".join(
        f"{site},2026-05-01T{k // 2:02}:{30 * (k % 2):02}:00Z,1,12\n" for k, site in enumerate(visits)))
    sites = (GOLDEN / "sites.csv").read_text().splitlines()
    (scratch / "unknown.csv").write_text("\n".join(sites[:2] + [line.rpartition(",")[0] + "," for line in sites[2:]]) + "\n")
    for language, width_mm in itertools.product(("en", "ja"), (84, 170)):
        if language == "ja" and not run("fc-list", ":lang=ja").stdout:
            skip("the figures in Japanese need a font (Debian: fonts-noto-cjk)")
        if IS_LONG or (language == "en") == (width_mm == 84):
            draw(scratch, language, width_mm)
