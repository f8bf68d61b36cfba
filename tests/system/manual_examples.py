"""Every command in the EXAMPLES of a program's manual pages runs as written and writes the files that it names.

usage: manual_examples.py a351-correct | a351-sim

An example that ends in ` &` serves a link until SIGTERM.
"""

import re
import shlex
import shutil
import signal
import subprocess
import sys
import time

from programs import BIN, TOP, Scratch, demand, os, run

# Subcommands whose results the examples of other pages read.
FIRST = ("calibrate", "record", "export")
SITES = ("No.0", "No.12", "No.1", "No.2", "No.4", "No.0")
LONGEST_START_S = 10


def short_day():
    """Returns a scenario with six occupations of the tsukuba day, 40 minutes apart: enough for the whole-day model."""
    text = 'base = "tsukuba"\nname = "short"\n[schedule]\nlead_in_h = 2.5\n'
    for k, site in enumerate(SITES):
        minutes = 23 * 60 + 40 + 40 * k
        text += (f'[[occupation]]\nsite = "{site}"\nnumber = {SITES[:k + 1].count(site)}\nambient_degc = {27.0 + 0.3 * k}\n'
                 f'centre_utc = "2017-07-{15 + minutes // 1440}T{minutes // 60 % 24:02}:{minutes % 60:02}:00Z"\n')
    return text


def prepare_correct(scratch):
    """Makes the input files that the examples of a351-correct expect from the user."""
    (scratch / "short.toml").write_text(short_day())
    for scenario, root in (("short.toml", "data"), ("indoor", "night"), ("tilt-series", "tilt-series")):
        run(BIN / "a351-sim", "survey", "--scenario", scenario, "--out", root, cwd=scratch)
    for table in ("sites.csv", "observations.csv"):
        shutil.copy(TOP / "tests" / "golden" / "tsukuba" / table, scratch)
    survey = (TOP / "config" / "survey.toml").read_text()
    for name in ("day", "monday", "tuesday"):
        (scratch / f"{name}.toml").write_text(survey.replace('name = "tsukuba"', f'name = "{name}"'))


def prepare_sim(scratch):
    shutil.copy(TOP / "config" / "faults" / "example.toml", scratch)
    run(BIN / "a351-sim", "survey", "--scenario", "indoor", "--out", "data", cwd=scratch)


def examples(page):
    """Returns the commands between .nf and .fi, each on one line, as a reader of the page sees them."""
    section = page.read_text().split("\n.SH EXAMPLES\n")[1].split("\n.SH ")[0]
    shown = "\n".join(re.findall(r"^\.nf\n(.*?)^\.fi$", section, re.M | re.S))
    shown = re.sub(r"\\([-e])", lambda escape: {"-": "-", "e": "\\"}[escape[1]], shown).replace("\\\n", " ")
    return [line for line in shown.splitlines() if line.strip()]


def outputs(command):
    """Returns the paths after --out, --output and --report and after `>`, relative to the directory of the command."""
    words = shlex.split(command)
    named = [after for word, after in zip(words, words[1:]) if word in ("--out", "--output", "--report")]
    return named + re.findall(r">(\S+)", command)


def start(command, scratch, environment):
    """Starts an example that serves a link, and waits for the link."""
    process = subprocess.Popen(["bash", "-c", "exec " + command.removesuffix(" &")], cwd=scratch, env=environment)
    words = shlex.split(command)
    link = scratch / words[words.index("--link") + 1]
    since = time.monotonic()
    while not link.is_symlink() and process.poll() is None and time.monotonic() - since < LONGEST_START_S:
        time.sleep(0.05)
    demand(f"{command}: serves its link", link.is_symlink() and process.poll() is None)
    return process


def run_to_end(command, scratch, environment):
    written = [scratch / name for name in outputs(command)]
    for path in written:  # An earlier example may have written it.
        shutil.rmtree(path) if path.is_dir() else path.unlink(missing_ok=True)
    result = subprocess.run(["bash", "-c", command], cwd=scratch, env=environment, capture_output=True, text=True)
    print(result.stderr, end="")
    demand(" ".join(command.split()), result.returncode == 0 and (written or result.stdout))


def try_page(page, program, scratch, environment):
    commands = examples(page)
    own = page.stem.replace(program + "-", program + " ") + " "
    demand(f"{page.name} has {len(commands)} examples, all of its own command or of printf",
           commands and all(command.startswith((own, "printf ")) for command in commands))
    servers = []
    for command in commands:
        if command.endswith(" &"):
            servers.append(start(command, scratch, environment))
        else:
            run_to_end(command, scratch, environment)
    for server in servers:
        server.send_signal(signal.SIGTERM)
        demand(f"{server.args[-1]}: ends after SIGTERM with status 0", server.wait(timeout=30) == 0)
    for path in [scratch / name for command in commands for name in outputs(command)]:
        demand(f"  {page.name}: {path.name} is written", path.is_file() or (path.is_dir() and any(path.iterdir())))


program = sys.argv[1]
folder, prepare = {"a351-correct": ("corrector", prepare_correct), "a351-sim": ("sim", prepare_sim)}[program]
commands_folder = TOP / folder / "command"
pages = [commands_folder / f"a351-correct-{command}.1" for command in FIRST if program == "a351-correct"]
pages += sorted(set(commands_folder.glob(f"{program}-*.1")) - set(pages)) + [TOP / folder / f"{program}.1"]
with Scratch() as scratch:
    prepare(scratch)
    for page in pages:
        try_page(page, program, scratch, {**os.environ, "PATH": f"{BIN}:{os.environ['PATH']}"})
