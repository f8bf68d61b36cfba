"""Disk of 256 MiB in memory, for tests that fill it."""

import contextlib
import os
import shutil
import sys

from programs import Scratch, run, skip

RESERVE = 64 << 20  # Reserve file of the daemon, in bytes.
OWN_MOUNTS = "A351_OWN_MOUNTS"


def enter_own_mounts():
    """Starts the script again in a name space in which it may mount, as root or as root of a new user name space."""
    if OWN_MOUNTS in os.environ:
        return
    for way in (["unshare", "-m"], ["unshare", "-rm"]):
        if shutil.which("unshare") is None:
            break
        with Scratch() as scratch:
            trial = run(*way, "mount", "-t", "tmpfs", "none", scratch, check=False)
        if trial.returncode == 0:
            os.environ[OWN_MOUNTS] = "1"
            os.execvp(way[0], way + [sys.executable, *sys.argv])
    skip("neither `unshare -m` nor `unshare -rm` can mount a tmpfs here; run the test as root")


def mount(directory):
    directory.mkdir()
    run("mount", "-t", "tmpfs", "-o", f"size={4 * RESERVE}", "none", directory)


def free_bytes(directory):
    return shutil.disk_usage(directory).free


def fill(file, bytes_left=0):
    """Fills the disk with a file until only `bytes_left` are free."""
    with open(file, "wb", buffering=0) as out, contextlib.suppress(OSError):
        while (rest := free_bytes(file.parent) - bytes_left) > 0:
            out.write(bytes(min(rest, 1 << 16)))
