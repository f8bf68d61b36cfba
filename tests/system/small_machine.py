"""The daemon on a small computer: 5 % of one core, 128 MB, a disk of 2 MB/s whose syncs take 300 ms.

usage: small_machine.py [short | hour | ten-hours | viewer]
With A351_LONG=1, or with `short`, two lives of 8 s at factor 1 with an open page.  hour: an hour at factor 1; viewer: the same with
an open page; ten-hours: ten hours of signal at 10x.  They take an hour each.

Each kill is a power cut for the journal: it is cut to what its last sync had made safe.  The samples lost before the kill must
not cover more than the bound, and everything that was shown as journaled must be there.  The figures are printed.
"""

import collections
import datetime
import os
import pathlib
import signal
import struct
import subprocess
import sys
import threading
import time

from control_group import SmallMachine
from emulated_session import INTACT, Session, wait_for
from live_stream import messages, open_stream
from programs import IS_LONG, TOOLS, Scratch, daemon_status, demand, skip

Form = collections.namedtuple("Form", "speed lives life_s has_viewer")
FORMS = {"short": Form(1, 2, 8, True), "hour": Form(1, 12, 300, False), "viewer": Form(1, 12, 300, True),
         "ten-hours": Form(10, 12, 300, False)}
SYNC_S = 0.3
BOUND_S = 0.95 + SYNC_S  # a351d(1), DATA THAT CAN BE LOST
# Delay from the time of a sample to the sending of its frame, as in kill_daemon.py.
DELAY_NS = 63_875_000 + 430_000 + 24 * 10 * 1_000_000_000 // 460_800
ROW = struct.Struct("<q4iHHIB7x")  # sim/truth/truth-format.md
STARTING_S = 90
# Reasons that belong to a start.
STARTING = "timing: unlocked", "archive: the last run's data", "no data: ", "No values arrive: last sample", "Values arrive. "
HOST_STALLS = "the disk stalls"  # The disk of this host, which other programs use too.


def ns_of(text):
    return round(datetime.datetime.fromisoformat(text.replace("Z", "+00:00")).timestamp() * 1e6) * 1000


def cpu_s(pid):
    """Returns the processor time of a process and its children."""
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return sum(map(int, fields[11:15])) / os.sysconf("SC_CLK_TCK")


def number_in(pid, file, name):
    lines = pathlib.Path(f"/proc/{pid}/{file}").read_text().splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith(name))


class Life:
    """A life of the daemon.  Times are simulated."""

    def __init__(self):
        self.recording_ns = None  # From when on it surely records.
        self.cut_ns = None


class SmallSession(Session):
    """Session of a daemon on the small machine, whose power is cut at the end of each life."""

    def __init__(self, scratch, name, form):
        self.form, self.machine = form, SmallMachine(name, scratch)
        self.lives, self.published, self.troubles = [], collections.defaultdict(set), collections.Counter()
        self.figures, self.looks, self.seen = collections.Counter(), 0, 0
        self.syncs = scratch / "syncs.txt"
        (scratch / "days.toml").write_text('base = "week"\nname = "days"\n[schedule]\nduration_h = 24\n')
        super().__init__(scratch, speed=form.speed, scenario="days.toml", preexec_fn=self.machine.enter,
                         env={**os.environ, "LD_PRELOAD": str(TOOLS / "libslow-disk.so"), "A351_SYNC_MS": f"{1000 * SYNC_S:.0f}",
                              "A351_SYNCS": str(self.syncs)})
        self.start_ns, self.host_ns = map(ns_of, self.clock.split("@")[1].split(","))

    def simulated_ns(self):
        return self.start_ns + self.form.speed * (time.time_ns() - self.host_ns)

    def live(self):
        """Watches one life of the daemon, and cuts its power."""
        begin, life = time.monotonic(), Life()
        wait_for("the daemon records", lambda: (daemon_status(self.port) or {}).get("journaled"))
        life.recording_ns = self.simulated_ns()
        viewer = threading.Thread(target=self.view, daemon=True)
        if self.form.has_viewer:
            viewer.start()
        while (age_s := time.monotonic() - begin) < self.form.life_s:
            self.look(age_s)
            time.sleep(min(5.0, self.form.life_s / 8))
        self.look(age_s)
        self.measure(age_s)
        life.cut_ns = self.simulated_ns()
        self.daemon.kill()
        self.daemon.wait()
        self.lives.append(life)
        self.cut_journal()

    def look(self, age_s):
        state = daemon_status(self.port)
        if not state:
            demand(f"the daemon answers {age_s:.0f} s after its start", False)
        self.looks += 1
        self.published[state["session"]].add(state["journaled"])
        self.troubles.update(reason for reason in state["reasons"] if age_s > STARTING_S or not reason.startswith(STARTING))
        self.figures["longest sync, ms"] = max(self.figures["longest sync, ms"], state["disk"]["longest_sync_ms"])

    def view(self):
        try:
            for _ in messages(open_stream(self.port)):
                self.seen += 1
        except OSError:  # The daemon was killed.
            pass

    def measure(self, age_s):
        pid = self.daemon.pid
        self.figures.update({"s": age_s, "CPU, s": cpu_s(pid), "bytes in whole pages": number_in(pid, "io", "write_bytes:")})
        self.figures["peak, kB"] = max(self.figures["peak, kB"], number_in(pid, "status", "VmHWM:"))

    def cut_journal(self):
        """Cuts each segment to the size at its last sync."""
        safe = dict(reversed(line.split(" ", 1)) for line in self.syncs.read_text().splitlines())
        for file in (self.scratch / "data" / "journal").glob("*.a351j"):
            size = int(safe.get(str(file.resolve()), 0))
            if 0 < size < file.stat().st_size:
                os.truncate(file, size)

    def print_figures(self):
        data, hours = str((self.scratch / "data").resolve()) + "/", self.figures["s"] / 3600
        paths = [line.split(" ", 1)[1] for line in self.syncs.read_text().splitlines()]
        places = collections.Counter(path[len(data):].split("/")[0] if path.startswith(data) else "data" for path in paths)
        print(f"an hour costs {self.figures['CPU, s'] / hours:.1f} s of the core, for which the daemon waited "
              f"{self.machine.throttled_s() / hours:.0f} s; {self.figures['bytes in whole pages'] / hours / 1e6:.1f} MB "
              f"written in whole pages; {len(paths) / hours:.0f} syncs: "
              f"{ {place: round(count / hours) for place, count in places.items()} }; longest "
              f"{self.figures['longest sync, ms']} ms; peak memory {self.figures['peak, kB'] / 1024:.1f} MB; "
              f"{self.seen} messages to the viewer")

    def compare(self):
        """Returns the number of samples in the journal and the times of those it lacks; demands that it has all that was published."""
        command = [TOOLS / "journal-samples", self.scratch / "data" / "journal"]
        journal = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        rows = (row for row in ROW.iter_unpack((self.scratch / "truth.bin").read_bytes()[16:]) if row[8] == INTACT)
        published = {session: indices - {None} for session, indices in self.published.items()}
        shown, held, missing = sum(map(len, published.values())), 0, []
        for line in journal.stdout:
            first, *values = line.split()
            if len(values) == 1:
                left = published.get(first, set())
                continue
            left.discard(int(first))
            held += 1
            sample = tuple(map(int, values))
            while (row := next(rows, None)) and (row[5], *row[1:5]) != sample:
                missing.append(row[0])
            if not row:
                demand(f"sample {first} of the journal was sent, after the sample before it", False)
        missing += [row[0] for row in rows]
        left = sum(map(len, published.values()))
        demand(f"of {shown} indices that were shown as journaled, {left} are not in the journal", left == 0)
        return held, missing

    def losses_s(self, missing):
        """Returns for each power cut the real time before it that is lost; demands that nothing else is missing."""
        losses, last = [0.0] * len(self.lives), 0
        for sent_ns in (instant + DELAY_NS for instant in missing):
            while last + 1 < len(self.lives) and sent_ns >= self.lives[last + 1].recording_ns:
                last += 1
            losses[last] = max(losses[last], (self.lives[last].cut_ns - sent_ns) / 1e9 / self.form.speed)
        return losses


def go(form):
    with Scratch() as scratch:
        try:
            session = SmallSession(scratch, f"{form.speed}-{form.has_viewer}", form)
        except OSError as error:
            skip(f"this host lets nobody make control groups here: {error}")
        print(form, session.machine.unlimited or "the disk is limited too")
        for life in range(form.lives):
            if life > 0:
                session.daemon = session.start_daemon()
            session.live()
        session.sim.send_signal(signal.SIGTERM)
        session.sim.wait(timeout=30)
        session.print_figures()
        held, missing = session.compare()
        losses = session.losses_s(missing)
        demand(f"the open page got {session.seen} messages", session.seen > 0 or not form.has_viewer)
        print(f"{held} samples in the journal, {len(missing)} sent before cuts or while no daemon ran; lost before each cut, in s: "
              f"{[round(loss, 2) for loss in losses]}")
        demand(f"at most {max(losses):.2f} s are lost, bound {BOUND_S:.2f}", max(losses) <= BOUND_S)
        stalls = session.troubles.pop(next((reason for reason in session.troubles if reason.startswith(HOST_STALLS)), None), 0)
        demand(f"the status is good at {session.looks} looks, apart from {stalls} stalls of this host's disk: "
               f"{dict(session.troubles)}", not session.troubles)


if len(sys.argv) == 1 and not IS_LONG:
    skip("needs the host's disk for itself: other programs' syncs are longer than those of the slow disk; set A351_LONG=1 to run it")
go(FORMS[sys.argv[1] if len(sys.argv) > 1 else "short"])
