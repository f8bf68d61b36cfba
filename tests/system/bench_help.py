"""Each bench answers --help with purpose, example and exit status, and the commands in documents and helps are accepted."""

import concurrent.futures
import os
import re
import shlex
import subprocess
import sys

from programs import TOP, demand

BENCH = TOP / "tests/bench"
MODULES = {"command_line.py", "simulated_units.py"}  # not programs
PARTS = ("usage: ", "environment: ", "exit status: ", "example: ")
OTHERS = re.compile(r"No module named '(numpy|scipy|PyEMD|obspy)")  # not packages of the tests
COMMAND = re.compile(r"python3 (tests/bench/\S+\.py[^`\n]*)")


def help_of(words):
    """Runs a bench with these arguments and --help, which is read after them; returns status and output."""
    done = subprocess.run([sys.executable, TOP / words[0], *words[1:], "--help"], capture_output=True, text=True)
    return done.returncode, done.stdout, done.stderr.strip().splitlines()


def looked_at(script):
    """Returns what is wrong with a script, and whether a module that it needs is missing here."""
    status, text, failure = help_of([script])
    if failure and OTHERS.search(failure[-1]):
        return [], failure[-1]
    wrong = [f"--help ended with {status} {' '.join(failure[-1:])}"] if status else [part for part in PARTS if part not in text]
    if commands := COMMAND.findall(text):
        wrong += [f"its example: {' '.join(failure[-1:])}" for status, _, failure in [help_of(shlex.split(commands[0]))] if status]
    return wrong, None


def wrong_commands(page):
    """Returns the commands of a document that name no script, or arguments that it refuses."""
    commands = COMMAND.findall(page.read_text())
    print(f"{page.relative_to(TOP)}: {len(commands)} commands")
    return [f"{command}: {' '.join(failure[-1:])}" for command in commands for status, _, failure in [help_of(shlex.split(command))]
            if status and not OTHERS.search(" ".join(failure))]


scripts = sorted(f"tests/bench/{file.name}" for file in BENCH.glob("*.py") if file.name not in MODULES)
with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    found = dict(zip(scripts, pool.map(looked_at, scripts)))
for script, (_, missing) in found.items():
    if missing:
        print(f"{script} is not tested: {missing}")
wrong = {script: faults for script, (faults, _) in found.items() if faults}
demand(f"{len(found)} benches answer --help and accept their example; wrong: {wrong or 'none'}", len(found) > 20 and not wrong)
wrong = wrong_commands(TOP / "corrector/accuracy.md")
demand(f"the benches accept the commands of accuracy.md; wrong: {wrong or 'none'}", not wrong)
