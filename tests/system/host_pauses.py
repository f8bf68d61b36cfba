"""Tests the repetition of tests after a pause of the host, with made-up scripts and a made-up case of Catch2."""

import os
import signal
import subprocess
import sys
import time

from programs import SKIPPED, TOOLS, TOP, Scratch, demand, unused_port
from stopped_host import stop

RUNNER = [sys.executable, str(TOP / "tests" / "system" / "steady_host.py")]
STOPPED_S = 1.0

# Counts its runs, leaves a process in another session that holds the port, and fails if it was delayed.  It runs for 3 s, so
# that on a busy host it is still running when it is stopped.
DELICATE = """import os, socket, sys, time
port, result_of_steady = int(sys.argv[1]), int(sys.argv[2])
held = socket.create_server(("127.0.0.1", port))
if os.fork() == 0:
    os.setsid()
    time.sleep(1000)
held.close()
open("runs", "a").write("run\\n")
for _ in range(300):
    before = time.monotonic()
    time.sleep(0.01)
    if time.monotonic() - before > 0.5:
        sys.exit(1)
sys.exit(result_of_steady)
"""
# Does not fail when it is delayed.
STURDY = """import time
open("runs", "a").write("run\\n")
time.sleep(3)
"""
HANGING = """import time
open("runs", "a").write("run\\n")
time.sleep(1000)
"""


def runs_in(scratch):
    file = scratch / "runs"
    return len(file.read_text().splitlines()) if file.exists() else 0


def play(command, script="", stopped_runs=(), stop_run=lambda runner: stop(runner.pid, STOPPED_S), **environment):
    """Runs a command with some of its runs stopped, as by a pause of the host.

    @param stopped_runs  numbers of the runs that are stopped
    @return status, number of runs, output
    """
    with Scratch() as scratch:
        (scratch / "test.py").write_text(script)
        runner = subprocess.Popen(command, cwd=scratch, env={**os.environ, **environment},
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        for number in stopped_runs:
            while runs_in(scratch) < number and runner.poll() is None:
                time.sleep(0.02)
            time.sleep(0.2)
            stop_run(runner)
        said = runner.communicate(timeout=60)[0]
        # Indented, because tests/run lists lines that begin with steady_host.
        print(*(f"  {line}" for line in said.splitlines()), sep="\n")
        return runner.returncode, runs_in(scratch), said


def play_script(script, *arguments, options=(), **how):
    return play([*RUNNER, *options, sys.executable, "test.py", *map(str, arguments)], script, **how)


def stop_script_alone(runner):
    children = open(f"/proc/{runner.pid}/task/{runner.pid}/children").read().split()
    os.kill(int(children[0]), signal.SIGSTOP)
    time.sleep(STOPPED_S)
    os.kill(int(children[0]), signal.SIGCONT)


KILLED = 128 + signal.SIGKILL
# What is tested; script and its result on a steady host; how it runs; status and number of runs; parts of what is said.
for claim, (script, *result), how, expected, parts in (
        ("a test that fails on a steady host fails at once", (DELICATE, 3), {}, (3, 1), ["longest delay of the host "]),
        ("a test that succeeds despite a pause runs once, and the pause is reported", (STURDY,), {"stopped_runs": [1]},
         (0, 1), ["paused for 1.", "nevertheless ended"]),
        ("a test that failed in a pause is repeated, finds its port free and passes; the pause is reported",
         (DELICATE, 0), {"stopped_runs": [1]}, (0, 2), ["paused for 1.", "is repeated once"]),
        ("a test that was stopped without its runner is repeated too", (DELICATE, 0),
         {"stopped_runs": [1], "stop_run": stop_script_alone}, (0, 2), ["paused for 1."]),
        ("a test whose repetition fails on a steady host fails", (DELICATE, 3), {"stopped_runs": [1]}, (3, 2),
         ["it counts"]),
        ("a test that fails in two runs with pauses is skipped", (DELICATE, 0), {"stopped_runs": [1, 2]}, (SKIPPED, 2),
         ["skipped: the result is unknown"]),
        ("a run that takes too long is killed and fails", (HANGING,), {"options": ["--at-most", "1.5"]}, (KILLED, 1), []),
        ("a run that takes too long in a pause is repeated, and its second failure counts", (HANGING,),
         {"stopped_runs": [1], "options": ["--at-most", "1.5"]}, (KILLED, 2), ["it counts"])):
    status, runs, said = play_script(script, *([unused_port(), *result] if result else []), **how)
    demand(claim, (status, runs) == expected and all(part in said for part in parts))
    # Each pause is reported once, although both the script and its runner see it.
    demand("each pause is reported once",
           said.count(" UTC") == said.count("paused for 1.") == len(how.get("stopped_runs", ())))
status, runs, said = play_script(DELICATE, unused_port(), 0)
demand("a test that succeeds on a steady host runs once, and nothing is printed", (status, runs, said) == (0, 1, ""))

CASE = [TOOLS / "core_test", "[host_pauses]"]
for name, how, expected in (("succeeds on a steady host", {}, (0, 1)),
                            ("fails on a steady host", {"A351_MADE_UP_FAILURE": "1"}, (1, 1)),
                            ("failed in a pause", {"stopped_runs": [1]}, (0, 2)),
                            ("failed in a pause and fails again", {"stopped_runs": [1], "A351_MADE_UP_FAILURE": "1"}, (1, 2)),
                            ("failed in two pauses", {"stopped_runs": [1, 2]}, (1, 2))):
    status, runs, said = play(CASE, **how)
    demand(f"a case of Catch2 that {name} ends with {status} after {runs} runs, expected {expected}",
           (status, runs) == expected and said.count("paused for 1.") == len(how.get("stopped_runs", ())))
