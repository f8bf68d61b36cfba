"""The Debian packages: what they hold and need; with A351_LONG=1 also a survey in a fresh Debian 12 with nothing but them,
and the service under its systemd.

The fresh root wants root, debootstrap and a mirror, and takes six minutes.
"""

import os
import re
import shutil
import time

from booted_service import as_a_service
from fresh_root import inside, make_root
from programs import BIN, IS_LONG, IS_SANITIZED, TOP, Scratch, demand, run, skip

BUILD = BIN.parent
PACKAGES = ["a351", "a351-correct", "a351-sim"]
PROGRAMS = {"a351": ["a351d", "a351ctl"], "a351-correct": ["a351-correct"], "a351-sim": ["a351-sim"]}
MORE_FILES = {
    "a351": ["lib/systemd/system/a351d@.service", "lib/udev/rules.d/60-a351.rules", "usr/lib/sysusers.d/a351.conf",
             "usr/share/a351/a351d.toml", "usr/share/a351/sites.csv", "usr/share/man/man5/a351d.toml.5.gz",
             "usr/share/doc/a351/daemon/field-guide.md", "usr/share/doc/a351/protocol/record/journal-format.md"],
    "a351-correct": ["usr/share/a351/survey.toml", "usr/share/doc/a351/corrector/methods.md"],
    "a351-sim": ["usr/share/a351/scenarios/tsukuba.toml", "usr/share/a351/faults/example.toml",
                 "usr/share/doc/a351/sim/truth/truth-format.md"],
}
# What each links, besides the C and C++ libraries; and what of the others it must do without.
NEEDED = {"a351": ["libmodbus5", "libserialport0", "libmseed", "libzstd1"], "a351-correct": ["libnlopt0", "libmseed"],
          "a351-sim": ["libmseed", "libzstd1"]}
NOT_NEEDED = {"a351": ["libnlopt0"], "a351-correct": ["libmodbus5", "libserialport0"], "a351-sim": ["libserialport0", "libnlopt0"]}
BROUGHT_HOME = "/var/lib/a351/base"


def build(out, version=None):
    began = time.monotonic()
    run("cpack", "--config", BUILD / "CPackConfig.cmake", "-B", out, *(["-R", version] if version else []), cwd=BUILD)
    debs = {deb.name.split("_")[0]: deb for deb in out.glob("*.deb")}
    demand(f"three packages of {', '.join(f'{deb.stat().st_size >> 10} KiB' for deb in debs.values())} in "
           f"{time.monotonic() - began:.1f} s", sorted(debs) == PACKAGES)
    return debs


def field(deb, name):
    return run("dpkg-deb", "-f", deb, name).stdout.strip()


def look_into(package, deb, tree):
    run("dpkg-deb", "-x", deb, tree)
    for program in PROGRAMS[package]:
        said = run(tree / "usr/bin" / program, "--version").stdout
        demand(f"{package}: {program} of version {field(deb, 'Version')}",
               said == f"{program} {field(deb, 'Version').split('-')[0]}\n")
        demand(f"{program} has its manual page and completion",
               (tree / f"usr/share/man/man1/{program}.1.gz").is_file()
               and (tree / f"usr/share/bash-completion/completions/{program}").is_file())
    missing = [file for file in MORE_FILES[package] if not (tree / file).is_file()]
    demand(f"{package}: lacks {missing or 'no file'}", not missing)
    for name, word in (("copyright", "Dan Vanderkam"), ("copyright", "2026 the a351 authors")):
        demand(f"{package}: {name} names {word}", word in (tree / "usr/share/doc" / package / name).read_text())
    newest = run("dpkg-parsechangelog", "-S", "Version", "-l", tree / f"usr/share/doc/{package}/changelog.Debian.gz").stdout
    demand(f"{package}: its changelog ends at {newest.strip()}", newest.strip() == field(deb, "Version"))
    depends = field(deb, "Depends")
    print(f"{package} depends on {depends}; recommends {field(deb, 'Recommends') or 'nothing'}")
    demand(f"{package} depends on what it links", all(name in depends for name in NEEDED[package] + ["libc6", "libstdc++6"]))
    demand(f"{package} depends on nothing of the others", not any(name in depends for name in NOT_NEEDED[package]))


def pages_refer_to_each_other(tree):
    pages = sorted((tree / "usr/share/doc/a351").rglob("*.md"))
    links = [(page, link) for page in pages for link in re.findall(r"\]\(([^):]+)\)", page.read_text())]
    lost = [f"{page.name}: {link}" for page, link in links if not (page.parent / link).is_file()]
    demand(f"of {len(links)} links between {len(pages)} pages lead nowhere: {lost or 'none'}", links and not lost)


def completed(tree, *words):
    """What bash offers for the last of the words."""
    script = f"""source {tree}/usr/share/bash-completion/completions/{words[0]}
PATH={tree}/usr/bin:$PATH COMP_WORDS=({' '.join(f"'{word}'" for word in words)}) COMP_CWORD={len(words) - 1}
_a351 {words[0]} '{words[-1]}' '{words[-2]}'; echo "${{COMPREPLY[@]}}"
"""
    return run("bash", "-c", script).stdout.split()


def lint(debs):
    if shutil.which("lintian") is None:
        print("lintian is not installed: left out")
        return
    # A first upload closes a bug of Debian's own list, which is not ours.
    said = run("lintian", "--allow-root", "--no-cfg", "--suppress-tags", "initial-upload-closes-no-bugs", "--display-info",
               "--tag-display-limit", 3, *debs.values(), check=False).stdout
    print(said)
    demand("lintian finds neither error nor warning", not any(line[:2] in ("E:", "W:") for line in said.splitlines()))


def kept(root):
    return inside(root, f"cd / && find etc/a351 var/lib/a351 -type f | sort | xargs -r sha256sum")


def fresh_root(scratch, debs, newer):
    root = scratch / "root"
    began = time.monotonic()
    make_root(root)
    for deb in (*debs.values(), *newer.values()):
        shutil.copy(deb, root / "root")
    inside(root, "apt-get update -qq && cd /root && apt-get install -y --no-install-recommends " +
           " ".join(f"./{deb.name}" for deb in debs.values()))
    print(f"a fresh Debian 12 with the packages after {time.monotonic() - began:.0f} s")
    compiler = inside(root, "command -v g++ cmake python3 || true").split()
    demand(f"it has neither compiler nor interpreter of ours: {compiler}", not compiler)

    verified = inside(root, "systemd-analyze verify --man=no a351d@base.service 2>&1 | grep a351 || true")
    demand(f"systemd-analyze verify: {verified or 'clean'}", verified == "")
    demand("the user of the service is there", "a351" in inside(root, "getent passwd a351"))
    inside(root, f"install -d -o a351 -g a351 {BROUGHT_HOME} && "
           "sed -e 's#^port = .*by-id.*#port = \"/tmp/none\"#' -e 's#^root = .*#root = \"/var/lib/a351/base\"#' "
           "/usr/share/a351/a351d.toml >/etc/a351/base.toml")
    demand("the example, with port and root, is a configuration",
           inside(root, "a351d --config /etc/a351/base.toml --check-config", "a351") == "ok\n")
    as_a_service(root, debs["a351"])

    # The demonstration is a script around the four programs: a whole day, as the user of the service.
    shutil.copy(TOP / "sim" / "demo", root / "usr/local/bin/a351-demo")
    began = time.monotonic()
    day = inside(root, f"A351_BIN=/usr/bin a351-demo tsukuba --out {BROUGHT_HOME}/day", "a351")
    print("\n".join(day.splitlines()[-16:]))
    print(f"a survey day as the user a351: {time.monotonic() - began:.0f} s")
    table = (root / BROUGHT_HOME[1:] / "day/result/occupations.csv").read_text().splitlines()
    demand(f"{len(table) - 1} occupations have their gravity", len(table) == 20)

    before = kept(root)
    print(f"{len(before.splitlines())} files of configuration and record")
    demand("configuration, archive and journal are among them",
           all(word in before for word in ("etc/a351/base.toml", "data/archive/", "data/journal/")))
    inside(root, "cd /root && apt-get install -y --no-install-recommends " +
           " ".join(f"./{deb.name}" for deb in newer.values()))
    version = inside(root, "dpkg-query -W -f '${Version}' a351")
    demand(f"upgraded to {version}, nothing of it changed", version == field(newer["a351"], "Version") and kept(root) == before)
    inside(root, "apt-get remove -y a351 a351-correct a351-sim")
    demand("removed, all of it is still there", "a351d" not in inside(root, "ls /usr/bin") and kept(root) == before)
    inside(root, "apt-get purge -y a351 a351-correct a351-sim")
    demand("purged, all of it is still there", kept(root) == before)


if shutil.which("dpkg-deb") is None or shutil.which("dpkg-shlibdeps") is None or IS_SANITIZED:
    skip("dpkg-deb or dpkg-shlibdeps is missing, or these programs carry sanitizers")
with Scratch() as scratch:
    debs = build(scratch / "debs")
    for package in PACKAGES:
        look_into(package, debs[package], scratch / "tree")
    tree = scratch / "tree"
    pages_refer_to_each_other(tree)
    demand("completion of subcommands", completed(tree, "a351ctl", "st") == ["status", "start", "stop"])
    demand("completion of options", completed(tree, "a351-correct", "survey", "--mo") == ["--model"])
    demand("completion without subcommands", "--check-config" in completed(tree, "a351d", "--"))
    lint(debs)
    if not IS_LONG:
        print("with A351_LONG=1 they are also installed, used, upgraded and removed in a fresh root")
    elif os.geteuid() != 0 or shutil.which("debootstrap") is None:
        print("no fresh root: needs root and debootstrap")
    else:
        fresh_root(scratch, debs, build(scratch / "newer", version="99.0.0"))
