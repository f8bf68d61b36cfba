"""Each bench answers --help with purpose, example and exit status, and the commands in documents and helps are accepted."""

import contextlib
import io
import re
import runpy
import shlex
import sys

from programs import TOP, demand

BENCH = TOP / "tests/bench"
LIBRARIES = [folder for folder in sys.path if str(TOP) not in folder]
MODULES = {"command_line.py", "simulated_units.py"}  # not programs
PARTS = ("usage: ", "environment: ", "exit status: ", "example: ")
OTHERS = re.compile(r"No module named '(numpy|scipy|PyEMD|obspy)")  # not packages of the tests
COMMAND = re.compile(r"python3 (tests/bench/\S+\.py[^`\n]*)")


def help_of(words):
    """Runs a bench with these arguments and --help, which is read after them; returns status and output."""
    sys.argv, sys.path[:] = [*words, "--help"], [str(BENCH), *LIBRARIES]
    for name in [name for name, module in sys.modules.items() if str(TOP) in str(getattr(module, "__file__", "")) and name != "__main__"]:
        del sys.modules[name]  # Each bench finds its modules itself.
    said, failure, status = io.StringIO(), io.StringIO(), "no end at --help"
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(failure):
        try:
            runpy.run_path(str(TOP / words[0]), run_name="__main__")
        except SystemExit as end:
            status = end.code
        except ImportError as missing:
            print(missing, file=sys.stderr)
    return status, said.getvalue(), failure.getvalue().strip().splitlines()


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
found = {script: looked_at(script) for script in scripts}
for script, (_, missing) in found.items():
    if missing:
        print(f"{script} is not tested: {missing}")
wrong = {script: faults for script, (faults, _) in found.items() if faults}
demand(f"{len(found)} benches answer --help and accept their example; wrong: {wrong or 'none'}", len(found) > 20 and not wrong)
wrong = wrong_commands(TOP / "corrector/accuracy.md")
demand(f"the benches accept the commands of accuracy.md; wrong: {wrong or 'none'}", not wrong)
