"""Runs emulator and daemon together, orders faults, and reads the emulator's truth: the fate of every frame."""

import atexit
import datetime
import json
import socket
import struct
import subprocess
import time

from programs import (BIN, compare_truth, daemon_config, daemon_status, demand, end_cleanly, read_json, run, start_of,
                      unused_port)

INTACT, DAMAGED, LOST, REPEATED, MISPLACED = range(5)
FRAME = 24  # Bytes
# Delay from the time of a sample to the sending of its frame: 511 / 2 samples of the filter at 4000 Hz, 430 us to data
# ready, FRAME bytes of 10 bits at 460800 baud (M-A352AD10 data sheet, 5.4, table 2.2, 6.2).
DELAY_NS = 63_875_000 + 430_000 + FRAME * 10 * 1_000_000_000 // 460_800


def ask(scratch, line):
    """Sends one order to the control socket and returns the answer."""
    with socket.socket(socket.AF_UNIX) as control:
        control.connect(str(scratch / "control"))
        control.sendall(line.encode() + b"\n")
        answer = b""
        while not answer.endswith(b"\n"):
            more = control.recv(65536)
            if not more:
                demand(f"the emulator answers the order {line} completely, received: {answer}", False)
            answer += more
    return answer.decode()


def wait_for(claim, is_true, seconds=60):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if is_true():
            return
        time.sleep(0.1)
    demand(f"{claim} within {seconds} s", False)


class Session:
    """Emulator and daemon running together.  end() stops both and reads the emulator's report."""

    def __init__(self, scratch, faults="", speed=20, scenario="tsukuba", start=None, config="", storage="", prepare_port=None,
                 on_host_clock=False, host="127.0.0.1", emulator=(), **options):
        """Starts both.

        @param start  begin of simulated time, RFC 3339; default: that of the scenario
        @param config  lines after the daemon's [sensor], also further tables
        @param storage  lines added to its [storage]
        @param prepare_port  function called with the emulator's terminal before the daemon starts
        @param on_host_clock  both run on the host's clock; speed must be 1, and `start` must not be in the future
        @param host  address on which the daemon listens
        @param emulator  further options of `a351-sim device`
        @param options  options of subprocess.Popen for the daemon
        """
        self.scratch = scratch
        self.port = unused_port()
        self.url = f"http://127.0.0.1:{self.port}"
        (scratch / "a351d.toml").write_text(
            daemon_config(self.port, host).replace("[storage]\n", f"{config}\n[storage]\n{storage}"))
        (scratch / "faults.toml").write_text(faults)
        if start is None:
            start = start_of(scenario, scratch)
        now = datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%S.%fZ")
        self.clock = f"scaled:{speed}@{start},{start if on_host_clock else now}"
        self.sim = self._start(
            [BIN / "a351-sim", "device", "--link", "sensor", "--scenario", scenario, "--clock", self.clock,
             "--faults", "faults.toml", "--control", "control", "--truth", "truth.bin", "--report",
             "report.json", *emulator])
        wait_for("the control socket exists", (scratch / "control").exists)
        if prepare_port:
            prepare_port(scratch / "sensor")
        self.on_host_clock, self.options = on_host_clock, options
        self.log = open(scratch / "a351d.log", "w")
        self.daemon = self.start_daemon()

    def _start(self, command, **options):
        """Starts a program that is killed when the test ends; otherwise it would keep the test's output open."""
        process = subprocess.Popen(command, cwd=self.scratch, **options)
        atexit.register(process.kill)
        return process

    def start_daemon(self, config="a351d.toml", **options):
        clock = [] if self.on_host_clock else ["--clock", self.clock]
        return self._start([BIN / "a351d", "--config", config, *clock],
                           **{"stderr": self.log, **self.options, **options})

    def order(self, line):
        answer = ask(self.scratch, line)
        if not answer.startswith("ok"):
            demand(f"the emulator accepts the order {line}: {answer}", False)
        return answer[3:].strip()

    def emulated(self):
        return json.loads(self.order("status"))

    def status(self):
        return daemon_status(self.port) or {}

    def try_ctl(self, *arguments):
        return run(BIN / "a351ctl", "--url", self.url, *arguments, check=False)

    def ctl(self, *arguments):
        """Runs a351ctl, which must succeed, and returns what it prints."""
        return run(BIN / "a351ctl", "--url", self.url, *arguments).stdout

    def wait_for_frames(self, count):
        wait_for(f"{count} frames", lambda: self.status().get("counters", {}).get("frames", 0) >= count)

    def settled(self):
        """Waits until the daemon has all frames sent so far and 100 more, and returns its counters."""
        sent = self.emulated()["frames_sent"]
        self.wait_for_frames(sent + 100)
        return self.status()["counters"]

    def end(self):
        """Stops both and returns the emulator's report and the daemon's counters.

        The sensor is silenced first, so that no frame is in transit.
        """
        self.order("silence seconds=100000")
        time.sleep(1.0)
        counters = self.status()["counters"]
        end_cleanly("the emulator", self.sim)
        end_cleanly("the daemon", self.daemon)
        self.log.close()
        report = read_json(self.scratch / "report.json")
        report.pop("faults_applied")
        demand("the emulator refused no fault", report["faults_refused"] == [])
        demand("every frame made is counted once as sent, damaged, lost or pending, apart from duplicates",
               report["frames_made"] + report["faults"].get("duplicate_frame", 0)
               == report["frames_sent"] + report["frames_damaged"] + report["frames_lost"]
               + report["frames_pending"])
        print("emulator:", report)
        print("daemon:", counters)
        demand("the control socket and the link are removed",
               not (self.scratch / "control").exists() and not (self.scratch / "sensor").is_symlink())
        return report, counters

    def rows(self):
        """Returns time in ns, x, y, z, temperature, COUNT, run, grid index and fate of every frame, in the order sent."""
        data = (self.scratch / "truth.bin").read_bytes()[16:]
        return list(struct.iter_unpack("<q4iHHIB7x", data))

    def truth(self):
        return [(row[0], row[8]) for row in self.rows()]

    def samples(self):
        return {row[0]: row[1:5] for row in self.rows()}

    def counted(self):
        """Compares the archive with the truth and returns the counts of each channel."""
        return compare_truth(self.scratch / "data" / "archive", self.scratch / "truth.bin")

    def archive_is_true(self, missing, steps=0):
        """Demands that the archive agrees with the truth.

        @param steps  expected time steps; None if times start again in the test, then only values are compared
        """
        for name, counted in self.counted().items():
            demand(f"{name}: {counted['missing']:.0f} of {counted['truth']:.0f} intact frames missing, "
                   f"{counted['steps']:.0f} time steps (allowed {missing} and {steps})",
                   counted["missing"] == missing and (steps is None or counted["steps"] == steps))


def told_at(session, utc, *order):
    """Gives an order at an instant; a daemon that lags has not recorded it yet."""
    wait_for(f"{' '.join(order)} at {utc}", lambda: session.try_ctl(*order, "--at", utc).returncode == 0, 3600)


def require_unread(report, frames, outages):
    """Demands that this many frames, handed over and not received, are those that the emulator took back at outages."""
    unread = report["bytes_unread"]
    demand(f"{frames} frames were not received; {unread} bytes were unread when the port was unplugged {outages} times",
           unread <= FRAME * frames < unread + FRAME * outages or unread == frames == 0)


def gaps_of(truth):
    """Returns the numbers of gaps and of missing samples between the first and the last intact frame."""
    placed = {instant for instant, fate in truth if fate == INTACT}
    instants = sorted({instant for instant, _ in truth if min(placed) <= instant <= max(placed)})
    missing = [instant not in placed for instant in instants]
    gaps = sum(1 for now, before in zip(missing, [False] + missing) if now and not before)
    return gaps, sum(missing)
