"""Replays a recorded journal to a new daemon, which must record the same bytes, samples, gaps and counters.

A replayed archive must give the same samples.
"""

import datetime
import json
import signal
import subprocess
import sys
import time

from programs import (BIN, IS_SANITIZED, ONE_SITE, TOOLS, TOP, Scratch, daemon_config, daemon_status, demand, run, together,
                      unused_port)

LOGS = TOP / "tests" / "golden" / "logs"
sys.dont_write_bytecode = True
sys.path.insert(0, str(LOGS))
import journal_page  # noqa: E402

SPEED = 20
STREAM_COUNTERS = ["bytes", "frames", "bytes_skipped", "checksum_errors", "framing_errors", "gaps",
                   "samples_missing", "duplicates", "anomalies", "error_flags", "sessions"]


def rfc3339(seconds):
    return datetime.datetime.fromtimestamp(seconds, datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%S.%fZ")


class Daemon:
    """a351d in its own directory; the emulator's link `sensor` is its port."""

    def __init__(self, directory, clock=None, change=""):
        self.http = unused_port()
        (directory / "a351d.toml").write_text(
            daemon_config(self.http).replace("[storage]", change + "[storage]"))
        command = [BIN / "a351d", "--config", "a351d.toml"] + (["--clock", clock] if clock else [])
        self.log = open(directory / "a351d.log", "a")
        self.process = subprocess.Popen(command, cwd=directory, stderr=self.log)

    def status(self):
        return daemon_status(self.http)

    def counters(self):
        """Returns the counters of the stream after they have not changed for 0.6 s."""
        before, since = None, time.monotonic()
        while time.monotonic() - since < 0.6:
            state = self.status()
            now = state and {key: state["counters"][key] for key in STREAM_COUNTERS}
            if now != before:
                before, since = now, time.monotonic()
            time.sleep(0.05)
        return before

    def end(self):
        self.process.send_signal(signal.SIGTERM)
        demand("the daemon ends cleanly", self.process.wait(timeout=30) == 0)
        self.log.close()


def streams(journal):
    """Returns the received bytes of each session, in order."""
    sessions = {}
    for file in sorted(journal.glob("*.a351j")):
        for kind, payload in journal_page.chunks(file):
            if kind == journal_page.HEAD:
                session = json.loads(payload)["session"]
            elif kind == journal_page.RX:
                for _, data in journal_page.reads(payload):
                    sessions.setdefault(session, bytearray()).extend(data)
    return list(sessions.values())


def samples(directory):
    """Returns counts, first and last time of each sampled channel.

    Channels of 1 Hz are left out: they follow the seconds of UTC, which fall elsewhere between the samples of a replay.
    """
    out = directory / "counts"
    out.mkdir(exist_ok=True)
    channels = {}
    for line in run(TOOLS / "archive-samples", directory / "data" / "archive", out).stdout.splitlines():
        fields = dict(part.split("=", 1) for part in line.split())
        if not fields["channel"].startswith("L"):
            channels[fields["channel"]] = ((out / fields["channel"]).read_text(), fields["first"], fields["last"])
    return channels


def seconds_of(utc):
    return datetime.datetime.fromisoformat(utc.replace("Z", "+00:00")).timestamp()


# Three minutes before midnight.
SCENARIO = """base = "ideal"
name = "midnight"
[schedule]
start_utc = "2017-07-15T23:57:00Z"
duration_h = 1.0
""" + ONE_SITE

# Number of frames made before the fault, kind of the fault, and its keys.
FAULTS = [(1000, "flip_bit", "count = 3"), (1500, "lose_frames", "count = 7"), (2000, "drop_bytes", "bytes = 5"),
          (2500, "garbage", "bytes = 60"), (3000, "duplicate_frame", "count = 4"), (3500, "error_flags", "count = 2"),
          (6000, "stop", "")]


def record(directory):
    """Records sessions with damage across midnight, one ended by a fault, two by SIGTERM; returns the counters."""
    directory.mkdir()
    (directory / "midnight.toml").write_text(SCENARIO)
    (directory / "faults.toml").write_text("".join(
        f"[[fault]]\nkind = \"{kind}\"\nat_frame = {frame}\n{keys}\n" for frame, kind, keys in FAULTS))
    plan = run(BIN / "a351-sim", "plan", "--scenario", directory / "midnight.toml", "--out", directory / "plan")
    start = dict(part.split("=", 1) for part in plan.stdout.split())["start_utc"]
    clock = f"scaled:{SPEED}@{start},{rfc3339(time.time())}"
    daemon = Daemon(directory, clock)
    for stay_s in (13, 8):
        sim = subprocess.Popen([BIN / "a351-sim", "device", "--link", "sensor", "--scenario", "midnight.toml",
                                "--faults", "faults.toml", "--clock", clock], cwd=directory, stderr=subprocess.DEVNULL)
        time.sleep(stay_s)
        sim.send_signal(signal.SIGTERM)
        demand("the emulated device ends cleanly", sim.wait(timeout=30) == 0)
    counters = daemon.counters()
    daemon.end()
    return counters


def replay(title, directory, files, *arguments, clock=None, stopped_s=0.0):
    """Replays `files` to a new daemon and returns its counters of the stream.

    @param stopped_s  time for which the replay is stopped, once the daemon has received data
    """
    directory.mkdir()
    sim = subprocess.Popen([BIN / "a351-sim", "replay", "--link", "sensor", *arguments, *map(str, files)],
                           cwd=directory, stderr=subprocess.PIPE, text=True)
    daemon = Daemon(directory, clock)
    if stopped_s > 0.0:
        while not ((state := daemon.status()) and state["counters"]["frames"] > 0):
            time.sleep(0.05)
        sim.send_signal(signal.SIGSTOP)
        time.sleep(stopped_s)
        sim.send_signal(signal.SIGCONT)
    words = sim.communicate(timeout=300)[1]
    print(f"{title}: {words!r}")
    demand(f"{title}: the replay ends by itself, with a message only if it was stopped",
           sim.returncode == 0 and (words == "" or stopped_s > 0.0))
    counters = daemon.counters()
    daemon.end()
    return counters


def demand_same(title, one, other, is_timed=True):
    """Demands that two daemons archived the same samples, and returns the shifts of the first and last times in s.

    @param is_timed  False at max speed: the times of the runs overlap there, so their order in the archive may differ
    """
    order = list if is_timed else sorted
    held, again = samples(one), samples(other)
    demand(f"{title}: the same channels, {sorted(again)}", sorted(held) == sorted(again) != [])
    for channel, (counts, first, last) in held.items():
        demand(f"{title}: {channel}: {counts.count(chr(10))} samples, bit for bit the same",
               order(again[channel][0].splitlines()) == order(counts.splitlines()) != [])
    return {channel: (seconds_of(again[channel][1]) - seconds_of(first), seconds_of(again[channel][2]) - seconds_of(last))
            for channel, (_, first, last) in held.items()}


def refuse(title, directory, status, parts, *command):
    result = run(BIN / "a351-sim", "replay", *command, check=False, cwd=directory)
    line = result.stderr.strip()
    print(f"{title}: {line}")
    demand(f"{title}: status {status}", result.returncode == status)
    demand(f"{title}: one line that names {parts}", "\n" not in line and all(part in line for part in parts))


def replay_a_recording():
    first = scratch / "first"
    counters = record(first)
    print("recorded:", counters)
    recorded = streams(first / "data" / "journal")
    demand("three sessions or more were recorded", counters["sessions"] == len(recorded) >= 3)
    demand("the recording is damaged",
           all(counters[key] > 0 for key in ("bytes_skipped", "checksum_errors", "gaps", "samples_missing", "duplicates",
                                             "error_flags")))
    days = {file.name[-3:] for file in (first / "data" / "archive").rglob("*.2017.*")}
    demand(f"the recording reaches across midnight: {sorted(days)}", days == {"196", "197"})

    # The shared clock begins 3 s before the recording, which leaves time for the handshake.  If this machine pauses for half a
    # second, the daemon takes the sensor for silent and begins another session; such an attempt does not count.
    begin = seconds_of(samples(first)["BNZ"][1]) - 3 * SPEED
    for attempt in range(3):
        clock = f"scaled:{SPEED}@{rfc3339(begin)},{rfc3339(time.time())}"
        again = scratch / f"again-{attempt}"
        found = replay("in time", again, [first / "data" / "journal"], "--clock", clock, clock=clock)
        print("replayed:", found)
        if found["sessions"] == counters["sessions"]:
            break
    demand("in time: the same counters", found == counters)
    demand("in time: the same bytes in the same sessions", streams(again / "data" / "journal") == recorded)
    shifts = demand_same("in time", first, again)
    print("shifts of first and last times against the recorded ones [s]:", shifts)
    # If the daemon is still configuring when the first bytes are due, it gets them late, so the first times are not tested.
    if not IS_SANITIZED:  # Slow programs are later, by varying amounts.
        # After the silence before its session the daemon listens for up to 0.5 s, and the first bytes wait meanwhile.  Where
        # the host delays a run by 50 ms, its times shift by 1 s.
        latest = 0.5 * SPEED + 1.0
        demand(f"in time: the last sample within {latest:.0f} s of its recorded time",
               all(abs(last) < latest for _, last in shifts.values()))

    fast = scratch / "fast"
    begun = time.monotonic()
    found = replay("max", fast, sorted((first / "data" / "journal").iterdir()), "--speed", "max")
    print(f"at max: {counters['frames'] / (time.monotonic() - begun):.0f} frames/s, start and end included")
    demand("max: the same counters", found == counters)
    demand("max: the same bytes in the same sessions", streams(fast / "data" / "journal") == recorded)
    demand_same("max", first, fast, is_timed=False)

    # The daemon takes a replay that is stopped for this long for a silent sensor, and tries other baud rates.
    clock = f"scaled:100@{rfc3339(begin - 300)},{rfc3339(time.time())}"
    stalled = scratch / "stalled"
    found = replay("stalled", stalled, [first / "data" / "archive"], "--clock", clock, clock=clock, stopped_s=2.5)
    demand(f"stalled: every frame of the archive, none damaged: {found}",
           found["frames"] == counters["frames"] - counters["duplicates"] and found["bytes_skipped"] == 0)

    encoded = scratch / "encoded"
    found = replay("archive", encoded, [first / "data" / "archive"], "--speed", "max")
    demand("archive: the same number of frames, none damaged",
           found["frames"] == counters["frames"] - counters["duplicates"] and found["bytes_skipped"] == 0)
    demand_same("archive", first, encoded, is_timed=False)


def replay_golden_logs():
    # gap_over_a_wrap is left out: it is silent for so long that a daemon begins a new session.
    for log in sorted(LOGS.glob("*.a351j")):
        if log.stem == "gap_over_a_wrap":
            continue
        expected = dict(line.split() for line in log.with_suffix(".counters").read_text().splitlines())
        found = replay(log.stem, scratch / log.stem, [log], "--speed", str(SPEED))
        demand(f"{log.stem}: the daemon's counters are those listed for the log",
               all(found[key] == int(value) for key, value in expected.items()))


def replay_bad_recordings():
    bad = scratch / "bad"
    bad.mkdir()
    (bad / "empty").write_bytes(b"")
    (bad / "text").write_text("no journal\n" * 100)
    (bad / "directory").mkdir()
    log = (LOGS / "clean_start.a351j").read_bytes()
    (bad / "headless").write_bytes(log[:200])
    for name in ("absent", "empty", "text", "directory", "headless"):
        refuse(name, bad, 2, [name, "allowed"], "--link", "sensor", name)
    refuse("speed", bad, 2, ["--speed", "quick", "max"], "--link", "sensor", "--speed", "quick", LOGS / "duplicates.a351j")
    demand("nothing was written", sorted(path.name for path in bad.iterdir()) ==
           ["directory", "empty", "headless", "text"])

    # A journal cut off at its end: the good part is replayed, the rest is reported.  Other sensor settings: refused, status 1.
    (bad / "torn.a351j").write_bytes(log[:-100])
    for title, change, status, parts in (
            ("torn", "", 0, ["torn.a351j", "torn chunk"]),
            ("settings", "output_rate_hz = 200\nfilter = \"k512_fc60\"\n", 1, ["200 Hz", "50 Hz", "clean_start"])):
        directory = scratch / title
        directory.mkdir()
        sim = subprocess.Popen([BIN / "a351-sim", "replay", "--link", "sensor", "--speed", "max",
                                bad / "torn.a351j" if title == "torn" else LOGS / "clean_start.a351j"],
                               cwd=directory, stderr=subprocess.PIPE, text=True)
        daemon = Daemon(directory, change=change)
        line = sim.communicate(timeout=60)[1].strip()
        print(f"{title}: {line}")
        demand(f"{title}: status {status}", sim.returncode == status)
        demand(f"{title}: one line that names {parts}", "\n" not in line and all(part in line for part in parts))
        daemon.end()


with Scratch() as scratch:
    together(replay_a_recording, replay_golden_logs, replay_bad_recordings)  # They wait most of their time.
