"""Stops all processes of a running system test for 15 s, as in a pause of the host.

The test must pass and the pause must be reported.

    stopped_host.py [SECONDS-INTO-THE-RUN SCRIPT [ARGUMENTS...]]

Without arguments: faults.py, which once failed in a pause of 15.7 s, and sim/demo; takes some minutes.
"""

import contextlib
import os
import pathlib
import re
import signal
import subprocess
import sys
import time

from programs import BIN, TOP, Scratch, demand
from steady_host import descendants

SYSTEM = TOP / "tests" / "system"
STOPPED_S = 15.0
DEMO_AT_S = 20


def stop(top, seconds):
    """Stops a process and all processes that it has started, in any session, for these seconds."""
    seen, stopped = set(), []
    while left := (descendants(top) | {top}) - seen:
        for pid in sorted(left, key=lambda pid: pid != top):  # A stopped parent starts no further processes.
            seen.add(pid)
            with contextlib.suppress(ProcessLookupError, FileNotFoundError):  # It has ended in the meantime.
                if state(pid) != "T":  # Processes that the test itself has stopped stay stopped.
                    os.kill(pid, signal.SIGSTOP)
                    stopped.append(pid)
    time.sleep(seconds)
    for pid in stopped:
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, signal.SIGCONT)


def state(pid):
    """Returns the state of a process, one letter: proc(5), field 3 of stat."""
    return pathlib.Path(f"/proc/{pid}/stat").read_text(errors="replace").rsplit(")", 1)[1].split()[0]


def play(at_s, name, command):
    begin = time.monotonic()
    with Scratch() as scratch, open(scratch / "said", "w+") as said:
        process = subprocess.Popen(command, cwd=scratch, stdout=said, stderr=subprocess.STDOUT,
                                   env={**os.environ, "A351_BIN": str(BIN)})
        time.sleep(at_s)
        demand(f"{name} is still running after {at_s} s", process.poll() is None)
        stop(process.pid, STOPPED_S)
        status = process.wait()
        said.seek(0)
        text = said.read()
    named = [line for line in text.splitlines() if re.match("steady_host: |sim/demo: the host", line)]
    print(f"{name}: ended with {status} after {time.monotonic() - begin:.0f} s", *named, sep="\n  ", flush=True)
    if status != 0:
        print(text[-4000:])
    demand(f"{name}: stopped for {STOPPED_S:g} s after {at_s} s it passes, and the pause is reported",
           status == 0 and any(re.search(r"paused for 1[56]\.", line) for line in named))


def play_test(at_s, script, *arguments):
    play(at_s, script, [sys.executable, SYSTEM / "steady_host.py", sys.executable, SYSTEM / script, *arguments])


def main():
    if len(sys.argv) > 2:
        play_test(float(sys.argv[1]), *sys.argv[2:])
        return
    play_test(8, "faults.py")  # In the middle of its run.
    play(DEMO_AT_S, "sim/demo", [TOP / "sim" / "demo", "--out", "day"])


if __name__ == "__main__":
    main()
