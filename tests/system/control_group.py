"""A control group of the kernel with the limits of a small computer."""

import atexit
import os
import pathlib
import time

TOP = pathlib.Path("/sys/fs/cgroup")
CORE_SHARE, MEMORY_MB, DISK_MB_S = 0.05, 128, 2
PERIOD_US = 100_000
HIERARCHIES = ("cpu", "memory", "blkio")  # Those of version 1; version 2 has one for all.


class SmallMachine:
    """5 % of one core, 128 MB and 2 MB/s.  `enter` is the preexec_fn of a process that shall live in it."""

    def __init__(self, name, disk):
        """@param disk  a directory on the disk that is limited
        @raise OSError  groups cannot be made here
        """
        device = os.stat(disk).st_dev
        self.is_unified = (TOP / "cgroup.controllers").exists()
        self.folders, self.unlimited = {}, []
        for hierarchy in ("",) if self.is_unified else HIERARCHIES:
            self.folders[hierarchy] = TOP / hierarchy / f"a351-{os.getpid()}-{name}"
            self.folders[hierarchy].mkdir()
            atexit.register(self.remove, self.folders[hierarchy])
        write = DISK_MB_S * 1_000_000
        disk_name = f"{os.major(device)}:{os.minor(device)}"
        if self.is_unified:
            (TOP / "cgroup.subtree_control").write_text("+cpu +memory")
            self.set("", "cpu.max", f"{CORE_SHARE * PERIOD_US:.0f} {PERIOD_US}")
            self.set("", "memory.max", MEMORY_MB << 20)
            self.limit_disk("", "io.max", f"{disk_name} wbps={write}")
        else:
            self.set("cpu", "cpu.cfs_period_us", PERIOD_US)
            self.set("cpu", "cpu.cfs_quota_us", f"{CORE_SHARE * PERIOD_US:.0f}")
            self.set("memory", "memory.limit_in_bytes", MEMORY_MB << 20)
            self.limit_disk("blkio", "blkio.throttle.write_bps_device", f"{disk_name} {write}")

    def set(self, hierarchy, file, value):
        (self.folders[hierarchy] / file).write_text(str(value))

    def limit_disk(self, hierarchy, file, value):
        try:
            if self.is_unified:
                (TOP / "cgroup.subtree_control").write_text("+io")
            self.set(hierarchy, file, value)
        except OSError as error:  # A file system over several disks, or in memory.
            self.unlimited.append(f"no limit of 2 MB/s: {error}")

    def enter(self):
        for folder in self.folders.values():
            (folder / "cgroup.procs").write_text("0")

    def throttled_s(self):
        """Returns for how long the processes waited for their share of the core."""
        folder = self.folders["" if self.is_unified else "cpu"]
        counts = dict(line.split() for line in (folder / "cpu.stat").read_text().splitlines())
        return int(counts["throttled_usec"]) / 1e6 if self.is_unified else int(counts["throttled_time"]) / 1e9

    def remove(self, folder):
        for _ in range(50):  # Until its processes have ended.
            try:
                return folder.rmdir()
            except OSError:
                time.sleep(0.1)
