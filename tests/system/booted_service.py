"""Tests a351d@.service under the systemd of a fresh root, with the emulator as its sensor; called by fresh_install.py."""

import json
import time

from emulated_session import wait_for
from fresh_root import Booted
from programs import compare_truth, demand

SETTLED_S = 5  # Signal before the next step, in s; after 2 s the times are known and samples are archived.


class Recorder:
    """The service a351d@box1 and its status."""

    def __init__(self, system):
        self.system = system
        system.run("sed -e 's#^port = .*by-id.*#port = \"/run/emulator/sensor\"#' -e 's#^root = .*#root = \"/var/lib/a351/box1\"#' "
                   "/usr/share/doc/a351/examples/a351d.toml >/etc/a351/box1.toml")
        system.run("systemd-run --unit=emulator --uid=a351 -p RuntimeDirectory=emulator -p StateDirectory=emulator "
                   "a351-sim device --link /run/emulator/sensor --truth /var/lib/emulator/truth.bin")
        began = time.monotonic()
        system.run("systemctl start a351d@box1")
        print(f"the service reported ready after {time.monotonic() - began:.1f} s")
        self.wait_for_samples("the daemon records")

    def status(self):
        said = self.system.try_run("a351ctl status --json").stdout
        return json.loads(said) if said else {}

    def unit(self, *properties):
        said = self.system.run(f"systemctl show a351d@box1 -p {','.join(properties)}")
        return dict(line.split("=", 1) for line in said.splitlines())

    def pid(self):
        return int(self.unit("MainPID")["MainPID"])

    def is_another(self, pid):
        return self.pid() not in (0, pid)

    def wait_for_samples(self, claim):
        wait_for(claim, lambda: self.status().get("device", {}).get("state") == "sampling")
        first = self.status()["received"] or 0
        wait_for(claim, lambda: (self.status()["received"] or 0) > first + 50 * SETTLED_S)


def is_confined(recorder):
    own = recorder.system.run(f"cat /proc/{recorder.pid()}/status")
    demand("the daemon runs without capabilities and with a system call filter",
           all(line in own for line in ("CapBnd:\t0000000000000000", "NoNewPrivs:\t1", "Seccomp:\t2")))
    tried = recorder.system.try_run(f"nsenter --target={recorder.pid()} --mount --root --wd touch /var/lib/a351/other")
    demand("the daemon cannot write outside its own directory", "Read-only file system" in tried.stderr)


def reloads(recorder):
    recorder.system.run("sed -i 's/^occupation_min.*/occupation_min = 12/' /etc/a351/box1.toml && systemctl reload a351d@box1")
    wait_for("a reload is logged", lambda: "SIGHUP" in recorder.system.run("journalctl -o cat -u a351d@box1"))


def comes_back(recorder):
    session = recorder.status()["session"]
    for fault in ("KILL", "STOP"):  # The watchdog ends a stopped daemon.
        before, began = recorder.pid(), time.monotonic()
        recorder.system.run(f"kill -{fault} {before}")
        wait_for(f"a new daemon process after SIG{fault}", lambda: recorder.is_another(before), seconds=120)
        print(f"SIG{fault}: a new process started after {time.monotonic() - began:.0f} s")
        recorder.wait_for_samples("the daemon records again")
    demand("the session of the sensor continued", recorder.status()["session"] == session)


def follows_the_package(recorder, install):
    before = recorder.pid()
    recorder.system.run(install)
    demand("an upgrade restarts the running daemon", recorder.is_another(before))
    recorder.wait_for_samples("the daemon records after the upgrade")
    began = time.monotonic()
    recorder.system.run("dpkg -r a351")
    demand(f"removing the package stops the daemon, in {time.monotonic() - began:.1f} s",
           recorder.unit("MainPID", "Result") == {"MainPID": "0", "Result": "success"})


def as_a_service(root, deb):
    """Tests the service in the root.

    @param deb  the package a351 in the root's /root; it is installed before and after the test
    """
    install = f"dpkg -i ~root/{deb.name}"
    with Booted(root) as system:
        if system.trouble:
            print(f"the test of the service is skipped: {system.trouble}")
            return
        recorder = Recorder(system)
        is_confined(recorder)
        reloads(recorder)
        comes_back(recorder)
        follows_the_package(recorder, install)
        system.run(f"systemctl stop emulator && {install}")
    channels = compare_truth(root / "var/lib/a351/box1/archive", root / "var/lib/emulator/truth.bin").values()
    demand("at most 22 samples are missing: 0.2 s and a cut frame for each of two kills",
           all(one["missing"] <= 22 < one["matched"] for one in channels))
