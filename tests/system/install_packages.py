"""Tests config/install-packages with scripts in place of apt-get, sudo and dpkg-query that log how they are called."""

import shutil

from programs import TOP, Scratch, demand, run

SCRIPT = TOP / "config" / "install-packages"
LIST = "# build\nmake\nplotter-nox|plotter-qt\n# library\nlibm-dev # with a comment\n"


class Machine:
    """Folder used as PATH, with made-up tools; `installed` lists the packages that its dpkg-query knows."""

    def __init__(self, folder, installed="", user_id=0, has_sudo=False, apt_get="exit 0", is_debian=True):
        self.folder, self.calls = folder, folder / "calls"
        folder.mkdir()
        for tool in ("sh", "sed", "tr", "dirname", "env"):
            (folder / tool).symlink_to(shutil.which(tool))
        self.write("id", f"echo {user_id}")
        self.write("apt-get", f'echo "${{DEBIAN_FRONTEND:-}} apt-get $*" >>{self.calls}\n{apt_get}')
        if has_sudo:
            # Like sudo, without the caller's environment.
            self.write("sudo", f'echo "sudo $*" >>{self.calls}\nshift\n[ "$1" = true ] || env -i PATH={folder} "$@"')
        if is_debian:
            self.write("dpkg-query", f'for name; do :; done\ncase " {installed} " in *" $name "*) echo "install ok installed" ;; '
                       "*) exit 1 ;; esac")

    def write(self, name, commands):
        (self.folder / name).write_text(f"#!/bin/sh\n{commands}\n")
        (self.folder / name).chmod(0o755)

    def install(self, *lists):
        """Runs the script and returns its status, its lines on stderr, and the calls of the tools."""
        result = run("/bin/sh", SCRIPT, *lists, check=False, env={"PATH": str(self.folder), "DEBIAN_FRONTEND": ""})
        demand(f"nothing on stdout: {result.stdout!r}", result.stdout == "")
        calls = self.calls.read_text().splitlines() if self.calls.exists() else []
        print(result.returncode, result.stderr, calls)
        return result.returncode, result.stderr.splitlines(), calls


with Scratch() as scratch:
    (scratch / "list").write_text(LIST)
    (scratch / "more").write_text("tester\n")
    (scratch / "empty").write_text("# nothing\n")
    for name in ("absent", "empty", "."):
        status, lines, calls = Machine(scratch / f"bad-{name.strip('.')}").install(scratch / "list", scratch / name)
        demand(f"unusable list {name!r}: status 2, one line with its name, nothing installed",
               status == 2 and len(lines) == 1 and str(scratch / name) in lines[0] and not calls)

    complete = "make plotter-qt libm-dev"
    demand("all packages are installed: no tool is called, so no network is needed",
           Machine(scratch / "complete", complete, user_id=1000).install(scratch / "list") == (0, [], []))
    wanted = "install -y --no-install-recommends plotter-nox libm-dev"
    demand("as root: update, then installation of the missing packages, of alternatives the first",
           Machine(scratch / "root", "make").install(scratch / "list")[::2] ==
           (0, [" apt-get update -qq", f"noninteractive apt-get {wanted}"]))
    demand("packages of two lists are installed together",
           Machine(scratch / "two", complete).install(scratch / "list", scratch / "more")[2][-1] ==
           "noninteractive apt-get install -y --no-install-recommends tester")
    status, _, calls = Machine(scratch / "sudo", "make", user_id=1000, has_sudo=True).install(scratch / "list")
    demand("with sudo: the installation asks no question either",
           status == 0 and calls[-1] == f"noninteractive apt-get {wanted}")
    status, lines, calls = Machine(scratch / "user", "make", user_id=1000).install(scratch / "list")
    demand("neither root nor sudo: one line with the apt-get command, status 1",
           status == 1 and len(lines) == 1 and lines[0].endswith(f"apt-get update && apt-get {wanted}") and not calls)
    status, lines, calls = Machine(scratch / "failing", "make", apt_get="exit 100").install(scratch / "list")
    demand("apt-get fails: the packages are named, status 1",
           status == 1 and lines[-1].endswith("plotter-nox libm-dev") and len(calls) == 2)
    status, lines, _ = Machine(scratch / "other", is_debian=False).install(scratch / "list")
    demand("on another system without CMake: one line with the packages, status 1",
           status == 1 and len(lines) == 1 and lines[0].endswith("make plotter-nox|plotter-qt libm-dev"))
    for name in ("packages.txt", "test-packages.txt", "page-test-packages.txt"):
        status, lines, _ = Machine(scratch / name, user_id=1000).install(TOP / "config" / name)
        demand(f"{name} is a valid list of packages", status == 1 and "apt-get install" in lines[0])
