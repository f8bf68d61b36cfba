"""Makes a fresh Debian in a directory, runs commands in it, and boots its systemd.

Needs root, debootstrap and a Debian mirror.
"""

import os
import pathlib
import platform
import re
import shutil
import subprocess
import time

from programs import demand, run

# Without what points to this tree.
ENVIRONMENT = ["/usr/bin/env", "-u", "TMPDIR", "-u", "A351_BIN", "-u", "A351_TOOLS",
               "PATH=/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin", "DEBIAN_FRONTEND=noninteractive", "HOME=/tmp"]
MOUNTS = pathlib.Path("/proc/self/mounts")

# Starts systemd as the first process of its own namespaces, in its own cgroup.  It sees neither the host's processes nor its
# network, and has no write access to shared parts of the kernel (clock, settings, devices).
BOOT = """root=$0
mount --bind $root $root
mount -t tmpfs -o mode=755 tmpfs $root/dev
cd $root/dev
for node in null zero full random urandom tty; do touch $node; mount --bind /dev/$node $node; done
mkdir pts shm
mount -t devpts -o newinstance,ptmxmode=0666,mode=620,gid=5 devpts pts
ln -s pts/ptmx ptmx
ln -s /proc/self/fd fd
mount -t proc proc $root/proc
mount --bind $root/proc/sys $root/proc/sys
mount -o remount,ro,bind $root/proc/sys
mount -t sysfs -o ro sysfs $root/sys
mount -t cgroup2 cgroup2 $root/sys/fs/cgroup
mount -t tmpfs tmpfs $root/run
mount -t tmpfs tmpfs $root/tmp
exec setpriv --bounding-set=-sys_time,-sys_module,-sys_rawio,-syslog \
    chroot $root /usr/bin/env -i container=other PATH=/usr/sbin:/usr/bin:/sbin:/bin /lib/systemd/systemd
"""


SUITES = {"bookworm": "Debian 12", "trixie": "Debian 13"}


def is_of_a_package(file):
    return run("dpkg-query", "-S", file, check=False).returncode == 0


def make_root(root, suite, architecture=None):
    """Installs a minimal Debian in `root`.

    @param architecture  Debian's name; default: that of this machine.  Another one needs qemu-user-static and its binfmt.
    """
    run("debootstrap", "--variant=minbase", *([f"--arch={architecture}"] if architecture else []), suite, root)
    # The root uses the same Debian mirrors and network settings as this host.
    for name in ("resolv.conf", "hosts", "ssl/certs"):
        copy("/etc" / pathlib.Path(name), root / "etc" / name)
    copy(pathlib.Path("/usr/local/share/ca-certificates"), root / "usr/local/share/ca-certificates")
    for file in pathlib.Path("/etc/apt/apt.conf.d").iterdir():
        if not is_of_a_package(file):  # Files of packages would conflict with the packages in the root.
            copy(file, root / "etc/apt/apt.conf.d" / file.name)
    own_suite = platform.freedesktop_os_release().get("VERSION_CODENAME")
    sources = [file for file in map(pathlib.Path, ("/etc/apt/sources.list", "/etc/apt/sources.list.d/debian.sources"))
               if file.is_file()]
    if own_suite in SUITES and sources:
        (root / "etc/apt/sources.list").write_text("")
        for file in sources:
            text = re.sub(rf"\b{own_suite}\b", suite, file.read_text()).replace("-keyring.pgp", "-keyring.gpg")
            (root / file.relative_to("/")).write_text(text)


def copy(source, target):
    if source.is_dir():
        shutil.copytree(source, target, dirs_exist_ok=True, symlinks=True)
    elif source.is_file():
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(source, target)


def output(result, command):
    """Returns the standard output of a command; ends the test if the command failed."""
    if result.returncode != 0:
        print(result.stdout[-3000:], result.stderr[-3000:], sep="\n")
        demand(f"this command succeeds in the fresh root: {command}", False)
    return result.stdout


def inside(root, command, user=None):
    """Runs a shell command in the root, with its own terminals and processes, as root or as another user."""
    as_user = f"setpriv --reuid={user} --regid={user} --init-groups " if user else ""
    script = (f"mount --bind /dev {root}/dev && mount -t devpts -o newinstance,ptmxmode=0666 devpts {root}/dev/pts && "
              f"mount --bind {root}/dev/pts/ptmx {root}/dev/ptmx && mount -t proc proc {root}/proc && "
              f"exec chroot {root} {' '.join(ENVIRONMENT)} {as_user}/bin/bash -euc \"$0\"")
    return output(subprocess.run(["unshare", "--mount", "--pid", "--fork", "--kill-child", "sh", "-euc", script, command],
                                 capture_output=True, text=True), command)


class Booted:
    """Systemd of the root, booted as on a machine; `trouble` is None or the reason why it does not run."""

    def __init__(self, root):
        tops = [line.split()[1] for line in MOUNTS.read_text().splitlines() if line.split()[2] == "cgroup2"]
        self.cgroup = pathlib.Path(tops[0] if tops else "/none", f"a351-test-{os.getpid()}")
        self.root, self.trouble = root, None

    def __enter__(self):
        try:
            self.cgroup.mkdir()
        except OSError as error:
            self.trouble = f"there is no cgroup of version 2: {error}"
            return self
        self.messages = open(self.root / "var/log/boot.log", "w+")
        self.outer = subprocess.Popen(
            ["sh", "-euc", "echo $$ >$1/cgroup.procs && exec unshare --mount --pid --fork --kill-child --cgroup --ipc --uts "
             "--net sh -euc \"$2\" $0", self.root, self.cgroup, BOOT], stdin=subprocess.DEVNULL, stdout=self.messages,
            stderr=self.messages)
        end = time.monotonic() + 60
        while (state := self.try_run("systemctl is-system-running").stdout.strip()) not in ("running", "degraded"):
            if time.monotonic() > end or self.outer.poll() is not None:
                self.messages.seek(0)
                self.trouble = f"systemd is {state or 'not running'}: {self.messages.read()[-1000:]}"
                break
            time.sleep(0.5)
        return self

    def try_run(self, command):
        """Runs a shell command in the namespaces of systemd; `outer` is unshare, and systemd is its only child."""
        try:
            first = pathlib.Path(f"/proc/{self.outer.pid}/task/{self.outer.pid}/children").read_text().split()[0]
        except (OSError, IndexError):
            first = "none"
        return subprocess.run(["nsenter", f"--target={first}", "--mount", "--pid", "--net", "--ipc", "--uts", "--cgroup",
                               "--root", "--wd", *ENVIRONMENT, "bash", "-euc", command], capture_output=True, text=True)

    def run(self, command):
        return output(self.try_run(command), command)

    def __exit__(self, *_):
        if not self.cgroup.exists():
            return
        self.outer.kill()
        self.outer.wait()
        self.messages.close()
        while (self.cgroup / "cgroup.events").read_text().startswith("populated 1"):  # Wait for ended processes to be removed.
            time.sleep(0.1)
        for folder in sorted(self.cgroup.rglob("*/"), reverse=True):
            folder.rmdir()
        self.cgroup.rmdir()
