"""Faults at 20x: what the daemon counts is what the emulator did, frame for frame and byte for byte."""

import datetime
import json
import random
import signal
import socket
import struct
import subprocess
import time

from programs import BIN, Scratch, compare_truth, daemon_config, demand, read_json, run

SPEED = 20
INTACT, DAMAGED, LOST, REPEATED, MISPLACED = range(5)

# Every fault that leaves the session as it is; the places of damage are drawn from the seed.
WITHIN_A_SESSION = """
[random]
seed = 5
flip_bit_per_h = 120
drop_bytes_per_h = 60
duplicate_frame_per_h = 60
""" + "".join(f'[[fault]]\nat_s = {at}\nkind = "{kind}"\n{keys}\n' for at, kind, keys in [
    (40, "flip_bit", "count = 5\nbits = 3"),
    (45, "bad_checksum", "count = 2"),
    (50, "drop_bytes", "count = 3\nbytes = 7"),
    (55, "insert_bytes", "count = 3\nbytes = 2"),
    (60, "garbage", "bytes = 10000"),
    (70, "duplicate_frame", "count = 4"),
    (75, "reorder_frames", "count = 2"),
    (80, "truncate_frame", "count = 3"),
    (85, "lose_frames", "count = 5"),
    (90, "counter_stuck", "count = 4"),
    (95, "error_flags", "count = 6\ndiag_stat = 0x20"),
    (100, "stall", "seconds = 3"),
    (110, "silence", "seconds = 4"),
])


class Session:
    """Emulator and daemon side by side; both are stopped in the end, the emulator's report read."""

    def __init__(self, scratch, faults):
        self.scratch = scratch
        self.port = random.randrange(20000, 40000)
        (scratch / "a351d.toml").write_text(daemon_config(self.port))
        (scratch / "faults.toml").write_text(faults)
        plan = run(BIN / "a351-sim", "plan", "--scenario", "tsukuba", "--out", scratch)
        start = dict(part.split("=", 1) for part in plan.stdout.split())["start_utc"]
        host = datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%S.%fZ")
        clock = f"scaled:{SPEED}@{start},{host}"
        self.sim = subprocess.Popen(
            [BIN / "a351-sim", "device", "--link", "sensor", "--scenario", "tsukuba", "--clock", clock,
             "--faults", "faults.toml", "--control", "control", "--truth", "truth.bin", "--report",
             "report.json"], cwd=scratch)
        self.log = open(scratch / "a351d.log", "w")
        self.daemon = subprocess.Popen([BIN / "a351d", "--config", "a351d.toml", "--clock", clock],
                                       cwd=scratch, stderr=self.log)
        self.wait_for("the control socket", (scratch / "control").exists)

    def order(self, line):
        with socket.socket(socket.AF_UNIX) as control:
            control.connect(str(self.scratch / "control"))
            control.sendall(line.encode() + b"\n")
            answer = b""
            while not answer.endswith(b"\n"):
                answer += control.recv(65536)
        if not answer.startswith(b"ok"):
            demand(f"the emulator takes the order {line}: {answer}", False)
        return answer.decode()[3:].strip()

    def emulated(self):
        return json.loads(self.order("status"))

    def status(self):
        result = run(BIN / "a351ctl", "--url", f"http://127.0.0.1:{self.port}", "status", "--json",
                     check=False)
        return json.loads(result.stdout) if result.stdout else {}

    def wait_for(self, claim, is_true, seconds=60):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if is_true():
                return
            time.sleep(0.1)
        demand(f"{claim} within {seconds} s", False)

    def wait_for_frames(self, count):
        self.wait_for(f"{count} frames", lambda: self.status().get("counters", {}).get("frames", 0) >= count)

    def end(self):
        """Silence first, so that nothing is under way when the counters are read."""
        self.order("silence seconds=100000")
        time.sleep(1.0)
        counters = self.status()["counters"]
        self.sim.send_signal(signal.SIGTERM)
        demand("the emulator ends cleanly", self.sim.wait(timeout=30) == 0)
        self.daemon.send_signal(signal.SIGTERM)
        demand("the daemon ends cleanly", self.daemon.wait(timeout=30) == 0)
        self.log.close()
        report = read_json(self.scratch / "report.json")
        report.pop("faults_applied")
        print("emulator:", report)
        print("daemon:", counters)
        demand("the control socket and the link are gone",
               not (self.scratch / "control").exists() and not (self.scratch / "sensor").is_symlink())
        return report, counters

    def rows(self):
        """Instant, x, y, z, temperature, COUNT, run, grid index, fate of every frame, in the order sent."""
        data = (self.scratch / "truth.bin").read_bytes()[16:]
        return list(struct.iter_unpack("<q4iHHIB7x", data))

    def truth(self):
        return [(row[0], row[8]) for row in self.rows()]

    def samples(self):
        return {row[0]: row[1:5] for row in self.rows()}

    def archive_is_true(self, missing, steps=0):
        for name, counted in compare_truth(self.scratch / "data" / "archive",
                                           self.scratch / "truth.bin").items():
            demand(f"{name}: no damaged, lost or repeated frame is in the archive, none altered",
                   counted["altered"] == counted["duplicated"] == 0 and counted["matched"] > 0)
            demand(f"{name}: {counted['missing']:.0f} of {counted['truth']:.0f} intact frames missing, "
                   f"{counted['steps']:.0f} time steps (allowed {missing} and {steps})",
                   counted["missing"] == missing and counted["steps"] == steps)


def gaps_of(truth):
    """Gaps and missing samples between the first and the last intact frame."""
    placed = {instant for instant, fate in truth if fate == INTACT}
    instants = sorted({instant for instant, _ in truth if min(placed) <= instant <= max(placed)})
    missing = [instant not in placed for instant in instants]
    gaps = sum(1 for now, before in zip(missing, [False] + missing) if now and not before)
    return gaps, sum(missing)


def bytes_agree(report, counters):
    arrived = report["bytes_handed_over"] - report["bytes_of_answers"]
    demand(f"{counters['bytes']} bytes received are the {arrived} handed over",
           counters["bytes"] == arrived)
    damaged = arrived - report["bytes_of_frames"]
    demand(f"{counters['bytes_skipped']} bytes skipped are the {damaged} outside whole frames",
           counters["bytes_skipped"] == damaged)
    demand(f"{counters['frames']} frames are the {report['frames_sent']} that were sent whole",
           counters["frames"] == report["frames_sent"])


with Scratch() as scratch:
    session = Session(scratch, WITHIN_A_SESSION)
    session.wait_for_frames(50 * 140)
    report, counters = session.end()
    bytes_agree(report, counters)
    gaps, missing = gaps_of(session.truth())
    demand(f"{counters['gaps']} gaps of {counters['samples_missing']} samples are the truth's",
           (counters["gaps"], counters["samples_missing"]) == (gaps, missing))
    demand(f"{counters['duplicates']} duplicates", counters["duplicates"] == report["frames_repeated"] > 8)
    demand(f"{counters['anomalies']} anomalies", counters["anomalies"] == report["frames_misplaced"] == 2)
    demand(f"{counters['error_flags']} flagged frames",
           counters["error_flags"] == report["frames_flagged"] == 6)
    demand("damage is seen as damage", counters["checksum_errors"] + counters["framing_errors"]
           >= report["frames_damaged"] > 16)
    demand("one session", counters["sessions"] == len(report["runs"]) == 1)
    session.archive_is_true(missing=0)
    first_samples = session.samples()

# The device ends sampling: no frame is under way when the daemon configures it again.
with Scratch() as scratch:
    session = Session(scratch, "")
    runs = 1
    for fault in ("stop", "reset", "power_cycle", "hang_up seconds=40 loses_power=true"):
        session.wait_for(f"run {runs}", lambda: session.emulated()["runs"][runs - 1:]
                         and session.emulated()["runs"][-1]["frames"] > 500)
        session.order(fault)
        runs += 1
        session.wait_for(f"sampling again after {fault}", lambda: len(session.emulated()["runs"]) == runs)
    session.wait_for("frames of the last run", lambda: session.emulated()["runs"][-1]["frames"] > 500)
    report, counters = session.end()
    bytes_agree(report, counters)
    demand(f"{runs} runs are as many sessions", counters["sessions"] == len(report["runs"]) == runs)
    demand("nothing was unread when the port was pulled out", report["bytes_unread"] == 0)
    session.archive_is_true(missing=0)
    common = [(values, first_samples[instant]) for instant, values in session.samples().items()
              if instant in first_samples]
    demand(f"{len(common)} samples at equal instants of two runs are equal",
           len(common) > 2000 and all(one == other for one, other in common))

# Pulled out and back under another name while it samples: what comes before the daemon has stopped it is nobody's.
with Scratch() as scratch:
    session = Session(scratch, "")
    session.wait_for_frames(1000)
    before = (scratch / "sensor").readlink()
    session.order("hang_up seconds=60")
    session.wait_for("the port is gone", lambda: not (scratch / "sensor").is_symlink())
    session.wait_for("the port is back", lambda: (scratch / "sensor").is_symlink())
    demand("under another name", (scratch / "sensor").readlink() != before)
    session.wait_for("a second run", lambda: len(session.emulated()["runs"]) == 2
                     and session.emulated()["runs"][1]["frames"] > 500)
    report, counters = session.end()
    unheard = report["frames_sent"] - counters["frames"]
    demand(f"{unheard} frames were drained before the handshake, {report['frames_lost_unplugged']} lost "
           "unplugged", 0 <= unheard < 60 * 50 and report["frames_lost_unplugged"] > 50 * 50)
    demand("nothing was unread when the port was pulled out", report["bytes_unread"] == 0)
    session.archive_is_true(missing=unheard)

# A receiver that overflows while the host does not read; for less than the counter's wrap, so that no clock decides.
with Scratch() as scratch:
    session = Session(scratch, "")
    session.wait_for_frames(1000)
    session.order("overrun")
    session.daemon.send_signal(signal.SIGSTOP)
    time.sleep(0.6)
    session.daemon.send_signal(signal.SIGCONT)
    session.wait_for_frames(session.emulated()["frames_sent"] + 1000)
    report, counters = session.end()
    bytes_agree(report, counters)
    demand(f"{report['frames_lost_by_overrun']} frames were lost by overrun, less than a wrap",
           100 < report["frames_lost_by_overrun"] < 760)
    gaps, missing = gaps_of(session.truth())
    demand(f"{counters['gaps']} gaps of {counters['samples_missing']} samples are the truth's",
           (counters["gaps"], counters["samples_missing"]) == (gaps, missing))
    demand("one session", counters["sessions"] == 1)
    session.archive_is_true(missing=0)
