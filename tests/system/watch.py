"""`a351ctl watch` on a pseudo-terminal of 80 x 24: the screen fits, its keys work, and the terminal is as before in the end.

A small model of a terminal draws what the program writes, and notices if it scrolls or if a line does not fit.
"""

import fcntl
import os
import pty
import re
import select
import signal
import struct
import subprocess
import sys
import termios
import threading
import time

from emulated_session import Session, wait_for
from programs import BIN, TOP, Scratch, demand, run

sys.path.append(str(TOP / "tests" / "page"))
from made_up import finding, occupation, reading, stay, survey, tilt, verdict
from stub_daemon import StubDaemon

SITES = """site,longitude_deg,latitude_deg,altitude_m,gravity_mgal
No.0,140.1,36.2,400,979861
No.1,140.1,36.21,410,
Mt Tsukuba,140.1,36.22,870,
Mt Tsukuba west,140.09,36.22,850,
"""
PLAN = '[survey]\nsites = "list.csv"\noccupation_min = 9\nset_ups = 3\n'
SEQUENCE = re.compile(r"\x1b\[(\??)([\d;]*)([A-Za-z])")


class Screen:
    """The part of a terminal that the program uses."""

    def __init__(self, columns, rows):
        self.modes = {}
        self.scrolls = self.clipped = 0
        self.colours = set()
        self.resize(columns, rows)

    def resize(self, columns, rows):
        self.columns, self.rows = columns, rows
        self.lines = [""] * rows
        self.row = self.column = 0

    def write(self, text):
        at = 0
        while at < len(text):
            found = SEQUENCE.match(text, at)
            if found:
                self.execute(*found.groups())
                at = found.end()
                continue
            self.put(text[at])
            at += 1

    def execute(self, private, numbers, letter):
        if private:
            self.modes[numbers] = letter
        elif letter == "H":
            self.row = self.column = 0
        elif letter == "K":
            self.lines[self.row] = self.lines[self.row][:self.column]
        elif letter == "J":
            self.lines[self.row] = self.lines[self.row][:self.column]
            self.lines[self.row + 1:] = [""] * (self.rows - self.row - 1)
        elif letter == "m":
            self.colours.add(numbers)
        else:
            demand(f"the sequence {letter} is known", False)

    def put(self, letter):
        if letter == "\r":
            self.column = 0
        elif letter == "\n":
            self.row += 1
            if self.row == self.rows:
                self.scrolls += 1
                self.row -= 1
        elif self.column == self.columns:
            self.clipped += 1
        else:
            line = self.lines[self.row].ljust(self.column)
            self.lines[self.row] = line[:self.column] + letter + line[self.column + 1:]
            self.column += 1


class Watched:
    """A running `a351ctl watch`, with its terminal."""

    def __init__(self, session, columns=80, rows=24, env=None):
        self.main, self.end = pty.openpty()
        self.before = termios.tcgetattr(self.end)
        self.screen = Screen(columns, rows)
        self.resize(columns, rows)
        self.process = subprocess.Popen(
            [BIN / "a351ctl", "--url", f"http://127.0.0.1:{session.port}", "watch", "--operator", "km"],
            stdin=self.end, stdout=self.end, stderr=self.end, start_new_session=True,
            preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0), env={**os.environ, "TERM": "xterm", **(env or {})})
        self.lock = threading.Lock()
        self.is_open = True
        self.reader = threading.Thread(target=self.read, daemon=True)
        self.reader.start()

    def read(self):
        text = ""
        while self.is_open:
            if not select.select([self.main], [], [], 0.1)[0]:
                continue
            text += os.read(self.main, 65536).decode(errors="replace")
            whole = len(text) if not re.search(r"\x1b[^A-Za-z]*$", text) else text.rindex("\x1b")
            with self.lock:
                self.screen.write(text[:whole])
            text = text[whole:]

    def resize(self, columns, rows):
        fcntl.ioctl(self.main, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))

    def lines(self):
        with self.lock:
            return list(self.screen.lines)

    def shows(self, text, seconds=20):
        """Waits for a text; line breaks and indents of the screen count as one blank."""
        try:
            wait_for(f"the screen shows {text!r}", lambda: text in re.sub(r"\s+", " ", " ".join(self.lines())), seconds)
        finally:
            if text not in re.sub(r"\s+", " ", " ".join(self.lines())):
                print("\n".join(self.lines()))
        print(f"shown: {text}")

    def press(self, keys):
        os.write(self.main, keys.encode())

    def demand_fits(self, claim):
        lines = self.lines()
        demand(f"{claim}: nothing scrolled, no line was cut: {self.screen.scrolls} and {self.screen.clipped}",
               self.screen.scrolls == self.screen.clipped == 0)
        demand(f"{claim}: the state is above, the keys are on the last line: {lines[-1]!r}",
               lines[0].startswith("a351d  ") and "q quit" in lines[-1])
        demand(f"{claim}: broken lines are indented",
               all(re.match(r"[a-z][a-z0-9 -]{12}\S| {13}\S|$", line) for line in lines[:-1]))

    def demand_restored(self, claim, status=0):
        demand(f"{claim}: the program ends with status {status}", self.process.wait(timeout=5) == status)
        time.sleep(0.3)
        self.is_open = False
        self.reader.join()
        demand(f"{claim}: former screen, cursor and wrapping are back: {self.screen.modes}",
               (self.screen.modes["1049"], self.screen.modes["25"], self.screen.modes["7"]) == ("l", "h", "h"))
        demand(f"{claim}: the settings of the terminal are as before", termios.tcgetattr(self.end) == self.before)


def number_shown(watched):
    found = re.search(r"(\d) of 3: (\d+):(\d\d) left", " ".join(watched.lines()))
    return found and 60 * int(found[2]) + int(found[3])


def operate(session):
    watched = Watched(session)
    watched.shows("s start n note q quit")
    watched.shows("signal x ")
    watched.demand_fits("80 x 24")
    watched.press("x")
    watched.shows("no occupation is running")

    watched.press("s")
    watched.shows("nearest sites: No.0, No.1, Mt Tsukuba, Mt Tsukuba west")
    watched.press("Mt\t")
    watched.shows("cancels): Mt Tsukuba")
    watched.press("\x7f" * 20 + "nowhere\n")
    watched.shows("site nowhere is not one of the 4 sites in the list")
    watched.press("sno 1\n")
    watched.shows("did you mean No.1?")
    watched.press("y")
    watched.shows("started No.1 at ")
    watched.shows("No.1, stay 1, since ")
    watched.shows("x stop u next set-up n note q quit")
    watched.press("s")
    watched.shows("No.1 is running: stop it first")
    watched.shows("GB free")
    watched.demand_fits("while a stay runs")

    wait_for("the first set-up is counted down", lambda: number_shown(watched))
    first = number_shown(watched)
    wait_for("less time is left", lambda: number_shown(watched) < first)
    demand(f"at most 3 min are left in a set-up: {first} s", first <= 180)
    watched.shows("1 of 3: 0:00 left; lift the box, set it down again, then press u")
    watched.press("u")
    watched.shows("further set-up at No.1 (stay 1) from")
    watched.shows("set-up 2 of 3: ")
    watched.press("nwindy \u5c71\x1b[A")
    watched.shows("note (Esc cancels): windy \u5c71")
    watched.press("\x1b")
    watched.shows("q quit")
    watched.press("nlorr \u5c71\x7f\x7fy\n")
    watched.shows("answer noted at ")
    watched.press("x")
    watched.shows("stop No.1? y: stop, any other key: cancel")
    watched.shows("2 of 3 planned set-ups; the verdict is ")
    watched.press("n")
    watched.shows("nothing was changed")
    demand("the stay still runs", session.status()["occupation"] is not None)
    watched.shows("2 of 3: 0:00 left; lift the box")
    watched.press("u")
    watched.shows("3 of 3: the stay may be stopped")
    watched.press("xy")
    watched.shows("stopped No.1 (stay 1) at ")
    watched.shows("s start n note q quit")
    watched.demand_fits("after the stay")
    demand(f"the verdict is coloured: {sorted(watched.screen.colours)}", {"1;33", "1;31", "1;32"} & watched.screen.colours)

    for columns, rows in ((60, 20), (100, 40), (80, 24)):
        with watched.lock:
            watched.screen.resize(columns, rows)
        watched.resize(columns, rows)
        wait_for(f"the keys are on the last of {rows} lines", lambda rows=rows: "q quit" in watched.lines()[rows - 1], 2)
        watched.demand_fits(f"{columns} x {rows}")

    watched.press("q")
    watched.demand_restored("q")
    stay = session.status()
    demand("no stay runs", stay["occupation"] is None)
    listed = session.ctl("list")
    demand(f"the stay has three set-ups, their mean and the operator:\n{listed}",
           len(re.findall(r"^No\.1 +1 ", listed, re.M)) == 4 and "1 mean" in listed and " km" in listed)
    demand("the note is in the log, the cancelled one is not", "  lorry\n" in listed and "windy" not in listed)


def interrupt(session):
    watched = Watched(session, env={"NO_COLOR": "1"})
    watched.shows("q quit")
    demand(f"with NO_COLOR nothing is coloured: {watched.screen.colours}", not any("3" in one for one in watched.screen.colours))
    watched.press("\x03")
    watched.demand_restored("Ctrl-C")

    watched = Watched(session)
    watched.shows("q quit")
    watched.press("s")
    watched.shows("start at")
    watched.process.send_signal(signal.SIGTERM)
    watched.demand_restored("SIGTERM")

    watched = Watched(session)
    watched.shows("q quit")
    session.daemon.send_signal(signal.SIGSTOP)
    time.sleep(1.5)
    watched.press("\x03")
    watched.demand_restored("Ctrl-C while the daemon hangs")
    session.daemon.send_signal(signal.SIGCONT)

    watched = Watched(session, rows=1000, env={"TERM": "dumb"})
    wait_for("the second screen", lambda: sum(line.startswith("a351d  ") for line in watched.lines()) >= 2)
    watched.process.send_signal(signal.SIGTERM)
    demand(f"with TERM=dumb nothing is drawn: {watched.screen.modes}, {watched.screen.colours}",
           watched.process.wait(timeout=5) == 0 and not watched.screen.modes and not watched.screen.colours)
    watched.is_open = False

    piped = subprocess.Popen([BIN / "a351ctl", "--url", f"http://127.0.0.1:{session.port}", "watch"], stdout=subprocess.PIPE, text=True)
    time.sleep(2.5)
    piped.send_signal(signal.SIGTERM)
    text, _ = piped.communicate(timeout=5)
    demand(f"without a terminal the screens of status follow each other: {text.count('a351d  ')}",
           piped.returncode == 0 and text.count("a351d  ") >= 2 and "\x1b" not in text and "\n\na351d  " in text)
    bare = run("env", f"A351_URL=http://127.0.0.1:{session.port}", BIN / "a351ctl", "sites").stdout
    demand("A351_URL is the default of --url", "Mt Tsukuba" in bare)

    watched = Watched(session)
    watched.shows("q quit")
    session.daemon.send_signal(signal.SIGTERM)
    session.daemon.wait(timeout=30)
    watched.shows("no daemon answers at http://127.0.0.1")
    watched.demand_fits("without a daemon")
    session.daemon = session.start_daemon()
    watched.shows("verdict")
    watched.press("q")
    watched.demand_restored("q")


def answer_move():
    """Shows as much as can be said at one time, and the question about a moved box, with made-up values."""
    stub = StubDaemon()
    at = "2026-03-01T01:43:20.500Z"
    both = {**reading(0.82), "set_ups": 2, "set_up_sd_mgal": 1.1, "set_up_error_mgal": 0.778}
    stub.status.update(
        level="warning", reasons=["the laptop's clock was never synchronised: times may be wrong by many seconds; connect it to a network"],
        verdict=verdict("disturbed"), tilt=tilt(2.4, -0.6, ["lower the +x side by 2.4'", "raise the +y side by 0.6'"]),
        occupation=occupation("Mt Tsukuba", whole=both, planned_set_ups=3, set_up_count=2, set_up_left_s=0.0, propose_set_up=True,
                              moved={"utc": at, "is_at_start": False},
                              warnings=["the site was occupied before: this is stay 2", "90 s are missing in this set-up",
                                        f"the box was moved at {at}: stop at that time, next set-up at that time, or was it not moved?"]))
    stub.survey = survey([stay("No.0", difference_mgal=0.42)], [finding("No.3 (1) reads like No.7: it is 12.1 mGal too high for No.3", True)])
    named = {key: stub.status["occupation"][key] for key in ("key", "site")}
    watched = Watched(stub)
    watched.shows("gravity No.0 (1): 979861.32 +- 1.27 mGal, left out - reference +0.42 mGal; ! No.3 (1) reads like No.7")
    watched.shows("GB free")
    watched.demand_fits("with everything that can be said")
    for keys, path, body in (("xy", "stop", {**named, "at": "2026-03-01T01:43:20.500000000Z", "operator": "km"}),
                             ("xn", "stop", {**named, "operator": "km"}), ("m", "not_moved", {**named, "operator": "km"})):
        count = len(stub.posts)
        watched.press(keys)
        wait_for(f"{keys} sends an order", lambda count=count: len(stub.posts) > count)
        demand(f"the keys {keys} send {path} {body}: {stub.posts[-1]}", stub.posts[-1] == (f"/api/occupation/{path}", body))
    watched.press("x")
    watched.shows("stop Mt Tsukuba at 01:43:20, when the box was moved? y: then, n: now")
    watched.press("zq")
    watched.demand_restored("q")


with Scratch() as scratch:
    (scratch / "list.csv").write_text(SITES)
    running = Session(scratch, speed=20, config=PLAN)
    wait_for("samples are recorded", lambda: running.status().get("received"))
    operate(running)
    interrupt(running)
answer_move()
