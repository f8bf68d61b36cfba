"""The daemon as a systemd service: it sends the notifications, and the unit allows every system call that it makes."""

import atexit
import json
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import time

from emulated_session import wait_for
from programs import BIN, IS_SANITIZED, TOP, Scratch, daemon_config, daemon_status, demand, end_cleanly, run, skip

PORT = 28352
UNIT = TOP / "config" / "a351d@.service"
STREAM_UNIT = TOP / "config" / "a351-stream@.service"
WORST_EXPOSURE = 2.5  # Limit for systemd-analyze security, 0 (best) to 10; the unit has 2.2, one without restrictions 9.6.


def start(scratch, tracer=(), **environment):
    """Starts emulator and daemon on the host's clock and returns their processes."""
    (scratch / "a351d.toml").write_text(daemon_config(PORT) + '[survey]\nsites = "sites.csv"\n')
    (scratch / "sites.csv").write_text("site,longitude_deg,latitude_deg,altitude_m,gravity_mgal\nNo.0,140.1,36.2,500,979800\n")
    sim = subprocess.Popen([BIN / "a351-sim", "device", "--link", "sensor"], cwd=scratch, stderr=subprocess.DEVNULL)
    daemon = subprocess.Popen([*tracer, BIN / "a351d", "--config", "a351d.toml"], cwd=scratch, stderr=subprocess.DEVNULL,
                              env={**os.environ, **environment})
    for process in (sim, daemon):
        atexit.register(process.kill)
    return sim, daemon


def told(manager):
    """Returns every notification received so far."""
    manager.setblocking(False)
    datagrams = []
    while True:
        try:
            datagrams.append(manager.recv(4096).decode())
        except BlockingIOError:
            return datagrams


def notices():
    with Scratch() as scratch, socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as manager:
        manager.bind(str(scratch / "notify"))
        sim, daemon = start(scratch, NOTIFY_SOCKET=str(scratch / "notify"))
        manager.settimeout(30)
        demand("the first notification is READY=1", manager.recv(4096) == b"READY=1")
        time.sleep(5)
        said = told(manager)
        print(said)
        demand(f"{said.count('WATCHDOG=1')} watchdog signals in 5 s, must be 3 to 6", said.count("WATCHDOG=1") in range(3, 7))
        demand("the status line says sampling", any(line.startswith("STATUS=sampling") for line in said))
        daemon.send_signal(signal.SIGSTOP)
        time.sleep(0.5)
        told(manager)
        time.sleep(2.5)
        demand("a stopped daemon sends no watchdog signal, so that systemd restarts it", told(manager) == [])
        daemon.send_signal(signal.SIGCONT)
        end_cleanly("the daemon", daemon)
        demand("the last notification is STOPPING=1", told(manager)[-1] == "STOPPING=1")
        end_cleanly("the emulator", sim)


def unit_is_clean(scratch, source):
    """Checks a unit with systemd-analyze, with the program that was built."""
    program, unit = source.name.removesuffix("@.service"), scratch / source.name
    unit.write_text(source.read_text().replace(f"ExecStart={program}", f"ExecStart={BIN / program}"))
    checked = run("systemd-analyze", "verify", "--man=no", scratch / f"{program}@here.service", check=False)
    said = [line for line in (checked.stdout + checked.stderr).splitlines() if program in line]
    demand(f"systemd-analyze verify reports {said or 'nothing'} of {source.name}", not said and checked.returncode == 0)
    security = run("systemd-analyze", "security", "--no-pager", "--offline=true", unit, check=False).stdout
    exposure = re.search(r"Overall exposure level for .*: ([\d.]+)", security)
    if exposure:
        demand(f"exposure {exposure[1]} of 10, limit {WORST_EXPOSURE}", float(exposure[1]) <= WORST_EXPOSURE)


def allowed_calls(group):
    """Returns the system calls of a systemd group, including those of the groups in it."""
    lines = run("systemd-analyze", "syscall-filter", group).stdout.splitlines()
    names = {line.strip() for line in lines[1:] if line.strip() and not line.strip().startswith("#")}
    return {name for name in names if name[0] != "@"}.union(*(allowed_calls(name) for name in names if name[0] == "@"))


def gravity_reason():
    return json.loads(run(BIN / "a351ctl", "--url", f"http://127.0.0.1:{PORT}", "survey", "--json").stdout)["reason"]


def calls_are_allowed(scratch):
    """Runs the daemon under strace from start to stop; demands that SystemCallFilter= of the unit allows every call."""
    words = re.search(r"^SystemCallFilter=(.*)$", UNIT.read_text(), re.M)[1].split()
    allowed = {word for word in words if word[0] != "@"}.union(*(allowed_calls(word) for word in words if word[0] == "@"))
    demand(f"the filter allows {len(allowed)} calls, including read, without mount",
           "mount" not in allowed and "read" in allowed)
    sim, daemon = start(scratch, ["strace", "-f", "-qq", "-o", "calls"])
    wait_for("a session under strace", lambda: (daemon_status(PORT) or {}).get("counters", {}).get("frames", 0) > 100)
    run(BIN / "a351ctl", "--url", f"http://127.0.0.1:{PORT}", "start", "No.0")
    wait_for("the corrector has run for the gravity so far", lambda: gravity_reason() in ("no_stay", "no_reading"), 120)
    child = pathlib.Path(f"/proc/{daemon.pid}/task/{daemon.pid}/children").read_text().split()[0]
    run("kill", "-TERM", child)
    demand("the daemon ends cleanly under strace", daemon.wait(timeout=60) == 0)
    end_cleanly("the emulator", sim)
    made = set(re.findall(r"^\d+ +(\w+)\(", (scratch / "calls").read_text(), re.M)) - {"execve"}
    demand(f"the daemon made {len(made)} different calls, including fdatasync and adjtimex",
           "fdatasync" in made and bool({"adjtimex", "clock_adjtime"} & made))
    demand("its child made calls too, including sched_setscheduler and ioprio_set", {"sched_setscheduler", "ioprio_set"} <= made)
    demand(f"calls of the daemon that the unit forbids: {sorted(made - allowed) or 'none'}", made <= allowed)


notices()
missing = [name for name in ("systemd-analyze", "strace") if shutil.which(name) is None]
if missing or IS_SANITIZED:  # Sanitizers make additional system calls.
    skip("the notifications are correct; the unit was not tested: "
         f"{' and '.join(missing) + ' missing' if missing else 'sanitizers make additional system calls'}")
with Scratch() as scratch:
    unit_is_clean(scratch, UNIT)
    unit_is_clean(scratch, STREAM_UNIT)
    calls_are_allowed(scratch)
