"""Tests the service and a survey in a fresh Debian that has only the packages; called by fresh_debian.py."""

import shutil
import time

from booted_service import as_a_service
from fresh_root import SUITES, inside, make_root
from programs import TOP, demand, run

BROUGHT_HOME = "/var/lib/a351/base"


def kept(root):
    return inside(root, "cd / && find etc/a351 var/lib/a351 -type f | sort | xargs -r sha256sum")


def version_of(deb):
    return run("dpkg-deb", "-f", deb, "Version").stdout.strip()


def installed_and_used(root, suite, debs, newer, architecture=None):
    """Makes a fresh root, installs the packages, uses them, upgrades and removes them.

    @param root  directory of the fresh root, which must not exist
    @param debs  files of the packages by package name
    @param newer  files of newer packages by package name
    """
    began = time.monotonic()
    make_root(root, suite, architecture)
    for deb in (*debs.values(), *newer.values()):
        shutil.copy(deb, root / "root")
    inside(root, "apt-get update -qq && cd /root && apt-get install -y --no-install-recommends " +
           " ".join(f"./{deb.name}" for deb in debs.values()))
    print(f"a fresh {SUITES[suite]} with the packages after {time.monotonic() - began:.0f} s")
    compiler = inside(root, "command -v g++ cmake python3 || true").split()
    demand(f"the fresh root has neither compiler nor Python: {compiler or 'none'}", not compiler)

    verified = inside(root, "systemd-analyze verify --man=no a351d@base.service 2>&1 | grep a351 || true")
    demand(f"systemd-analyze verify: {verified or 'clean'}", verified == "")
    demand("the user of the service exists", "a351" in inside(root, "getent passwd a351"))
    inside(root, f"install -d -o a351 -g a351 {BROUGHT_HOME} && "
           "sed -e 's#^port = .*by-id.*#port = \"/tmp/none\"#' -e 's#^root = .*#root = \"/var/lib/a351/base\"#' "
           "/usr/share/doc/a351/examples/a351d.toml >/etc/a351/base.toml")
    demand("the example with port and root is a valid configuration",
           inside(root, "a351d --config /etc/a351/base.toml --check-config", "a351") == "ok\n")
    as_a_service(root, debs["a351"])

    # A whole day as the user of the service; the demonstration is a script that calls the four programs.
    shutil.copy(TOP / "sim" / "demo", root / "usr/local/bin/a351-demo")
    began = time.monotonic()
    day = inside(root, f"A351_BIN=/usr/bin a351-demo tsukuba --out {BROUGHT_HOME}/day", "a351")
    print("\n".join(day.splitlines()[-16:]))
    print(f"a survey day, as the user a351: {time.monotonic() - began:.0f} s")
    table = (root / BROUGHT_HOME[1:] / "day/result/occupations.csv").read_text().splitlines()
    demand(f"{len(table) - 1} occupations have their gravity", len(table) == 20)

    before = kept(root)
    print(f"{len(before.splitlines())} files of configuration and data")
    demand("configuration, archive and journal exist",
           all(word in before for word in ("etc/a351/base.toml", "data/archive/", "data/journal/")))
    inside(root, "cd /root && apt-get install -y --no-install-recommends " +
           " ".join(f"./{deb.name}" for deb in newer.values()))
    version = inside(root, "dpkg-query -W -f '${Version}' a351")
    demand(f"the upgrade to {version} changes no configuration or data",
           version == version_of(newer["a351"]) and kept(root) == before)
    inside(root, "apt-get remove -y a351 a351-correct a351-sim")
    demand("removing the packages keeps all configuration and data",
           "a351d" not in inside(root, "ls /usr/bin") and kept(root) == before)
    inside(root, "apt-get purge -y a351 a351-correct a351-sim")
    demand("purging the packages keeps all configuration and data", kept(root) == before)
