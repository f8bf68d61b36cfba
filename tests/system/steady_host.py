"""Runs a test that depends on real time, and repeats it once if it failed while the host paused.

    steady_host.py [--at-most SECONDS] COMMAND...

A host that stops for seconds lets a test of a correct program fail: viewers time out, counters wrap unnoticed.  A thread
sleeps 10 ms repeatedly and compares the clock.  The exit status is that of the command, with two exceptions:
  - The command failed and there was a pause: it is run once more, and the second result counts.
  - Both runs failed and both had a pause: 77, skipped, because the result is unknown.
A failure without a pause is never repeated.  Every pause is reported on stderr, also when the command succeeds.
--at-most limits the time of one run; a run that takes longer is killed and has failed.
"""

import contextlib
import ctypes
import datetime
import os
import pathlib
import signal
import subprocess
import sys
import threading
import time

SLEEP_S = 0.01
# Longest delay of the thread that is not a pause, in s: half of the shortest silence that a program here takes for a fault
# (0.5 s, after which a351d reports that the sensor stalls).  Ten tests and three compilers on two cores delay the thread by
# at most 0.05 s.
LONGEST_DELAY_S = 0.25
MOST_NAMED = 3
SKIPPED = 77
USAGE = 2
PR_SET_CHILD_SUBREAPER = 36  # <linux/prctl.h>


def say(text):
    print(f"steady_host: {text}", file=sys.stderr, flush=True)


def now_s():
    """Reads the clock that also runs while the machine is suspended."""
    return time.clock_gettime(time.CLOCK_BOOTTIME)


class Watch(threading.Thread):
    """Collects the pauses of the host until end() is called: length in s and UTC of the end of each."""

    def __init__(self):
        super().__init__(daemon=True)
        self.pauses, self.longest_s, self.is_over = [], 0.0, threading.Event()
        self.start()

    def run(self):
        while not self.is_over.is_set():
            before_s = now_s()
            time.sleep(SLEEP_S)
            self.note(now_s() - before_s - SLEEP_S)

    def note(self, seconds):
        self.longest_s = max(self.longest_s, seconds)
        if seconds > LONGEST_DELAY_S:
            self.pauses.append((seconds, datetime.datetime.now(datetime.timezone.utc)))

    def total_s(self):
        return sum(seconds for seconds, _ in self.pauses)

    def end(self):
        self.is_over.set()
        self.join()
        return self.pauses


def descendants(top):
    """Returns all processes started by `top` and by its descendants, in any session."""
    parents = {}
    for stat in pathlib.Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError):  # It has ended in the meantime.
            parents[int(stat.parent.name)] = int(stat.read_text(errors="replace").rsplit(")", 1)[1].split()[1])
    found, last = set(), {top}
    while last:
        last = {pid for pid, parent in parents.items() if parent in last} - found
        found |= last
    return found


def kill_the_rest():
    """Kills all processes that a run has left, so that the next run finds its ports and links free."""
    while left := descendants(os.getpid()):
        for pid in left:
            with contextlib.suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)
        with contextlib.suppress(ChildProcessError):
            os.waitpid(-1, 0)


def wait_for(child, watch):
    """Waits for the child, and for every process that the run leaves to this process.

    Time in which only the child was stopped counts as a pause too.
    @return status of the child
    """
    stopped_s = known_s = None
    while True:
        pid, status = os.waitpid(-1, os.WUNTRACED | os.WCONTINUED)
        if pid != child.pid:
            continue
        if os.WIFSTOPPED(status):
            stopped_s, known_s = now_s(), watch.total_s()
        elif not os.WIFCONTINUED(status):
            code = os.waitstatus_to_exitcode(status)
            return 128 - code if code < 0 else code  # The status that a shell gives for a process ended by a signal.
        elif stopped_s is not None:
            seconds, stopped_s = now_s() - stopped_s, None
            time.sleep(2 * SLEEP_S)  # After a pause of all processes the thread may be the last to wake.
            watch.note(seconds - (watch.total_s() - known_s))


def run(command, at_most_s):
    """Runs the command once and returns its status and the pauses.

    After a failure without a pause it reports the longest delay, which shows how busy the host was.
    """
    watch = Watch()
    try:
        child = subprocess.Popen(command)

        def end_late():
            say(f"the run is killed after {at_most_s:g} s, its time limit")
            with contextlib.suppress(ProcessLookupError):
                os.kill(child.pid, signal.SIGKILL)  # child.kill() would collect the status that wait_for() needs.

        if at_most_s:
            timer = threading.Timer(at_most_s, end_late)
            timer.daemon = True
            timer.start()
        status = wait_for(child, watch)
        if at_most_s:
            timer.cancel()
    finally:
        kill_the_rest()
    pauses = watch.end()
    if status not in (0, SKIPPED) and not pauses:
        print(f"longest delay of the host during the failed run: {1e3 * watch.longest_s:.0f} ms", flush=True)
    return status, pauses


def as_text(pauses):
    longest = sorted(pauses, reverse=True)
    named = ", ".join(f"{seconds:.1f} s until {end:%H:%M:%S} UTC" for seconds, end in longest[:MOST_NAMED])
    return f"the host paused for {named}" + (f" and {len(pauses) - MOST_NAMED} more times" if len(pauses) > MOST_NAMED else "")


def judge(command, at_most_s):
    """Runs the command once or twice and returns the status."""
    status, pauses = run(command, at_most_s)
    if not pauses:
        return status
    if status in (0, SKIPPED):
        say(f"{as_text(pauses)}; the run nevertheless ended with status {status}")
        return status
    say(f"{as_text(pauses)}; the run ended with status {status}, which does not count; it is repeated once")
    status, pauses = run(command, at_most_s)
    if status in (0, SKIPPED):
        say(f"the second run ended with status {status}" + (f", although {as_text(pauses)}" if pauses else ""))
        return status
    if not pauses:
        say(f"the second run ended with status {status} and the host did not pause: it counts")
        return status
    say(f"{as_text(pauses)}; the second run ended with status {status}, which does not count either")
    print("skipped: the result is unknown, because the host paused in both runs", flush=True)
    return SKIPPED


def main():
    arguments, at_most_s = sys.argv[1:], None
    if arguments[:1] == ["--at-most"] and len(arguments) > 1:
        at_most_s, arguments = float(arguments[1]), arguments[2:]
    if not arguments:
        print("usage: steady_host.py [--at-most SECONDS] COMMAND...", file=sys.stderr)
        return USAGE
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda number, _: sys.exit(128 + number))
    ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1)  # Processes that a test leaves become children of this one.
    return judge(arguments, at_most_s)


if __name__ == "__main__":
    sys.exit(main())
