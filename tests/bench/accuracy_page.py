"""Brings figures of corrector/accuracy.md up to date: runs the command of a section and writes what it prints into the section.

usage: accuracy_page.py [WORD...]    (A351_BIN, A351_TOOLS)
Runs the commands of the sections whose headings contain one of the words; default: all, which takes a night.
A section has a heading, sentences, a line `Command: ...`, and in a block the output of the bench without its lines for single days.
A run replaces line and block.  A section with a table has figures of another program: it is left, and said.
Date and commit are those of the run; the sources must be committed.
"""

import datetime
import pathlib
import re
import shlex
import subprocess
import sys

TOP = pathlib.Path(__file__).resolve().parents[2]
PAGE = TOP / "corrector/accuracy.md"
COMMAND = re.compile(r"^Command: `(python3 tests/bench/[^`]*)`[^\n]*\n(?:\n```\n.*?\n```\n)?", re.MULTILINE | re.DOTALL)
SINGLE_DAY = re.compile(r"\s*(seed |unit )?\d+(:| done)|holds: ")


def git(*arguments):
    return subprocess.run(["git", *arguments], cwd=TOP, capture_output=True, text=True, check=True).stdout.strip()


def measured(command, commit):
    """Returns the command line of a section with its date and commit, and below it the lines that are not of single days."""
    done = subprocess.run(shlex.split(command), cwd=TOP, capture_output=True, text=True)
    lines = [line for line in done.stdout.splitlines() if not SINGLE_DAY.match(line)]
    # Status 1 is that of a promise that is not kept, and of a script that failed.
    if done.returncode not in (0, 1) or not lines or "Traceback" in done.stderr:
        raise SystemExit(f"{command} ended with {done.returncode}: {done.stderr[-400:]}")
    return "\n".join([f"Command: `{command}`, {datetime.date.today()}, commit {commit}", "", "```", *lines, "```", ""])


if changed := git("status", "--porcelain", "--", "corrector", "protocol", "sim", "tests/bench").replace("M corrector/accuracy.md", "").strip():
    raise SystemExit(f"commit first: {changed}")
commit = git("rev-parse", "--short=8", "HEAD")
for heading in re.findall(r"^## (.*)$", PAGE.read_text(), re.MULTILINE):
    if len(sys.argv) > 1 and not any(word in heading for word in sys.argv[1:]):
        continue
    before, begin, section = PAGE.read_text().partition(f"## {heading}\n")
    own = section[:section.find("\n## ") + 1 or None]
    if "\n| --- |" in own:
        print(f"{heading}: left, because it has a table")
    elif command := COMMAND.search(own):
        now = measured(command[1], commit)
        before, begin, section = PAGE.read_text().partition(f"## {heading}\n")  # The run took long: others may have written.
        PAGE.write_text(before + begin + COMMAND.sub(lambda _: now, section, count=1))
        print(f"{heading}: {command[1]}", flush=True)
