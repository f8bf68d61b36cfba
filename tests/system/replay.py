"""A recorded journal through a fresh daemon: the same bytes, samples, gaps and counters; an archive: the same samples."""

import datetime
import json
import signal
import subprocess
import sys
import time

from programs import BIN, IS_SANITIZED, ONE_SITE, TOOLS, TOP, Scratch, daemon_config, daemon_status, demand, run, unused_port

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
    """a351d in a directory of its own; `port` names the sensor's link."""

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
        """Of the stream, once they stand still."""
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
    """The received bytes of each session, in order."""
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
    """Per sampled channel: its counts, first and last instant.  The derived ones of 1 Hz follow the seconds of UTC, which
    fall elsewhere between the samples of a replay."""
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


# Five minutes before midnight.
SCENARIO = """base = "ideal"
name = "midnight"
[schedule]
start_utc = "2017-07-15T23:55:00Z"
duration_h = 1.0
""" + ONE_SITE

# By frames made: kind, its keys.
FAULTS = [(1000, "flip_bit", "count = 3"), (1500, "lose_frames", "count = 7"), (2000, "drop_bytes", "bytes = 5"),
          (2500, "garbage", "bytes = 60"), (3000, "duplicate_frame", "count = 4"), (3500, "error_flags", "count = 2"),
          (9000, "stop", "")]


def record(directory):
    """Sessions of a damaged day across midnight: one ended by a fault, two by SIGTERM to the emulator."""
    directory.mkdir()
    (directory / "midnight.toml").write_text(SCENARIO)
    (directory / "faults.toml").write_text("".join(
        f"[[fault]]\nkind = \"{kind}\"\nat_frame = {frame}\n{keys}\n" for frame, kind, keys in FAULTS))
    plan = run(BIN / "a351-sim", "plan", "--scenario", directory / "midnight.toml", "--out", directory / "plan")
    start = dict(part.split("=", 1) for part in plan.stdout.split())["start_utc"]
    clock = f"scaled:{SPEED}@{start},{rfc3339(time.time())}"
    daemon = Daemon(directory, clock)
    for stay_s in (25, 12):
        sim = subprocess.Popen([BIN / "a351-sim", "device", "--link", "sensor", "--scenario", "midnight.toml",
                                "--faults", "faults.toml", "--clock", clock], cwd=directory, stderr=subprocess.DEVNULL)
        time.sleep(stay_s)
        sim.send_signal(signal.SIGTERM)
        demand("the emulated device ends cleanly", sim.wait(timeout=30) == 0)
    counters = daemon.counters()
    daemon.end()
    return counters


def replay(title, directory, files, *arguments, clock=None):
    """A fresh daemon is told what `files` hold: its counters of the stream."""
    directory.mkdir()
    sim = subprocess.Popen([BIN / "a351-sim", "replay", "--link", "sensor", *arguments, *map(str, files)],
                           cwd=directory, stderr=subprocess.PIPE, text=True)
    daemon = Daemon(directory, clock)
    words = sim.communicate(timeout=300)[1]
    demand(f"{title}: the replay ends by itself and has nothing to say {words!r}",
           sim.returncode == 0 and words == "")
    counters = daemon.counters()
    daemon.end()
    return counters


def demand_same(title, one, other, is_timed=True):
    """Two daemons archived the same.  At max speed the times of runs overlap, and with them their order in an archive."""
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


with Scratch() as scratch:
    first = scratch / "first"
    counters = record(first)
    print("recorded:", counters)
    recorded = streams(first / "data" / "journal")
    demand("three sessions or more were recorded", counters["sessions"] == len(recorded) >= 3)
    demand("the recording is damaged",
           all(counters[key] > 0 for key in ("bytes_skipped", "checksum_errors", "gaps", "samples_missing", "duplicates",
                                             "error_flags")))
    days = {file.name[-3:] for file in (first / "data" / "archive").rglob("*.2017.*")}
    demand(f"it reaches across midnight: {sorted(days)}", days == {"196", "197"})

    # The shared clock begins 3 s before the recording, time for the handshake.  Where this machine pauses for half a
    # second the daemon takes the sensor for silent and begins another session: such a try is void.
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
    print("times beside the recorded ones [s]:", shifts)
    # A host that is configuring when the first bytes fall due gets them late: the first times tell of that.
    if not IS_SANITIZED:  # They are late by more, and by more at one time than at another.
        demand("in time: the last sample within 0.2 s of its recorded time",
               all(abs(last) < 0.2 for _, last in shifts.values()))

    fast = scratch / "fast"
    begun = time.monotonic()
    found = replay("max", fast, sorted((first / "data" / "journal").iterdir()), "--speed", "max")
    print(f"at max: {counters['frames'] / (time.monotonic() - begun):.0f} frames/s, start and end included")
    demand("max: the same counters", found == counters)
    demand("max: the same bytes in the same sessions", streams(fast / "data" / "journal") == recorded)
    demand_same("max", first, fast, is_timed=False)

    encoded = scratch / "encoded"
    found = replay("archive", encoded, [first / "data" / "archive"], "--speed", "max")
    demand("archive: as many frames, none damaged",
           found["frames"] == counters["frames"] - counters["duplicates"] and found["bytes_skipped"] == 0)
    demand_same("archive", first, encoded, is_timed=False)

    # gap_over_a_wrap is silent for longer than a daemon waits before it begins a new session.
    for log in sorted(LOGS.glob("*.a351j")):
        if log.stem == "gap_over_a_wrap":
            continue
        expected = dict(line.split() for line in log.with_suffix(".counters").read_text().splitlines())
        found = replay(log.stem, scratch / log.stem, [log], "--speed", str(SPEED))
        demand(f"{log.stem}: the daemon's counters are those beside the log",
               all(found[key] == int(value) for key, value in expected.items()))

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

    # A torn tail: what is good is replayed, the rest told of.  Other settings: refused, status 1.
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
