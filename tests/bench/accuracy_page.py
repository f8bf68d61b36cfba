"""Brings figures of corrector/accuracy.md up to date: runs the command of a section and writes what it prints into the section.

A section has a heading, sentences, lines `Command: ...`, and below each in a block the output of the bench without its lines for single days.
A run replaces line and block.
Date and commit are those of the run; the sources must be committed.
"""

import datetime
import os
import pathlib
import re
import shlex
import subprocess
import tempfile

from command_line import command_line

TOP = pathlib.Path(__file__).resolve().parents[2]
PAGE = TOP / "corrector/accuracy.md"
COMMAND = re.compile(r"^Command: `((?:python3 tests/bench|build/release/tests)/[^`]*)`[^\n]*\n(?:\n```\n.*?\n```\n)?", re.MULTILINE | re.DOTALL)
SINGLE_DAY = re.compile(r"\s*(seed |unit )?\d+(:| done)|holds: ")


def git(*arguments):
    return subprocess.run(["git", *arguments], cwd=TOP, capture_output=True, text=True, check=True).stdout.strip()


def output_of(command):
    """Runs a command, shows each line when it comes, and returns the lines."""
    print(f"$ {command}", flush=True)
    lines = []
    with tempfile.TemporaryFile("w+") as errors, subprocess.Popen(
            shlex.split(command), cwd=TOP, stdout=subprocess.PIPE, stderr=errors, text=True,
            env={**os.environ, "PYTHONUNBUFFERED": "1"}) as bench:
        for line in bench.stdout:
            print(line, end="", flush=True)
            lines.append(line.rstrip("\n"))
        bench.wait()
        errors.seek(0)
        failure = errors.read()
    if not lines or bench.returncode != (1 if lines[-1].startswith("NOT REACHED") else 0):
        raise SystemExit(f"{command} ended with {bench.returncode}: {failure[-400:]}")
    return lines


def measured(command, commit):
    """Returns the command line of a section with its date and commit, and below it the lines that are not of single days."""
    lines = [line for line in output_of(command) if not SINGLE_DAY.match(line)]
    return "\n".join([f"Command: `{command}`, {datetime.date.today()}, commit {commit}", "", "```", *lines, "```", ""])


line = command_line(__doc__, "accuracy_page.py 'Two set-ups'", has_promises=False)
line.add_argument("words", metavar="WORD", nargs="*",
                  help="only the sections whose headings contain one of the words; all of them take a night")
words = line.parse_args().words
headings = [heading for heading in re.findall(r"^## (.*)$", PAGE.read_text(), re.MULTILINE)
            if not words or any(word in heading for word in words)]
if not headings:
    line.error(f"{PAGE.name} has no heading with {' or '.join(words)}")
if changed := git("status", "--porcelain", "--", "corrector", "protocol", "sim", "tests/bench").replace("M corrector/accuracy.md", "").strip():
    raise SystemExit(f"commit first: {changed}")
commit = git("rev-parse", "--short=8", "HEAD")
for heading in headings:
    before, begin, section = PAGE.read_text().partition(f"## {heading}\n")
    for command in COMMAND.findall(section[:section.find("\n## ") + 1 or None]):
        now = measured(command, commit)
        text = PAGE.read_text()  # The run took long: others may have written.
        PAGE.write_text(COMMAND.sub(lambda found: now if found[1] == command else found[0], text))  # noqa: B023
        print(f"{heading}: written", flush=True)
