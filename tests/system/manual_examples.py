"""Every command in the EXAMPLES of the a351-correct manual pages runs as written and writes the files named by --out."""

import re
import shlex
import shutil
import subprocess

from programs import BIN, TOP, Scratch, demand, os, run

COMMANDS = TOP / "corrector" / "command"
# Subcommands whose results the examples of other pages read.
FIRST = ("calibrate", "record", "export")
SITES = ("No.0", "No.12", "No.1", "No.2", "No.4", "No.0")


def short_day():
    """Returns a scenario with six occupations of the tsukuba day, 40 minutes apart: enough for the whole-day model."""
    text = 'base = "tsukuba"\nname = "short"\n[schedule]\nlead_in_h = 2.5\n'
    for k, site in enumerate(SITES):
        minutes = 23 * 60 + 40 + 40 * k
        text += (f'[[occupation]]\nsite = "{site}"\nnumber = {SITES[:k + 1].count(site)}\nambient_degc = {27.0 + 0.3 * k}\n'
                 f'centre_utc = "2017-07-{15 + minutes // 1440}T{minutes // 60 % 24:02}:{minutes % 60:02}:00Z"\n')
    return text


def prepare(scratch):
    """Makes the input files that the examples expect from the user."""
    (scratch / "short.toml").write_text(short_day())
    for scenario, root in (("short.toml", "data"), ("indoor", "night"), ("tilt-series", "tilt-series")):
        run(BIN / "a351-sim", "survey", "--scenario", scenario, "--out", root, cwd=scratch)
    for table in ("sites.csv", "observations.csv"):
        shutil.copy(TOP / "tests" / "golden" / "tsukuba" / table, scratch)
    survey = (TOP / "config" / "survey.toml").read_text()
    for name in ("day", "monday", "tuesday"):
        (scratch / f"{name}.toml").write_text(survey.replace('name = "tsukuba"', f'name = "{name}"'))


def examples(page):
    """Returns the commands between .nf and .fi, each on one line, as a reader of the page sees them."""
    section = page.read_text().split("\n.SH EXAMPLES\n")[1].split("\n.SH ")[0]
    shown = "\n".join(re.findall(r"^\.nf\n(.*?)^\.fi$", section, re.M | re.S))
    shown = shown.replace("\\-", "-").replace("\\e", "\\").replace("\\\n", " ")
    return [line for line in shown.splitlines() if line.strip()]


def outputs(command):
    """Returns the paths after --out and --output, relative to the directory in which the command runs."""
    words = shlex.split(command)
    return [after for word, after in zip(words, words[1:]) if word in ("--out", "--output")]


pages = [COMMANDS / f"a351-correct-{command}.1" for command in FIRST]
pages += sorted(set(COMMANDS.glob("a351-correct-*.1")) - set(pages)) + [TOP / "corrector" / "a351-correct.1"]
environment = {**os.environ, "PATH": f"{BIN}:{os.environ['PATH']}"}
with Scratch() as scratch:
    prepare(scratch)
    for page in pages:
        commands = examples(page)
        demand(f"{page.name} has {len(commands)} examples, all of its own command", commands and all(
            command.startswith(page.stem.replace("a351-correct-", "a351-correct ") + " ") for command in commands))
        for command in commands:
            written = [scratch / name for name in outputs(command)]
            for path in written:  # An earlier example may have written it.
                shutil.rmtree(path) if path.is_dir() else path.unlink(missing_ok=True)
            result = subprocess.run(["bash", "-c", command], cwd=scratch, env=environment, capture_output=True, text=True)
            print(result.stderr, end="")
            demand(" ".join(command.split()), result.returncode == 0 and (written or result.stdout))
            for path in written:
                demand(f"  writes {path.name}", path.is_file() or (path.is_dir() and any(path.iterdir())))
