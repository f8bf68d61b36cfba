"""The daemon in a simulated world, see tests/simulation: no run may break an invariant, and a seed gives the same run again.

Runs 36 seeds; with A351_LONG 10 000, in as many processes as there are cores.  --mutations builds the daemon with each mistake
of tests/simulation/mutations in turn, in a copy of the sources, and searches for a seed that finds it.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
FIRST = 1
MOST_SEEDS = 2000  # Seeds in which a mutation must be found.


def environment():
    """Returns an environment whose temporary files are in memory, because a run writes thousands of small files."""
    return dict(os.environ, TMPDIR="/dev/shm") if os.access("/dev/shm", os.W_OK) else dict(os.environ)


def run_seeds(program, count):
    cores = len(os.sched_getaffinity(0)) if count > 100 else 1
    share = -(-count // cores)
    firsts = range(FIRST, FIRST + count, share)
    processes = [subprocess.Popen([program, str(first), str(min(share, FIRST + count - first))], stdout=subprocess.PIPE,
                                  text=True, env=environment()) for first in firsts]
    outputs = [process.communicate()[0] for process in processes]
    print("".join(outputs), end="")
    return all(process.returncode == 0 for process in processes)


def find_mutation(patch, copy):
    """Returns the first line about a broken invariant, or None."""
    subprocess.run(["patch", "-s", "-p1", "-i", patch], cwd=copy, check=True)
    build = copy / "build/release"
    subprocess.run(["cmake", "--preset", "release"], cwd=copy, check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", build, "--target", "daemon-simulation"], check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["patch", "-s", "-R", "-p1", "-i", patch], cwd=copy, check=True)
    with subprocess.Popen([build / "tests/daemon-simulation", str(FIRST), str(MOST_SEEDS)], stdout=subprocess.PIPE, text=True,
                          env=environment()) as process:
        for line in process.stdout:
            if line.startswith("seed "):
                process.kill()
                return re.sub(r"; [0-9]+ s of signal.*", "", line.strip())
    return None


def find_mutations():
    missed = 0
    with tempfile.TemporaryDirectory(prefix="a351-mutations-") as folder:
        copy = pathlib.Path(folder) / "a351"
        shutil.copytree(ROOT, copy, ignore=shutil.ignore_patterns("build", ".git"))
        for patch in sorted((ROOT / "tests/simulation/mutations").glob("*.patch")):
            found = find_mutation(patch, copy)
            print(f"{patch.stem}: {found or f'NOT found in {MOST_SEEDS} seeds'}", flush=True)
            missed += found is None
    return missed == 0


def main():
    if sys.argv[1:] == ["--mutations"]:
        return 0 if find_mutations() else 1
    program = pathlib.Path(os.environ["A351_TOOLS"]) / "daemon-simulation"
    if not program.exists():
        print("skipped: the simulation is not built with sanitizers, which replace the same functions of the C library")
        return 77
    for patch in sorted((ROOT / "tests/simulation/mutations").glob("*.patch")):
        subprocess.run(["patch", "--dry-run", "-s", "-p1", "-i", patch], cwd=ROOT, check=True)
    return 0 if run_seeds(program, 10_000 if os.environ.get("A351_LONG") else 36) else 1


if __name__ == "__main__":
    sys.exit(main())
