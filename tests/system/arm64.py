"""Builds for arm64 with a cross compiler in a fresh Debian and tests the result under qemu.

    A351_LONG=1 python3 tests/system/arm64.py [bookworm|trixie]     default: the suite of this host

Runs the unit and golden tests, compares the files of the programs with those of amd64, and makes the packages.
Needs root, debootstrap, a Debian mirror and an amd64 host.  Nothing is compiled under qemu.  The amd64 programs are
compiled from the same tree in the same root.
"""

import os
import pathlib
import platform
import re
import shutil
import sys
import time

from compare_files import differences
from fresh_root import inside, make_root
from programs import IS_LONG, IS_SANITIZED, TOP, Scratch, demand, run, skip

QEMU = "qemu-aarch64-static"
CATCH2 = {"bookworm": "catch2", "trixie": "libcatch2-dev:arm64"}
SURVEY_MODELS = ["auto", "paper", "t-rate-drift-axes", "network", "day"]
TABLE_MODELS = ["auto", "paper", "t-rate-drift", "network"]  # A table has neither horizontal axes nor a whole day.
GOLDEN = "/a351/tests/golden/tsukuba"

# Largest relative differences between arm64 and amd64.  All other numbers are equal to the byte on processors with FMA, where
# the C library computes as on arm64 (methods.md).  In the model `day` a leave-one-station-out search can end one grid step
# apart; loso_mgal then differed by 4e-5 (measured).
LIMITS = {(f"survey/{model}/{file}", "loso_mgal"): 1e-4 for model in ("auto", "day") for file in ("models.csv", "result.json")}


def install(root, suite):
    shutil.copytree(TOP, root / "a351", ignore=shutil.ignore_patterns("build", ".git", "__pycache__"))
    inside(root, "dpkg --add-architecture arm64 && cd /a351 && config/install-packages && "
           "config/install-packages config/arm64-packages.txt && "
           f"apt-get install -y --no-install-recommends python3 {CATCH2[suite]}")


def build(root):
    for arguments, targets in (("--preset arm64", ""),
                               ("--preset release -DA351_TESTS=OFF -DA351_BENCH=OFF", "a351-correct a351-sim")):
        began = time.monotonic()
        preset = arguments.split()[1]
        said = inside(root, f"cd /a351 && cmake {arguments} && nice -n 10 cmake --build build/{preset} "
                      f"{'--target ' + targets if targets else ''}")
        demand(f"{preset}: built in {time.monotonic() - began:.0f} s, without a warning", "warning:" not in said)


def unit_and_golden(root):
    said = inside(root, "cd /a351 && ctest --preset arm64")
    print("\n".join(said.splitlines()[-12:]))
    passed = re.search(r"100% tests passed, 0 tests failed out of (\d+)", said)
    demand(f"{passed[1] if passed else 'not all'} unit and golden tests pass on arm64", passed and int(passed[1]) > 50)


def make_files(root, preset, runner):
    """Makes a simulated day, its correction by each model, the published table, a night's record and its calibration."""
    bin = f"/a351/build/{preset}/bin"
    correct, sim = f"{runner} {bin}/a351-correct", f"{runner} {bin}/a351-sim"
    began = time.monotonic()
    table = f"table --sites {GOLDEN}/sites.csv --observations {GOLDEN}/observations.csv"
    inside(root, " && ".join(
        [f"mkdir -p /made/{preset} && cd /made/{preset}", f"{sim} survey --seed 11 --out day"] +
        [f"{correct} survey day/survey.toml --model {model} --out survey/{model}" for model in SURVEY_MODELS] +
        [f"{correct} {table} --model {model} --out table/{model}" for model in TABLE_MODELS] +
        [f"{sim} survey --scenario indoor --seed 511 --out night", f"{correct} calibrate night --out unit/unit.toml",
         f"{correct} record night --ensemble 8 --apply unit/unit.toml --out record"]))
    print(f"{preset}: files made in {time.monotonic() - began:.0f} s")
    return root / "made" / preset


def compare(amd64, arm64):
    for folder in sorted(path.name for path in amd64.iterdir()):
        found, count = differences(amd64 / folder, arm64 / folder)
        for name, apart_by_key in found.items():
            for key, apart in apart_by_key.items():
                limit = LIMITS.get((f"{folder}/{name}", key), 0)
                demand(f"{folder}/{name}: {key or 'the text'} differs by {apart:.1e} (relative), limit {limit:g}",
                       apart <= limit)
        demand(f"{folder}: {count - len(found)} of {count} files are byte for byte the same as on amd64", count > 0)


def packages(root, suite):
    inside(root, "cd /a351/build/arm64 && cpack -B /debs")
    debs = sorted((root / "debs").glob("*.deb"))
    demand(f"packages: {', '.join(deb.name for deb in debs)}",
           len(debs) == 4 and all(deb.name.endswith(("_arm64.deb", "_all.deb")) for deb in debs))
    for deb in debs:
        fields = run("dpkg-deb", "-f", deb, "Architecture", "Depends").stdout
        print(deb.name, fields, sep="\n")
        demand(f"{deb.name} is for arm64 and depends on the libraries it links",
               "Architecture: arm64" in fields and "libc6 (>= " in fields and "libstdc++6" in fields)
    # apt only resolves the dependencies for arm64, because the installation scripts would need an arm64 system.
    inside(root, "apt-get install -y --no-install-recommends --simulate " +
           " ".join(f"/debs/{deb.name}" for deb in debs))
    print("apt finds every dependency for arm64")


if not IS_LONG or IS_SANITIZED:
    skip("needs a fresh root with a cross compiler, which takes long; set A351_LONG=1 to run it")
if os.geteuid() != 0 or shutil.which("debootstrap") is None or " fma " not in pathlib.Path("/proc/cpuinfo").read_text():
    skip("needs root, debootstrap and an amd64 host with FMA")
suite = sys.argv[1] if len(sys.argv) > 1 else platform.freedesktop_os_release().get("VERSION_CODENAME")
if suite not in CATCH2:
    skip(f"{suite}: unknown suite; allowed: {', '.join(CATCH2)}")
with Scratch() as scratch:
    root = scratch / "root"
    make_root(root, suite)
    install(root, suite)
    build(root)
    compare(make_files(root, "release", ""), make_files(root, "arm64", QEMU))
    unit_and_golden(root)
    packages(root, suite)
