"""Kills the daemon with kill -9 at random times, also during start and recovery.

Samples that were published as journaled must stay, and no sample may be altered.  Every session has one emulator and many
runs ("lives") of the daemon.  Most sessions run at 20x; a few kills are at factor 1, where the loss has its real limit.

After a kill the new daemon adopts the running stream if the counter shows how many samples are missing.  At 20x the samples
that the killed daemon had read but not written may cover more than the second of signal for which this is certain; then
the daemon configures the sensor again.  Both are correct at 20x; at factor 1 some streams must be adopted.

The limits are for the daemon, not for the host: a session whose emulator was delayed by the host is repeated, and if all
repetitions are delayed, the test is skipped.

A kill loses nothing that was handed to the kernel, so the data may be in memory.
"""

import collections
import datetime
import json
import random
import signal
import threading
import time

from emulated_session import DELAY_NS, INTACT, Session, wait_for
from programs import IS_LONG, TOOLS, Scratch, contents, daemon_status, demand, end_cleanly, instant, run, skip

RATE_HZ = 50
LOSS_S = 0.2  # Largest loss before a kill, in s of real time.
LATE_S = 0.1  # Largest lateness of the emulator, in s of real time.  If it is later, the host has delayed the daemon too.
TRIALS = 3
LEFT_OPEN = 200  # Frames of the last stream; with fewer than about 100 a clean end leaves archiving to the next start.
# Largest time error of any sample, in s of simulated time, by speed.  In host time the limit is 10 ms at both speeds.
TIME_ERROR_S = {1: 0.01, 20: 0.2}

Life = collections.namedtuple("Life", "killed_ns phase")  # Simulated time of the kill, and the daemon's phase at that time.
Part = collections.namedtuple("Part", "session began_ns samples")  # Samples that follow one header of the journal.
Gap = collections.namedtuple("Gap", "kills is_adopted before_kill whole")  # Missing samples between two parts; may be none.


class Killed(Session):
    """Session whose daemon is killed repeatedly."""

    def __init__(self, scratch, speed, storage):
        self.speed, self.lives, self.published = speed, [], set()
        # A stay runs from the start, so that most lives have a corrector beside the recording.
        super().__init__(scratch, storage=storage, speed=speed, prepare_port=lambda _: self.log_start(),
                         config='[survey]\nsites = "sites.csv"\ngravity_every_min = 0.01\n')

    def log_start(self):
        start = self.clock.split("@")[1].split(",")[0]
        events = self.scratch / "data" / "events"
        events.mkdir(parents=True)
        (events / f"{start[:7]}.jsonl").write_text(json.dumps({"type": "start", "utc": start, "site": "No.0"}) + "\n")

    def simulated_ns(self):
        start, host = (instant(part) for part in self.clock.split("@")[1].split(","))
        epoch = datetime.datetime.fromtimestamp(0, datetime.timezone.utc)
        seconds = time.time() - (host - epoch).total_seconds()
        return round(((start - epoch).total_seconds() + self.speed * seconds) * 1e9)

    def kill_after(self, seconds, begun="", has_begun=lambda: True):
        """Kills the daemon these seconds after `has_begun` and watches it until then; `begun` names the event in messages."""
        end = time.monotonic() + 60
        while not has_begun():
            if time.monotonic() > end or self.daemon.poll() is not None:
                demand(f"the daemon {begun} within 60 s: {self.said_by_last()}", False)
        timer = threading.Timer(seconds, self.kill)
        timer.start()
        while self.daemon.poll() is None:
            self.publishes()
        timer.join()
        if self.daemon.returncode != -signal.SIGKILL:
            demand(f"only the kill ends the daemon: status {self.daemon.returncode}, {self.said_by_last()}", False)
        if not self.is_archive_whole():
            demand("right after a kill the archive consists of whole records, except at its end", False)
        self.recovery_is_good()
        self.lives.append(Life(self.killed_ns, self.phase()))

    def kill(self):
        self.killed_ns = self.simulated_ns()
        self.daemon.kill()

    def publishes(self):
        """Returns True if the running daemon has published a journaled index; after its start it has none."""
        time.sleep(0.02)
        state = daemon_status(self.port)
        if not state or state["journaled"] is None:
            return False
        self.published.add((state["session"], state["journaled"]))
        return True

    def kill_in(self, phase, generator):
        """Kills the daemon in a phase.  Recording begins with the first published index, so each such life must publish one."""
        if phase == "recording":
            self.kill_after(generator.uniform(0.0, 3.0), "publishes", self.publishes)
        elif phase == "recovery":  # Recovery begins when the page is served and takes about 10 ms.
            self.kill_after(generator.uniform(0.0, 0.004), "serves its page", lambda: "page at" in self.said_by_last())
        elif phase == "start":  # The page is served after about 20 ms.
            self.kill_after(generator.uniform(0.0, 0.01))
        else:
            self.kill_after(0.002 * 500 ** generator.random())

    def phase(self):
        """Returns the phase in which the last life was killed, found from its log."""
        said = self.said_by_last()
        if "page at" not in said:
            return "start"
        return "recording" if "records added" in said else "recovery"

    def recovery_is_good(self):
        bad = [line for line in self.said_by_last().splitlines() if "error: recovery" in line]
        if bad:
            demand(f"recovery agrees with the archive and finds the whole journal: {bad}", False)

    def start_again(self):
        self.log.close()
        self.log = open(self.scratch / "a351d.log", "w")
        self.daemon = self.start_daemon()

    def said_by_last(self):
        return (self.scratch / "a351d.log").read_text()

    def files(self):
        return contents(self.scratch / "data" / "archive", "*.D.*")

    def is_archive_whole(self):
        return all(data[at:at + 6].isdigit() and data[at + 6:at + 7] == b"D" for data in self.files().values()
                   for at in range(0, len(data) // 512 * 512, 512))

    def recovery_adds_nothing(self):
        before = self.files()
        self.start_again()
        wait_for("the journal is replayed", lambda: "records added" in self.said_by_last())
        end_cleanly("a daemon without its sensor", self.daemon)
        said = [line for line in self.said_by_last().splitlines() if "recovery" in line]
        demand(f"a start after a clean end adds no record and reports no error: {said}",
               len(said) == 1 and " 0 records added" in said[0])
        demand(f"the archive of {len(before)} files is unchanged", len(before) > 4 and self.files() == before)

    def journal(self):
        parts = []
        for line in run(TOOLS / "journal-samples", self.scratch / "data" / "journal").stdout.splitlines():
            words = line.split()
            if len(words) == 2:
                parts.append(Part(words[0], int(words[1]), []))
            else:
                parts[-1].samples.append(tuple(map(int, words)))
        return parts

    def archive_is_journal(self, parts):
        """Demands that the archive holds each sample of the journal once, in the same order."""
        out = self.scratch / "counts"
        out.mkdir()
        run(TOOLS / "archive-samples", self.scratch / "data" / "archive", out)
        samples = [sample for part in parts for sample in part.samples]
        for place, channel in enumerate(("BN1", "BN2", "BNZ", "BK1"), start=2):
            demand(f"{channel}: the archive holds the {len(samples)} samples of the journal, bit for bit",
                   [int(line) for line in open(out / channel)] == [sample[place] for sample in samples])
        held = {(part.session, sample[0]) for part in parts for sample in part.samples}
        demand(f"all {len(self.published)} indices that were published as journaled are in the journal",
               self.published <= held)

    def gaps(self, parts):
        """Returns the gaps between the parts of the journal; demands that the journal lacks no other samples of the truth."""
        rows = [row for row in self.rows() if row[8] == INTACT]
        at, before, gaps = 0, Part(None, 0, []), []
        for part in parts:
            for sample in part.samples:
                first = at
                while at < len(rows) and (rows[at][5], *rows[at][1:5]) != sample[1:]:
                    at += 1
                if at == len(rows):
                    demand(f"sample {sample} of the journal was sent, after the sample before it", False)
                kills = [life.killed_ns for life in self.lives if before.began_ns < life.killed_ns < part.began_ns]
                if at > first or (kills and before.samples):
                    gaps.append(self.gap(kills, before.session == part.session, rows[first:at], rows[at][6]))
                before = part
                at += 1
        demand(f"no sample is missing at the end: {len(rows) - at}", at == len(rows))
        return gaps

    @staticmethod
    def gap(kills, is_adopted, missing, next_run):
        if not kills:
            demand(f"samples are missing only at kills: {len(missing)} elsewhere", False)
        if not is_adopted and any(row[6] == next_run for row in missing):
            demand("a new session has all samples of its run", False)
        return Gap(len(kills), is_adopted, sum(row[0] + DELAY_NS < kills[0] for row in missing), len(missing))


def session_of_kills(number, kills, speed):
    """Kills the daemon once during start, once during recovery, and otherwise early (a third of the kills) or while recording.

    @return  number of kills in each phase; None if the host delayed the emulator
    """
    generator = random.Random(number)
    aims = {kills // 2: "start", kills - 1: "recovery"}
    with Scratch(in_memory=True) as scratch:
        # Every second session has records of a second.
        session = Killed(scratch, speed, "record_age_s = 1\n" if number % 2 else "")
        for kill in range(kills):
            session.kill_in(aims.get(kill, "early" if generator.random() < 1 / 3 else "recording"), generator)
            session.start_again()
        wait_for("the last life records", session.publishes)
        wait_for("the last stream is long enough", lambda: session.emulated()["runs"][-1]["frames"] > LEFT_OPEN)
        report, _ = session.end()
        session.recovery_is_good()
        session.recovery_adds_nothing()
        parts = session.journal()
        session.archive_is_journal(parts)
        counted = session.counted()
        gaps = session.gaps(parts)
        late_s = report["largest_lateness_real_s"]
        time_error_s = max(channel["largest_time_error_s"] for channel in counted.values())
        # On a busy host the terminal may keep unread frames.  They are lost if the sensor is configured again, or if the next
        # life is killed before it writes them.  At 20x such losses are not limited by the daemon, so they do not count.
        once = [gap for gap in gaps if gap.is_adopted and gap.kills == 1]
        phases = collections.Counter(life.phase for life in session.lives)
        bound = LOSS_S * RATE_HZ * speed
        print(f"#{number}, factor {speed}: {kills} kills ({dict(phases)}), "
              f"{len({part.session for part in parts})} sessions of sampling, "
              f"stream adopted {sum(gap.is_adopted for gap in gaps)} of {len(gaps)} times; "
              f"largest loss of an adopted stream {max((gap.whole for gap in once), default=0)} samples, "
              f"of any before the kill {max((gap.before_kill for gap in gaps), default=0)}, of {bound:.0f} allowed; "
              f"largest error in time {time_error_s:.6f} s; the emulator was late by up to {late_s:.3f} s", flush=True)
        if late_s > LATE_S:
            return None
        demand(f"largest time error {time_error_s} s, limit {TIME_ERROR_S[speed]}",
               time_error_s < TIME_ERROR_S[speed])
        too_large = [gap for gap in once if gap.whole > bound]
        demand(f"at most {bound:.0f} samples are missing after a kill if the stream was adopted; exceptions: "
               f"{too_large or 'none'}", too_large == [])
        if speed == 1:
            demand(f"some streams are adopted after a kill: {len(once)}", once != [])
            too_large = [gap for gap in gaps if gap.before_kill > bound]
            demand(f"at most {bound:.0f} samples sent before a kill are missing, adopted or not; exceptions: "
                   f"{too_large or 'none'}", too_large == [])
        return phases


def judged(number, kills, speed):
    """Returns the phases of a session that the host did not delay; None if it delayed every trial."""
    for trial in range(TRIALS):
        phases = session_of_kills(number, kills, speed)
        if phases:
            return phases
        print(f"#{number}: the host delayed the emulator by more than {LATE_S} s, trial {trial + 1} of {TRIALS}")
    return None


begin = time.monotonic()
sessions = [judged(number, 20 if IS_LONG else 10, 20) for number in range(1, 16 if IS_LONG else 3)]
at_1 = judged(100, 20 if IS_LONG else 8, 1)
phases = sum(filter(None, sessions), collections.Counter())
print(f"{sum(phases.values())} kills at factor 20: {dict(phases)}; {time.monotonic() - begin:.0f} s")
if None in (*sessions, at_1):
    skip("the host delayed the emulator in every trial of a session, so the limits of the daemon cannot be tested")
demand(f"the daemon was killed during start and during recovery: {dict(phases)}",
       phases["start"] > 0 and phases["recovery"] > 0)
