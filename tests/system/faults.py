"""Faults at 20x: the daemon's counters must agree with the emulator's faults, frame by frame and byte by byte."""

import json
import os
import signal
import subprocess
import time

from emulated_session import FRAME, Session, ask, gaps_of, require_unread, wait_for
from programs import BIN, Scratch, compare_truth, demand, read_json

ANSWER = 4  # Bytes

# Faults of single frames with the increase that each causes in the daemon's counters; all other counters must not change.
# The last field names counters whose increase depends on chance: a flipped bit or an extra byte may or may not hit a frame
# marker, so the skipped bytes and the gap are certain, but not how often the decoder synchronises again.
GAP_OF_3 = {"gaps": 1, "samples_missing": 3}
BY_CHANCE = ("checksum_errors", "framing_errors")
ROWS = [
    ("flip_bit count=3", {"bytes_skipped": 3 * FRAME, **GAP_OF_3}, BY_CHANCE),
    ("flip_bit count=3 bits=16", {"bytes_skipped": 3 * FRAME, **GAP_OF_3}, BY_CHANCE),
    ("bad_checksum count=3", {"checksum_errors": 3, "bytes_skipped": 3 * FRAME, **GAP_OF_3}, ()),
    ("drop_bytes count=3 bytes=7", {"bytes_skipped": 3 * (FRAME - 7), **GAP_OF_3}, BY_CHANCE),
    ("insert_bytes count=3 bytes=2", {"bytes_skipped": 3 * (FRAME + 2), **GAP_OF_3}, BY_CHANCE),
    ("garbage bytes=10000", {"bytes_skipped": 10000}, BY_CHANCE),
    ("truncate_frame count=3", {"bytes_skipped": "the rest of the frames", **GAP_OF_3}, BY_CHANCE),
    ("lose_frames count=3", GAP_OF_3, ()),
    ("duplicate_frame count=3", {"duplicates": 3}, ()),
    ("reorder_frames count=3", {"anomalies": 3, "gaps": 3, "samples_missing": 3}, ()),
    ("counter_stuck count=3", {"duplicates": 3, **GAP_OF_3}, ()),
    ("error_flags count=3 diag_stat=32", {"error_flags": 3}, ()),
    ("stall seconds=3", {}, ()),
    ("silence seconds=4", {"gaps": 1, "samples_missing": "the frames not sent"}, ()),
]

# Faults of the counter.  It shows missing samples, or no longer fits the earlier counts; times shift or start again.
COUNTER_ROWS = [
    ("counter_jump count=10", {"gaps": 1, "samples_missing": 10}, ()),
    ("counter_jump ticks=7", {"anomalies": 1, "sessions": 1}, ()),
    ("counter_reset", {"anomalies": 1, "sessions": 1}, ()),
]
WATCHED = ("bytes_skipped", "checksum_errors", "framing_errors", "gaps", "samples_missing", "duplicates",
           "anomalies", "error_flags", "sessions")

# Several faults at random times.
WITHIN_A_SESSION = """
[random]
seed = 5
flip_bit_per_h = 120
drop_bytes_per_h = 60
duplicate_frame_per_h = 60
"""


def play(session, order, expected, by_chance):
    """Orders one fault and demands the expected change of the daemon's counters."""
    before, emulated = session.settled(), session.emulated()
    session.order(order)
    time.sleep(0.1)
    kind = order.split()[0]
    wait_for(order, lambda: session.emulated()["faults"].get(kind, 0) > emulated["faults"].get(kind, 0))
    counters, after = session.settled(), session.emulated()
    came = {key: counters[key] - before[key] for key in WATCHED if key not in by_chance}
    if kind == "silence":
        expected = {**expected, "samples_missing": after["faults"][kind] - emulated["faults"].get(kind, 0)}
    if kind == "truncate_frame":
        cut = after["bytes_dropped"] - emulated["bytes_dropped"]
        expected = {**expected, "bytes_skipped": 3 * FRAME - cut}
    demand(f"{order}: the daemon counts {came}, expected {expected} and nothing else",
           came == {key: expected.get(key, 0) for key in came})
    chance = sum(counters[key] - before[key] for key in by_chance)
    if by_chance:
        demand(f"{order}: the damage is counted as errors ({chance})", chance > 0)


def bytes_agree(report, counters, outages=0):
    """On a slow host some answers come after their time-out: they are received as part of the stream."""
    unread_frames = report["frames_sent"] - counters["frames"]
    require_unread(report, unread_frames, outages)
    arrived = report["bytes_handed_over"] - report["bytes_of_answers"] - report["bytes_unread"]
    late = counters["bytes"] - arrived
    demand(f"{counters['bytes']} bytes received are the {arrived} handed over, and {late} of answers after their time-out",
           late in range(0, 5 * ANSWER, ANSWER))
    damaged = arrived - FRAME * counters["frames"]
    demand(f"{counters['bytes_skipped']} bytes skipped are the {damaged} outside whole frames and the late answers",
           counters["bytes_skipped"] == damaged + late)


with Scratch() as scratch:
    session = Session(scratch)
    session.wait_for_frames(500)
    for row in ROWS:
        play(session, *row)
    report, counters = session.end()
    bytes_agree(report, counters)
    demand("one session", counters["sessions"] == len(report["runs"]) == 1)
    session.archive_is_true(missing=0)
    first_samples = session.samples()

with Scratch() as scratch:
    session = Session(scratch)
    session.wait_for_frames(500)
    for row in COUNTER_ROWS:
        play(session, *row)
    report, counters = session.end()
    bytes_agree(report, counters)
    demand("one run of sampling gives three sessions, because the counter twice no longer fits",
           len(report["runs"]) == 1 and counters["sessions"] == 3)
    session.archive_is_true(missing=0, steps=None)

with Scratch() as scratch:
    session = Session(scratch, WITHIN_A_SESSION)
    session.wait_for_frames(50 * 100)
    report, counters = session.end()
    bytes_agree(report, counters)
    gaps, missing = gaps_of(session.truth())
    demand(f"{counters['gaps']} gaps with {counters['samples_missing']} samples missing, truth {gaps} with {missing}",
           (counters["gaps"], counters["samples_missing"]) == (gaps, missing))
    demand(f"{counters['duplicates']} duplicates, {report['frames_repeated']} were sent",
           counters["duplicates"] == report["frames_repeated"])
    demand("one session", counters["sessions"] == len(report["runs"]) == 1)
    session.archive_is_true(missing=0)

# The device stops sampling, so no frame is in transit when the daemon configures it again.
with Scratch() as scratch:
    session = Session(scratch)
    runs = 1
    for fault in ("stop", "reset", "power_cycle", "hang_up seconds=40 loses_power=true"):
        wait_for(f"run {runs}", lambda: session.emulated()["runs"][runs - 1:]
                         and session.emulated()["runs"][-1]["frames"] > 500)
        session.order(fault)
        runs += 1
        wait_for(f"sampling again after {fault}", lambda: len(session.emulated()["runs"]) == runs)
    wait_for("frames of the last run", lambda: session.emulated()["runs"][-1]["frames"] > 500)
    report, counters = session.end()
    bytes_agree(report, counters, outages=1)
    demand(f"{runs} runs of sampling give {runs} sessions", counters["sessions"] == len(report["runs"]) == runs)
    session.archive_is_true(missing=report["frames_sent"] - counters["frames"])
    common = [(values, first_samples[instant]) for instant, values in session.samples().items()
              if instant in first_samples]
    demand(f"{len(common)} samples at the same times in two runs are equal",
           len(common) > 1000 and all(one == other for one, other in common))


def wait_for_run(runs):
    """Waits in the current `session` for this run of sampling and returns the daemon's counters."""
    wait_for(f"run {runs}", lambda: len(session.emulated()["runs"]) >= runs
             and session.emulated()["runs"][-1]["frames"] > 500)
    return session.settled()


# Another rate.  Until the daemon notices, chance decides which frames it keeps, so the archive is not compared.
with Scratch() as scratch:
    session = Session(scratch)
    wait_for_run(1)
    session.order("change_settings output_rate_hz=100 filter=k512_fc16")
    counters = wait_for_run(3)
    frames = session.emulated()["runs"][1]["frames"]
    demand(f"another rate is noticed after {frames} frames, and the sensor configured again",
           frames < 1000 and counters["sessions"] == 2 and counters["bytes_skipped"] == 0)
    demand(f"{counters['anomalies']} of them are counted as anomalies, none after the new configuration",
           0 < counters["anomalies"] <= frames)
    session.end()

# Another device, or the same device with other settings.
with Scratch() as scratch:
    session = Session(scratch)
    wait_for_run(1)
    session.order("other_unit serial_number=87654321")
    demand("another unit starts a new session", wait_for_run(2)["sessions"] == 2)
    demand("the status shows the serial number of the new unit", session.status()["device"]["serial_number"] == "87654321")

    session.order("failing_tests diag_stat=32")
    session.order("power_cycle")
    demand("a unit whose self tests fail also starts a session", wait_for_run(3)["sessions"] == 3)
    demand("its self tests did fail", session.emulated()["faults"]["failing_tests"] == 1)
    session.order("failing_tests diag_stat=0")

    session.order("stop")
    before = wait_for_run(4)
    session.order("change_settings burst_ctrl=0x0702")
    counters = wait_for_run(6)
    demand("frames of another layout are skipped, and the daemon configures the sensor again",
           counters["bytes_skipped"] > before["bytes_skipped"]
           and counters["link_sessions"] > before["link_sessions"])

    report, counters = session.end()
    demand("no sample is altered or duplicated",
           all(counted["altered"] == counted["duplicated"] == 0 for counted in compare_truth(
        scratch / "data" / "archive", scratch / "truth.bin").values()))

# A receive buffer that overflows while the host does not read.  The pause is shorter than the counter's wrap, so that the
# counter alone gives the number of missing samples and no clock is needed.
with Scratch() as scratch:
    session = Session(scratch)
    session.wait_for_frames(1000)
    session.order("overrun")
    session.daemon.send_signal(signal.SIGSTOP)
    time.sleep(0.6)
    session.daemon.send_signal(signal.SIGCONT)
    session.wait_for_frames(session.emulated()["frames_sent"] + 1000)
    report, counters = session.end()
    bytes_agree(report, counters)
    demand(f"{report['frames_lost_by_overrun']} frames were lost by overrun, fewer than in one wrap of the counter",
           100 < report["frames_lost_by_overrun"] < 760)
    gaps, missing = gaps_of(session.truth())
    demand(f"{counters['gaps']} gaps with {counters['samples_missing']} samples missing, truth {gaps} with {missing}",
           (counters["gaps"], counters["samples_missing"]) == (gaps, missing))
    demand("one session", counters["sessions"] == 1)
    session.archive_is_true(missing=0)

# A scenario whose file name is not UTF-8, and links replaced by other files: the emulator continues and writes its report.
with Scratch() as scratch:
    scenario = os.fsencode(scratch) + b"/caf\xe9.toml"
    with open(scenario, "w") as text:
        text.write('base = "tsukuba"\nname = "x"\n')
    (scratch / "faults.toml").write_text('[[fault]]\nkind = "oven_unplug"\nat_s = 20\n'
                                         '[[fault]]\nkind = "oven_unplug"\nat_s = 60\ncount = 0\n')
    sim = subprocess.Popen([BIN / "a351-sim", "device", "--link", "sensor", "--oven-link", "oven", "--control",
                            "control", "--speed", "20", "--scenario", scenario, "--report", "report.json",
                            "--truth", "truth.bin", "--faults", "faults.toml"], cwd=scratch, stderr=subprocess.PIPE)
    wait_for("the control socket exists", (scratch / "control").exists)
    wait_for("the oven is unplugged", lambda: not (scratch / "oven").is_symlink())
    (scratch / "oven").write_text("somebody's")
    demand("the status is one line of JSON", json.loads(ask(scratch, "status")[3:])["frames_made"] == 0)
    ask(scratch, "hang_up seconds=10")
    wait_for("the sensor is unplugged", lambda: not (scratch / "sensor").is_symlink())
    (scratch / "sensor").write_text("somebody's")
    demand("the answer to the order names the file in the way", "oven: exists" in ask(scratch, "oven_unplug count=0"))
    wait_for("the fault of the script is refused", lambda: json.loads(ask(scratch, "status")[3:])["faults_refused"])
    ask(scratch, "quit")
    said = sim.communicate(timeout=30)[1].decode()
    demand(f"the emulator ends cleanly and has named the file in the way once: {said}",
           sim.returncode == 0 and said.count("\n") == said.count("sensor: exists") == 1)
    demand("report and truth are written", read_json(scratch / "report.json")["faults_refused"][0]["kind"]
           == "oven_unplug" and (scratch / "truth.bin").stat().st_size == 16)
    demand("the file in the way is unchanged", (scratch / "sensor").read_text() == "somebody's")
