"""Corrects many days as the tasks of a Slurm array: the results must have the same bytes as when corrected one by one.

A controller and one node run on this host, without cgroups and accounting.  Some tasks are killed while they run; Slurm runs
them again.  It needs A351_LONG=1: the tasks of Slurm take both cores from tests in real time, whatever their priority.
"""

import concurrent.futures
import contextlib
import getpass
import os
import pathlib
import random
import shutil
import signal
import socket
import subprocess
import time

from programs import BIN, IS_LONG, Scratch, demand, run, skip, unused_port

DAYS, KILLS = 200, 5
CORES = len(os.sched_getaffinity(0))
REPEATED = 137  # Exit status of a task after which Slurm runs it again: 128 + SIGKILL.
START_S, MOST_S = 60.0, 1700.0

if not IS_LONG:
    skip("corrects 200 days on both cores, which takes some 15 minutes; set A351_LONG=1")
for program in ("slurmctld", "slurmd", "sbatch", "squeue", "sinfo", "scontrol"):
    if shutil.which(program) is None:
        skip(f"{program} is missing; install Debian's package slurm-wlm")
if os.getuid() != 0:
    skip("a node of Slurm starts its tasks as root")


def configuration(folder, ports):
    host = socket.gethostname()
    return f"""ClusterName=a351
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
SlurmUser={getpass.getuser()}
AuthType=auth/none
CredType=cred/none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=batch_sched_delay=0,sched_min_interval=0
RequeueExit={REPEATED}
ReturnToService=2
MpiDefault=none
StateSaveLocation={folder}/controller
SlurmdSpoolDir={folder}/node
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
NodeName={host} NodeAddr=127.0.0.1 CPUs={CORES} State=UNKNOWN
PartitionName=days Nodes={host} Default=YES State=UP
"""


@contextlib.contextmanager
def cluster(folder):
    for name in ("controller", "node"):
        (folder / name).mkdir()
    (folder / "slurm.conf").write_text(configuration(folder, [unused_port(), unused_port()]))
    os.environ["SLURM_CONF"] = str(folder / "slurm.conf")
    programs = [subprocess.Popen([shutil.which(name), "-D"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                for name in ("slurmctld", "slurmd")]
    try:
        end = time.monotonic() + START_S
        while "idle" not in (state := run("sinfo", "-h", "-o", "%t", check=False).stdout):
            if time.monotonic() > end:
                print((folder / "slurmctld.log").read_text()[-2000:], (folder / "slurmd.log").read_text()[-2000:])
                demand(f"the node is idle within {START_S:.0f} s, state {state.strip()}", False)
            time.sleep(0.2)
        yield
    finally:
        for program in reversed(programs):
            program.send_signal(signal.SIGTERM)
            program.wait(timeout=60)


def process_of(day):
    """Returns the process that corrects this day; None if there is none."""
    for process in pathlib.Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            if (process / "comm").read_text() == "a351-correct\n" and os.readlink(process / "cwd") == str(day):
                return int(process.name)
    return None


def run_array(scratch, days):
    """Runs all days as one array, kills some tasks, and returns its time in s and the days that were killed."""
    script = scratch / "day.sh"
    script.write_text(f"#!/bin/bash\ncd {scratch}/day$SLURM_ARRAY_TASK_ID\n"
                      f"{BIN / 'a351-correct'} survey survey.toml --out together\n")
    victims = random.Random(1).sample(days, KILLS)
    killed = []
    began = time.monotonic()
    run("sbatch", f"--array=1-{DAYS}", "--ntasks=1", "--output=/dev/null", script)
    while waiting := run("squeue", "-h", "-r", "-o", "%i %t %r").stdout.splitlines():
        for day in set(victims) - set(killed):
            if (process := process_of(day)) is not None:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(process, signal.SIGKILL)
                    killed.append(day)
        if time.monotonic() > began + MOST_S:
            demand(f"the array ends within {MOST_S:.0f} s, left: {waiting[:5]}", False)
        # Slurm lets a task that is run again wait for two minutes, so that a broken node does not use up the array.
        for number, state, reason in (line.split(maxsplit=2) for line in waiting):
            if state == "PD" and reason == "BeginTime":
                run("scontrol", "update", f"JobId={number}", "StartTime=now", check=False)
        time.sleep(0.02)
    return time.monotonic() - began, killed


def contents(folder):
    """Returns the files of a result; a process that was killed may have left a hidden part of one."""
    return {file.relative_to(folder): file.read_bytes() for file in folder.rglob("*")
            if file.is_file() and file.suffix != ".part"}


with Scratch() as scratch:
    days = [scratch / f"day{seed}" for seed in range(1, DAYS + 1)]
    with concurrent.futures.ThreadPoolExecutor(CORES) as pool:
        list(pool.map(lambda seed: run(BIN / "a351-sim", "survey", "--scenario", "tsukuba", "--seed", seed, "--out",
                                       scratch / f"day{seed}"), range(1, DAYS + 1)))
    began = time.monotonic()
    for day in days:
        run(BIN / "a351-correct", "survey", "survey.toml", "--out", "result", cwd=day)
    one_by_one_s = time.monotonic() - began
    (scratch / "slurm").mkdir()
    with cluster(scratch / "slurm"):
        together_s, killed = run_array(scratch, days)
    version = run("sbatch", "--version").stdout.strip()
    print(f"{version}, {DAYS} days: one by one {one_by_one_s / DAYS:.2f} s a day; as an array on {CORES} cores "
          f"{together_s / DAYS:.2f} s, efficiency {100.0 * one_by_one_s / (CORES * together_s):.0f} %")
    demand(f"{len(killed)} tasks were killed while they ran", len(killed) == KILLS)
    differing = [day.name for day in days if contents(day / "result") != contents(day / "together")]
    demand(f"days with differences in their {len(contents(days[0] / 'result'))} files: {differing or 'none'}", not differing)
    print("left by the tasks that were killed:", [part.name for day in killed for part in day.rglob("*.part")] or "nothing")
