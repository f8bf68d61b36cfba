"""kill -9 at random instants, of start and recovery too: what was published as journaled stays, nothing is altered.

Every session has one emulator and many lives of the daemon.  At 20x; and a few kills at factor 1, where the bound is
the real one.  The stream is adopted when the counter tells it: at 20x what the killed daemon had read but not written
may be more than the second of signal within which that is sure, then the sensor is configured anew.  Either is right.

A kill loses nothing that was handed to the kernel, so the data may lie in memory; a disk that stalls is another test's.
"""

import collections
import datetime
import random
import signal
import threading
import time

from emulated_session import INTACT, Session, wait_for
from programs import IS_LONG, TOOLS, Scratch, daemon_status, demand, run

RATE_HZ = 50
LOSS_S = 0.2  # Before a kill, of real time.

Life = collections.namedtuple("Life", "killed_ns phase")  # Simulated time of its end, what it did then.
Part = collections.namedtuple("Part", "session began_ns samples")  # Behind a header of the journal.
Gap = collections.namedtuple("Gap", "kills is_adopted before_kill whole")


class Killed(Session):
    """A session whose daemon is killed again and again."""

    def __init__(self, scratch, speed):
        self.speed, self.lives, self.published = speed, [], set()
        super().__init__(scratch, speed=speed)

    def simulated_ns(self):
        start, host = (datetime.datetime.fromisoformat(part) for part in self.clock.split("@")[1].split(","))
        epoch = datetime.datetime.fromtimestamp(0, datetime.timezone.utc)
        seconds = time.time() - (host - epoch).total_seconds()
        return round(((start - epoch).total_seconds() + self.speed * seconds) * 1e9)

    def kill_after(self, seconds):
        """Watches the daemon that runs until then."""
        timer = threading.Timer(seconds, self.daemon.kill)
        timer.start()
        while self.daemon.poll() is None:
            state = daemon_status(self.port)
            if state and state["journaled"] is not None:
                self.published.add((state["session"], state["journaled"]))
            time.sleep(0.02)
        killed_ns = self.simulated_ns()
        timer.join()
        if self.daemon.returncode != -signal.SIGKILL:
            demand(f"nothing but the kill ends the daemon: {self.daemon.returncode}, {self.said_by_last()}", False)
        if not self.is_archive_whole():
            demand("right after a kill the archive is whole records, but for its very end", False)
        self.lives.append(Life(killed_ns, self.phase()))

    def phase(self):
        """By what the last life said."""
        said = self.said_by_last()
        if "page at" not in said:
            return "start"
        return "recording" if "records added" in said else "recovery"

    def start_again(self):
        self.log.close()
        self.log = open(self.scratch / "a351d.log", "w")
        self.daemon = self.start_daemon()

    def said_by_last(self):
        return (self.scratch / "a351d.log").read_text()

    def files(self):
        return {file: file.read_bytes() for file in sorted((self.scratch / "data" / "archive").rglob("*.D.*"))}

    def is_archive_whole(self):
        return all(data[at:at + 6].isdigit() and data[at + 6:at + 7] == b"D" for data in self.files().values()
                   for at in range(0, len(data) // 512 * 512, 512))

    def recovery_adds_nothing(self):
        before = self.files()
        self.start_again()
        wait_for("the journal is replayed", lambda: "records added" in self.said_by_last())
        self.daemon.send_signal(signal.SIGTERM)
        demand("a daemon without its sensor ends cleanly", self.daemon.wait(timeout=30) == 0)
        said = [line for line in self.said_by_last().splitlines() if "recovery" in line]
        demand(f"after a clean end a start adds nothing and disagrees with nothing: {said}",
               len(said) == 1 and " 0 records added" in said[0])
        demand(f"the archive of {len(before)} files stays as it is", len(before) > 4 and self.files() == before)

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
        """Each sample of the journal once, in its order."""
        out = self.scratch / "counts"
        out.mkdir()
        run(TOOLS / "archive-samples", self.scratch / "data" / "archive", out)
        samples = [sample for part in parts for sample in part.samples]
        for place, channel in enumerate(("BN1", "BN2", "BNZ", "BK1"), start=2):
            demand(f"{channel}: the archive holds the {len(samples)} samples of the journal, bit for bit",
                   [int(line) for line in open(out / channel)] == [sample[place] for sample in samples])
        held = {(part.session, sample[0]) for part in parts for sample in part.samples}
        demand(f"all {len(self.published)} indices that were published as journaled are among them",
               len(self.published) > len(self.lives) / 4 and self.published <= held)

    def gaps(self, parts, late_s):
        """What of the truth the journal lacks, between two parts of it.  A frame with which the emulator was late had
        not been sent yet at the kill."""
        rows = [row for row in self.rows() if row[8] == INTACT]
        at, before, gaps = 0, Part(None, 0, []), []
        for part in parts:
            for sample in part.samples:
                first = at
                while at < len(rows) and (rows[at][5], *rows[at][1:5]) != sample[1:]:
                    at += 1
                if at == len(rows):
                    demand(f"sample {sample} of the journal was sent, after the one before it", False)
                if at > first:
                    gaps.append(self.gap(before, part, rows[first:at], rows[at][6], late_s))
                before = part
                at += 1
        demand(f"nothing is missing in the end: {len(rows) - at}", at == len(rows))
        return gaps

    def gap(self, before, after, missing, next_run, late_s):
        kills = [life.killed_ns for life in self.lives if before.began_ns < life.killed_ns < after.began_ns]
        if not kills:
            demand(f"samples are missing at a kill, not elsewhere: {len(missing)}", False)
        is_adopted = before.session == after.session
        if not is_adopted and any(row[6] == next_run for row in missing):
            demand("a new session misses nothing of its run", False)
        sent_until = kills[0] - 1e9 * self.speed * late_s
        return Gap(len(kills), is_adopted, sum(row[0] < sent_until for row in missing), len(missing))


def session_of_kills(number, kills, speed):
    """A third of the kills within half a second: 2 ms are before the page, 20 ms in the replay of the journal."""
    generator = random.Random(number)
    with Scratch(in_memory=True) as scratch:
        session = Killed(scratch, speed)
        for kill in range(kills):
            is_early = generator.random() < 1 / 3
            session.kill_after(0.5 * 0.004 ** generator.random() if is_early else generator.uniform(0.5, 4.0))
            session.start_again()
        session.wait_for_frames(500)
        report, _ = session.end()
        late_s = report["largest_lateness_real_s"]
        session.recovery_adds_nothing()
        parts = session.journal()
        session.archive_is_journal(parts)
        for name, counted in session.counted().items():
            demand(f"{name}: nothing altered or duplicated, times within 0.2 s of the truth, of real time",
                   counted["altered"] == counted["duplicated"] == 0
                   and counted["largest_time_error_s"] < (0.2 + late_s) * speed)
        gaps = session.gaps(parts, late_s)
        bound = LOSS_S * RATE_HZ * speed
        # What the terminal kept for a reader that a busy host held up is lost only when the sensor is configured anew,
        # or with a life that is killed in turn before it could write it: no bound of the daemon's.
        once = [gap for gap in gaps if gap.is_adopted and gap.kills == 1]
        too_large = [gap for gap in once if gap.whole > bound + late_s * RATE_HZ * speed]
        demand(f"no more than {bound:.0f} samples are missing at a kill after which the stream was adopted: {too_large}",
               too_large == [])
        phases = collections.Counter(life.phase for life in session.lives)
        print(f"#{number}, factor {speed}: {kills} kills ({dict(phases)}), "
              f"{len({part.session for part in parts})} sessions of sampling, {len(gaps)} gaps; "
              f"largest loss of an adopted stream {max((gap.whole for gap in once), default=0)} of {bound:.0f} samples, "
              f"of any before the kill {max((gap.before_kill for gap in gaps), default=0)}; "
              f"the emulator was late by up to {late_s:.3f} s", flush=True)
        return phases


begin = time.monotonic()
phases = collections.Counter()
for number in range(1, 16 if IS_LONG else 3):
    phases += session_of_kills(number, kills=20 if IS_LONG else 10, speed=20)
session_of_kills(100, kills=20 if IS_LONG else 5, speed=1)
print(f"{sum(phases.values())} kills at factor 20: {dict(phases)}; {time.monotonic() - begin:.0f} s")
