"""A newcomer's way in a fresh Debian: a clean clone, sim/demo, tests/run; the packages, made twice at two places, then
installed and used in a second fresh root.

    python3 tests/system/fresh_debian.py bookworm|trixie [--architecture arm64] [--without-tests]

Wants root, debootstrap, a mirror, 6 GB in TMPDIR, and a build of this tree for its tools; takes up to an hour.  Of this
tree only what is committed is seen.
"""

import argparse
import os
import shutil
import time

from fresh_install import installed_and_used
from fresh_root import SUITES, inside, make_root
from programs import TOOLS, TOP, Scratch, demand, run, skip

CLONE, ELSEWHERE = "/srv/a351", "/srv/built elsewhere"
PROGRAMS = "a351d a351ctl a351-sim a351-correct"


def timed(root, title, command):
    began = time.monotonic()
    said = inside(root, command)
    print("\n".join(said.splitlines()[-25:]))
    print(f"{title}: {time.monotonic() - began:.0f} s", flush=True)
    return said


def clone_into(root):
    run("git", "clone", "--bare", "--no-hardlinks", TOP, root / "srv/a351.git")
    # Debian's minimal root has no git; a newcomer has, or could not have cloned.
    inside(root, "apt-get update -qq && apt-get install -y --no-install-recommends git")
    inside(root, f"git clone /srv/a351.git {CLONE}")


def packages_of(root, suite, scratch):
    """The packages that the clone's build gives, twice the same; and newer ones, for an upgrade."""
    inside(root, "apt-get install -y --no-install-recommends lintian python3")
    said = timed(root, "packages built and looked into", f"cd {CLONE} && python3 tests/system/packages.py")
    demand("lintian was asked", "lintian finds neither error nor warning" in said)
    inside(root, f"cd {CLONE}/build/release && cpack -B /srv/debs && cpack -R 99.0.0 -B /srv/newer")
    timed(root, "built again, at another place",
          f"git clone -q /srv/a351.git '{ELSEWHERE}' && cd '{ELSEWHERE}' && cmake --preset release -DA351_TESTS=OFF && "
          f"cmake --build --preset release --target {PROGRAMS} && cd build/release && cpack -B /srv/debs-elsewhere")
    print(inside(root, "cd /srv/debs && for file in *.deb *.json; do cmp $file ../debs-elsewhere/$file; sha256sum $file; done"))
    print("holds: built at another place and time, they are the same bytes")
    found = []
    for folder in ("debs", "newer"):
        shutil.copytree(root / "srv" / folder, scratch / folder, ignore=shutil.ignore_patterns("_CPack_Packages"))
        found.append({deb.name.split("_")[0]: deb for deb in (scratch / folder).glob("*.deb")})
    return found


parser = argparse.ArgumentParser()
parser.add_argument("suite", choices=SUITES)
parser.add_argument("--architecture", help="Debian's name of another architecture, run by qemu-user-static")
parser.add_argument("--without-tests", action="store_true", help="leave tests/run out")
asked = parser.parse_args()
if os.geteuid() != 0 or shutil.which("debootstrap") is None or shutil.which("git") is None:
    skip("a fresh root needs root, debootstrap and git")
if not (TOOLS / "compare-truth").is_file():
    skip(f"{TOOLS}/compare-truth is missing; tests/run builds it")
if changed := run("git", "-C", TOP, "status", "--short").stdout:
    print(f"not committed, and left out:\n{changed}")
with Scratch() as scratch:
    root = scratch / "root"
    began = time.monotonic()
    make_root(root, asked.suite, asked.architecture)
    clone_into(root)
    print(f"a fresh {SUITES[asked.suite]} with a clone: {time.monotonic() - began:.0f} s", flush=True)
    day = timed(root, "sim/demo", f"cd {CLONE} && sim/demo")
    demand("the demonstration ends with its report", "the report is" in day)
    if not asked.without_tests:
        timed(root, "tests/run", f"cd {CLONE} && tests/run")
    debs, newer = packages_of(root, asked.suite, scratch)
    shutil.rmtree(root)
    installed_and_used(scratch / "installed", asked.suite, debs, newer, asked.architecture)
