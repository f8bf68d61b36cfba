"""Tests a fresh Debian as a new user would: a clean clone, sim/demo, tests/run and the packages.

    python3 tests/system/fresh_debian.py bookworm|trixie [--architecture arm64] [--without-tests]

The packages are made twice in two directories, compared, and then installed and used in a second fresh root.  Needs root,
debootstrap, a Debian mirror, 6 GB in TMPDIR, and a build of this tree for its tools; takes up to an hour.  Only committed
files of this tree are tested.
"""

import argparse
import os
import shutil
import time

from fresh_install import installed_and_used
from fresh_root import SUITES, inside, make_root
from programs import TOOLS, TOP, Scratch, demand, run, skip

CLONE, ELSEWHERE = "/srv/a351", "/srv/built elsewhere"


def timed(root, title, command):
    began = time.monotonic()
    said = inside(root, command)
    print("\n".join(said.splitlines()[-25:]))
    print(f"{title}: {time.monotonic() - began:.0f} s", flush=True)
    return said


def clone_into(root):
    run("git", "clone", "--bare", "--no-hardlinks", TOP, root / "srv/a351.git")
    # Debian's minimal root has no git, but a user who clones has it.
    inside(root, "apt-get update -qq && apt-get install -y --no-install-recommends git")
    inside(root, f"git clone /srv/a351.git {CLONE}")


def packages_of(root, suite, scratch):
    """Makes the packages in the clone and again at another place, demands equal bytes, and makes newer ones for an upgrade."""
    inside(root, "apt-get install -y --no-install-recommends lintian python3")
    said = timed(root, "packages built and checked", f"cd {CLONE} && python3 tests/system/packages.py")
    demand("lintian was run", "lintian finds neither error nor warning" in said)
    inside(root, f"cd {CLONE}/build/release && cpack -B /srv/debs && cpack -R 99.0.0 -B /srv/newer")
    timed(root, "built again in another directory",
          f"git clone -q /srv/a351.git '{ELSEWHERE}' && cd '{ELSEWHERE}' && config/build-programs && "
          "cd build/release && cpack -B /srv/debs-elsewhere")
    print(inside(root, "cd /srv/debs && for file in *.deb *.json; do cmp $file ../debs-elsewhere/$file; sha256sum $file; done"))
    print("holds: packages built in another directory at another time have the same bytes")
    found = []
    for folder in ("debs", "newer"):
        shutil.copytree(root / "srv" / folder, scratch / folder, ignore=shutil.ignore_patterns("_CPack_Packages"))
        found.append({deb.name.split("_")[0]: deb for deb in (scratch / folder).glob("*.deb")})
    return found


parser = argparse.ArgumentParser()
parser.add_argument("suite", choices=SUITES)
parser.add_argument("--architecture", help="Debian's name of another architecture, run by qemu-user-static")
parser.add_argument("--without-tests", action="store_true", help="do not run tests/run")
asked = parser.parse_args()
if os.geteuid() != 0 or shutil.which("debootstrap") is None or shutil.which("git") is None:
    skip("a fresh root needs root rights, debootstrap and git")
if not (TOOLS / "compare-truth").is_file():
    skip(f"{TOOLS}/compare-truth is missing; build it with tests/run")
if changed := run("git", "-C", TOP, "status", "--short").stdout:
    print(f"these changes are not committed and therefore not tested:\n{changed}")
with Scratch() as scratch:
    root = scratch / "root"
    began = time.monotonic()
    make_root(root, asked.suite, asked.architecture)
    clone_into(root)
    print(f"a fresh {SUITES[asked.suite]} with a clone: {time.monotonic() - began:.0f} s", flush=True)
    day = timed(root, "sim/demo", f"cd {CLONE} && sim/demo")
    demand("the demonstration ends with its report", "the report is" in day)
    timed(root, "installation and packages after the demonstration alone",
          f"cd {CLONE} && DESTDIR=/srv/installed cmake --install build/release --prefix /usr/local && "
          "cd build/release && cpack -B /srv/after-demo")
    if not asked.without_tests:
        timed(root, "tests/run", f"cd {CLONE} && tests/run")
    debs, newer = packages_of(root, asked.suite, scratch)
    shutil.rmtree(root)
    installed_and_used(scratch / "installed", asked.suite, debs, newer, asked.architecture)
