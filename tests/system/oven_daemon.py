"""The daemon reads the emulated oven beside the emulated sensor: its values are in journal and status; whatever goes
wrong on its line has a counter of its own, ends without a restart, and costs the sensor's stream nothing."""

import datetime
import signal
import socket
import struct
import subprocess
import sys
import time

from programs import BIN, TOP, Scratch, compare_truth, daemon_config, daemon_status, demand, read_json, run, unused_port

sys.path.insert(0, str(TOP / "tests" / "golden" / "logs"))
import journal_page  # noqa: E402

SPEED = 10
OVEN = 8
OUTCOMES = ["answered", "timed_out", "bad_crc", "exception", "other_unit", "malformed", "no_port"]
# What the daemon makes of each fault of the line.
SPOILS = [("oven_silence", "timed_out", "silent"), ("oven_babble", "bad_crc", "disturbed"),
          ("oven_crc_error", "bad_crc", "disturbed"), ("oven_exception", "exception", "disturbed"),
          ("oven_wrong_unit", "other_unit", "disturbed"), ("oven_truncated", "timed_out", "silent"),
          ("oven_delay", "timed_out", "silent")]
# An answer that a busy host lets wait for 300 ms is a time-out too: 16 of 2836 were at a load of 6 on two cores.
BUSY = {"timed_out"}


def wait_for(claim, is_true, limit_s=60):
    end = time.monotonic() + limit_s
    while not is_true():
        if time.monotonic() > end:
            demand(f"{claim} within {limit_s} s", False)
        time.sleep(0.05)


def journal_polls(data):
    """(outcome, decimals, registers) of each OVEN chunk, read by the format page alone."""
    for segment in sorted((data / "journal").glob("*.a351j")):
        for kind, payload in journal_page.chunks(segment):
            if kind == OVEN:
                _, outcome, decimals, count = struct.unpack_from("<qBBB", payload)
                yield OUTCOMES[outcome], decimals, struct.unpack_from(f"<{count}H", payload, 11)


class Session:
    def __init__(self, scratch):
        self.scratch = scratch
        self.port = unused_port()
        (scratch / "a351d.toml").write_text(
            daemon_config(self.port) + '[oven]\nenabled = true\nport = "oven"\nparity = "N"\npoll_s = 2\n')
        plan = run(BIN / "a351-sim", "plan", "--scenario", "tsukuba", "--out", scratch)
        start = dict(part.split("=", 1) for part in plan.stdout.split())["start_utc"]
        host = datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%S.%fZ")
        clock = f"scaled:{SPEED}@{start},{host}"
        self.sim = subprocess.Popen(
            [BIN / "a351-sim", "device", "--link", "sensor", "--oven-link", "oven", "--scenario", "tsukuba", "--clock",
             clock, "--control", "control", "--truth", "truth.bin", "--report", "report.json"], cwd=scratch)
        self.log = open(scratch / "a351d.log", "w")
        self.daemon = subprocess.Popen([BIN / "a351d", "--config", "a351d.toml", "--clock", clock], cwd=scratch,
                                       stderr=self.log)
        wait_for("the control socket", (scratch / "control").exists)
        wait_for("the daemon", lambda: daemon_status(self.port))

    def order(self, line):
        with socket.socket(socket.AF_UNIX) as control:
            control.connect(str(self.scratch / "control"))
            control.sendall(line.encode() + b"\n")
            answer = control.recv(65536).decode()
        if not answer.startswith("ok"):
            demand(f"the emulator takes the order {line}: {answer}", False)

    def status(self):
        return daemon_status(self.port)

    def oven(self):
        return self.status()["oven"]

    def warnings(self):
        status = self.status()
        return [reason for reason in status["reasons"] if reason.startswith("oven: ")] \
            if status["level"] == "warning" else []

    def is_well(self):
        return self.oven()["state"] == "answering" and not self.oven()["is_stale"] and not self.warnings()

    def play(self, kind, outcome, state):
        """One fault, until it is stale, then its end; its counter and no other has risen."""
        before = self.oven()["polls"]
        self.order(f"{kind} count=-1")
        wait_for(f"{kind}: the oven is {state}, with a warning",
                 lambda: self.oven()["state"] == state and self.warnings() == [f"oven: {state}"])
        demand(f"{kind}: the oven is {state}, its last values are stale", self.oven()["is_stale"])
        self.order(f"{kind} count=0")
        began = time.monotonic()
        wait_for(f"after {kind} the oven is back", self.is_well)
        after = self.oven()["polls"]
        risen = {key: after[key] - before[key] for key in after if after[key] != before[key]}
        demand(f"{kind}: {risen}, back after {time.monotonic() - began:.1f} s",
               risen.keys() - BUSY == {"answered", outcome} - BUSY and risen[outcome] > 1)


def play_all(scratch, session):
    wait_for("the oven answers and the sensor samples",
             lambda: session.is_well() and session.status()["counters"]["frames"] > 500)
    oven = session.oven()
    print("status:", oven)
    demand("the oven's values are in the status",
           41 < oven["process_value_degc"] < 44 and oven["set_point_degc"] == 42.5
           and 0 <= oven["heating_percent"] <= 100 and oven["decimals"] == 1 and not oven["has_input_error"])
    screen = run(BIN / "a351ctl", "--url", f"http://127.0.0.1:{session.port}", "status", check=False).stdout
    line = next(text for text in screen.splitlines() if text.startswith("oven "))
    demand(f"a351ctl: {line}", "degC, set point 42.5 degC, heating" in line and line.endswith("answering"))

    for kind, outcome, state in SPOILS:
        session.play(kind, outcome, state)

    session.order("oven_sensor_break")
    wait_for("an open thermocouple is a warning", lambda: session.warnings()
             == ["oven: input error, its temperature is not to be believed"])
    demand("and no temperature", session.oven()["process_value_degc"] is None
           and session.oven()["state"] == "answering")
    session.order("oven_sensor_break count=0")
    wait_for("it is mended", session.is_well)

    name = (scratch / "oven").readlink()
    session.order("oven_unplug")
    wait_for("the oven is searched, as warning and log say", lambda: session.oven()["state"] == "searching"
             and session.warnings() and "oven: searching (" in (scratch / "a351d.log").read_text())
    session.order("oven_unplug count=0")
    wait_for("the oven is back", session.is_well)
    demand("under another name, by the same link", (scratch / "oven").readlink() != name
           and session.oven()["port"].startswith(str((scratch / "oven").readlink()) + ","))

    (scratch / "second").mkdir()
    (scratch / "second" / "a351d.toml").write_text(
        daemon_config(session.port + 1) + '[oven]\nenabled = true\nport = "../oven"\nparity = "N"\n')
    second = subprocess.Popen([BIN / "a351d", "--config", "second/a351d.toml"], cwd=scratch,
                              stderr=subprocess.PIPE)
    wait_for("a second daemon says who has the port", lambda: "somebody else holds it" in
             (daemon_status(session.port + 1) or {"oven": {"trouble": ""}})["oven"]["trouble"])
    second.terminate()
    second.communicate(timeout=30)
    demand("a second daemon does without the oven that the first one holds", session.is_well())

    # Stopped while it waits for an answer, which does not come.
    session.order("oven_silence count=-1")
    wait_for("silence", lambda: session.oven()["state"] == "silent")
    session.order("silence seconds=100000")
    time.sleep(1.0)
    status = session.status()
    session.sim.send_signal(signal.SIGTERM)
    demand("the emulator ends cleanly", session.sim.wait(timeout=30) == 0)
    session.daemon.send_signal(signal.SIGTERM)
    began = time.monotonic()
    status_at_end = session.daemon.wait(timeout=30)
    demand(f"the daemon ends cleanly, in {time.monotonic() - began:.2f} s", status_at_end == 0)
    session.log.close()

    counters, polls = status["counters"], status["oven"]["polls"]
    print("daemon:", {key: counters[key] for key in ("frames", "gaps", "samples_missing", "bytes_skipped",
                                                     "sessions", "link_sessions")}, polls)
    demand("the sensor's stream has no gap and no damage",
           counters["gaps"] == counters["samples_missing"] == counters["bytes_skipped"] == 0
           and counters["sessions"] == 1 and counters["frames"] > 1000)
    for channel, counted in compare_truth(scratch / "data" / "archive", scratch / "truth.bin").items():
        demand(f"{channel}: every one of {counted['truth']:.0f} samples is archived", counted["missing"]
               == counted["altered"] == counted["duplicated"] == 0 and counted["truth"] > 1000)

    recorded = list(journal_polls(scratch / "data"))
    kinds = {outcome: sum(1 for poll in recorded if poll[0] == outcome) for outcome in OUTCOMES}
    print("journal:", kinds)
    demand("the journal holds polls of each kind, and of those that fail by fault just as many as were counted",
           all(kinds[outcome] > 0 for outcome in OUTCOMES if outcome != "malformed")
           and all(kinds[outcome] == polls[outcome] for outcome in ("bad_crc", "exception", "other_unit")))
    good = [registers for outcome, _, registers in recorded if outcome == "answered"]
    demand(f"its {len(good)} answers are five registers with a set point of 42.5 degC", all(
        len(registers) == 5 and registers[2] == 425 for registers in good))
    demand("with a temperature of the oven, or bit 6", all(
        410 < registers[0] < 440 or registers[1] & 0x40 for registers in good))
    demand("the others have none", all(not registers for outcome, _, registers in recorded
                                       if outcome != "answered"))
    report = read_json(scratch / "report.json")["oven"]
    print("emulator:", report)
    demand("nothing but reads came over the line", report["unreadable"] == report["for_other_units"]
           == report["broadcasts"] == report["resets"] == 0)
    log = (scratch / "a351d.log").read_text()
    for state in ("answering", "silent", "disturbed"):
        demand(f"the log has told when the oven was {state}", f"oven: {state} (" in log)


def main():
    with Scratch() as scratch:
        session = Session(scratch)
        try:
            play_all(scratch, session)
        finally:
            session.sim.kill()
            session.daemon.kill()


if __name__ == "__main__":
    sys.exit(main())
