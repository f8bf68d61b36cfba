"""Disk faults under the unmodified daemon at 5x: at the end the archive must hold every sample that the emulator sent.

    disk_faults.py full        a small disk, filled up and emptied
    disk_faults.py failing     system calls of the running daemon fail or stall
"""

import contextlib
import datetime
import os
import shutil
import signal
import socket
import subprocess
import sys
import time

import small_disk
from programs import BIN, Scratch, compare_truth, daemon_config, daemon_status, demand, run, skip, together, unused_port
from small_disk import RESERVE

SPEED = 5  # Low, because strace stops the daemon twice in every system call.


class Day:
    """Emulator and daemon running together."""

    def __init__(self, scratch):
        self.scratch = scratch
        self.port = unused_port()
        (scratch / "a351d.toml").write_text(daemon_config(self.port))
        plan = run(BIN / "a351-sim", "plan", "--scenario", "tsukuba", "--out", scratch)
        start = dict(part.split("=", 1) for part in plan.stdout.split())["start_utc"]
        host = datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%S.%fZ")
        clock = f"scaled:{SPEED}@{start},{host}"
        self.sim = subprocess.Popen(
            [BIN / "a351-sim", "device", "--link", "sensor", "--scenario", "tsukuba", "--clock", clock,
             "--control", "control", "--truth", "truth.bin"], cwd=scratch, stderr=subprocess.DEVNULL)
        with open(scratch / "a351d.log", "w") as log:
            self.daemon = subprocess.Popen([BIN / "a351d", "--config", "a351d.toml", "--clock", clock],
                                           cwd=scratch, stderr=log)
        self.wait_for("1000 samples are journaled", lambda state: (state["journaled"] or 0) >= 1000)

    def status(self):
        return daemon_status(self.port)

    def counters(self):
        return self.status()["counters"]

    def wait_for(self, claim, is_true, seconds=60):
        """Waits until `is_true` holds for the status, and returns that status."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            state = self.status()
            if state and is_true(state):
                return state
            time.sleep(0.05)
        demand(f"{claim} within {seconds} s, last: {self.status()}", False)

    def wait_for_more(self, count=500):
        reached = (self.status()["journaled"] or 0) + count
        self.wait_for(f"{count} more samples are journaled", lambda state: state["journaled"] >= reached)

    def is_noted(self, text):
        return run(BIN / "a351ctl", "--url", f"http://127.0.0.1:{self.port}", "note", text,
                   check=False).returncode == 0

    def end(self):
        """Ends both programs and compares the archive with the truth.

        The sensor is silenced first, so that the daemon reads every frame that was sent.
        """
        with socket.socket(socket.AF_UNIX) as control:
            control.connect(str(self.scratch / "control"))
            control.sendall(b"silence seconds=100000\n")
            control.recv(65536)
        time.sleep(1.0)
        self.daemon.send_signal(signal.SIGTERM)
        demand("the daemon ends cleanly after writing everything to disk", self.daemon.wait(timeout=60) == 0)
        self.sim.send_signal(signal.SIGTERM)
        self.sim.wait(timeout=30)
        for name, counted in compare_truth(self.scratch / "data" / "archive",
                                           self.scratch / "truth.bin").items():
            demand(f"{name}: all {counted['truth']:.0f} samples are archived, none altered or duplicated",
                   counted["matched"] == counted["truth"] > 1000
                   and counted["missing"] == counted["altered"] == counted["duplicated"] == 0)


def has_reason(state, beginning):
    return any(reason.startswith(beginning) for reason in state["reasons"])


def sample_age_s(state):
    """Returns the real time since the last sample that the page shows."""
    return state["sample"]["age_s"] / SPEED


def demand_live_view(day, disk, seconds):
    """Demands that samples and signal follow the sensor for `seconds`, whatever the disk does.

    strace and the tests that run beside this one delay the daemon by up to 0.8 s.  A view that waits for the disk is as old as
    the stall, 3 s or more.
    """
    oldest_s, states, end = 0.0, set(), time.monotonic() + seconds
    while time.monotonic() < end:
        state = day.status()
        oldest_s = max(oldest_s, sample_age_s(state))
        states.add(state["details"]["state"])
        time.sleep(0.05)
    demand(f"{disk}: the last sample was at most {oldest_s:.2f} s old, limit 1.2; states {sorted(states)}",
           oldest_s < 1.2 and states != {"no data"})


def archive_size(scratch):
    return sum(file.stat().st_size for file in (scratch / "data" / "archive").rglob("*.D.*"))


# A full disk

def full_disk():
    small_disk.enter_own_mounts()
    with Scratch() as scratch:
        data = scratch / "data"
        small_disk.mount(data)
        day = Day(scratch)
        reserve = data / "state" / "reserve"
        demand("the reserve of 64 MiB exists and its blocks are allocated", day.status()["disk"]["reserve"] == "present"
               and reserve.stat().st_size == RESERVE and reserve.stat().st_blocks * 512 >= RESERVE)

        small_disk.fill(data / "filler")
        day.wait_for("the reserve is released", lambda state: state["disk"]["reserve"] == "given_up")
        before = archive_size(scratch)
        day.wait_for_more(3000)
        state = day.status()
        demand(f"the status reports the fault: {state['reasons']}",
               state["level"] == "fault" and has_reason(state, "disk full"))
        demand(f"{state['disk']['free_bytes']} bytes are free for the journal, and the journal has no fault",
               0 < state["disk"]["free_bytes"] <= RESERVE and state["counters"]["journal_faults"] == 0)
        demand("the archive is not written meanwhile", archive_size(scratch) == before
               and state["counters"]["archive_records_waiting"] > 0)
        demand("an event is accepted", day.is_noted("in the reserve"))

        small_disk.fill(data / "filler2")
        state = day.wait_for("the journal has a fault",
                             lambda state: state["counters"]["journal_faults"] > 0)
        demand(f"the status reports the fault: {state['reasons']}", has_reason(state, "journal: "))
        time.sleep(5.0)
        journaled = day.status()["journaled"]

        (data / "filler").unlink()
        (data / "filler2").unlink()
        state = day.wait_for("the fault is over and the reserve is back", lambda state: state["disk"]["reserve"] == "present"
                             and state["journaled"] > journaled + 5 * 50 * SPEED and state["level"] != "fault")
        demand("the blocks of the reserve are allocated again", reserve.stat().st_blocks * 512 >= RESERVE)
        demand("the reserve was released once", state["counters"]["reserve_given_up"] == 1)
        day.end()
        demand("the event is in the event log", "in the reserve" in "".join(
            file.read_text() for file in (data / "events").iterdir()))
        run("umount", data)
    stop_on_a_full_disk()


def stop_on_a_full_disk():
    with Scratch() as scratch:
        data = scratch / "data"
        small_disk.mount(data)
        day = Day(scratch)
        small_disk.fill(data / "filler")
        day.wait_for("the reserve is released", lambda state: state["disk"]["reserve"] == "given_up")
        small_disk.fill(data / "filler2")
        day.wait_for("the journal has a fault", lambda state: state["counters"]["journal_faults"] > 0)
        day.daemon.send_signal(signal.SIGTERM)
        status = day.daemon.wait(timeout=60)
        day.sim.send_signal(signal.SIGTERM)
        day.sim.wait(timeout=30)
        last = (scratch / "a351d.log").read_text().split(" stopping\n")[1].splitlines()
        demand(f"stopped on a full disk it ends with {status}, and its last lines have the reason: {last}",
               status == 1 and any(" error: journal: " in line for line in last))
        run("umount", data)


# Failing system calls

@contextlib.contextmanager
def injecting(day, *injections):
    """Injects faults into system calls of the daemon with strace, until the block ends."""
    names = ",".join(injection.split(":")[0] for injection in injections)
    tracer = subprocess.Popen(
        ["strace", "-f", "-q", "-o", day.scratch / "strace.txt", "-p", str(day.daemon.pid), "-e", f"trace={names}"]
        + [part for injection in injections for part in ("-e", f"inject={injection}")],
        stderr=subprocess.PIPE, text=True)
    time.sleep(0.3)
    if tracer.poll() is not None:
        day.daemon.kill()
        day.sim.kill()
        skip(f"strace cannot attach to the daemon: {tracer.stderr.read().strip()}")
    try:
        yield
    finally:
        tracer.send_signal(signal.SIGINT)
        tracer.wait(timeout=30)


STALL = "the disk stalls"


def failing_sync(day, part, n):
    before = day.counters()
    with injecting(day, f"fdatasync:error=EIO:when={n}"):  # strace counts the calls of each thread separately.
        state = day.wait_for(f"a fault of the {part} is counted", lambda state: state["counters"][f"{part}_faults"]
                             > before[f"{part}_faults"])
        demand(f"{part}: sync {n} fails, and the status reports a fault: {state['reasons']}",
               state["level"] == "fault" and has_reason(state, f"{part}: "))
    day.wait_for_more()


def stall(day, call, n, seconds):
    with injecting(day, f"{call}:delay_enter={seconds * 1_000_000}:when={n}"):
        day.wait_for(f"the stall of {call} {n} is reported", lambda state: has_reason(state, STALL))
        demand_live_view(day, f"{call} stalls", seconds - 2.0)
        longest_s, is_stalled = 0.0, True
        while is_stalled:
            asked = time.monotonic()
            state = day.status()
            longest_s = max(longest_s, time.monotonic() - asked)
            is_stalled = state is None or has_reason(state, STALL)
            time.sleep(0.05)
        demand(f"during the stall of {call} {n} the status was answered within {longest_s:.3f} s, limit 1", longest_s < 1.0)
        longest_ms = state["disk"]["longest_sync_ms"]
        demand(f"the status reports a longest sync of {longest_ms} ms after a stall of {seconds} s",
               longest_ms >= 1000 * seconds - 100)
    day.wait_for_more()


def read_only(day):
    """Makes syncs and all calls that create, open or change a file fail, as on a file system that turned read-only."""
    before = day.counters()
    calls = ("fdatasync", "fsync", "openat", "mkdir", "rename", "unlink", "ftruncate", "fallocate")
    with injecting(day, *(f"{call}:error=EROFS" for call in calls)):
        state = day.wait_for("two attempts to write fail", lambda state: state["counters"]["journal_faults"]
                             >= before["journal_faults"] + 2)
        demand(f"read-only: the status reports a fault: {state['reasons']}",
               state["level"] == "fault" and has_reason(state, "journal: "))
        demand_live_view(day, "read-only", 12.0)  # Longer than the 10 s between two attempts.
        demand("the fault is still reported after another attempt", has_reason(day.status(), "journal: "))
    day.wait_for("the journal is written again", lambda state: not has_reason(state, "journal: "))
    day.wait_for_more()


def failing_syncs():
    with Scratch() as scratch:
        day = Day(scratch)
        day.wait_for("the first word of the signal is logged, which syncs too", lambda state: any(
            '"signal"' in file.read_text() for file in (scratch / "data" / "events").glob("*.jsonl")))
        for n in (1, 2, 5):
            failing_sync(day, "journal", n)
        failing_sync(day, "archive", 1)
        stall(day, "write", 7, 3)
        with injecting(day, "fdatasync:error=EIO:when=1", "fsync:delay_enter=3000000:when=1"):
            day.wait_for("a stall at a new segment is reported", lambda state: has_reason(state, STALL))
        day.wait_for_more()
        print("counters:", day.counters())
        day.end()


def long_faults():
    with Scratch() as scratch:
        day = Day(scratch)
        stall(day, "fdatasync", 2, 10)
        read_only(day)
        day.end()


def failing_calls():
    if shutil.which("strace") is None:
        skip("strace is missing")
    together(failing_syncs, long_faults)  # Both wait most of their time.


{"full": full_disk, "failing": failing_calls}[sys.argv[1]]()
