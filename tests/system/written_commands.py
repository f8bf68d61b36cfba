"""Every command of README and field guide runs as written, in a clean clone, with an emulated sensor.

A command is a line of a code block, or code in the text that begins with a program.  The clone shares the built programs;
fresh_debian.py builds in one.  Commands run in the order of the pages.  NOT_RUN lists what cannot run here, each with its reason;
a command that is neither there nor of the kinds in RUN fails the test.  Reader.changed() has what is replaced: directories of the
system, times and placeholders.  The files that a reader has to edit are edited.
What the README asks owners for must be enough to compute everything again.
"""

import atexit
import datetime
import os
import re
import signal
import subprocess
import time

from emulated_session import wait_for
from programs import BIN, IS_SANITIZED, TOP, Scratch, daemon_status, demand, one_site, run, short_day, unused_port

SPEED = 60 if IS_SANITIZED else 120
RECORD_S = 5
README_START = "2017-06-01T09:00:00Z"
GUIDE_START, GUIDE_RECORDED = "2017-06-01T08:38:00Z", "2017-06-01T09:02:00Z"  # The guide changes a stay from 08:45 to 09:01.

# With sudo only these, because here they run without it.
RUN = r"(sudo )?(cp|mkdir|cmake --install) .*|config/build-programs|(timeout \S+ )?a351[a-z-]* .*"
# Regular expressions of commands, and the reasons why they are not run.
NOT_RUN = {
    r"sim/demo": "survey_day.py runs it",
    r"tests/run": "this test is a part of it",
    r"\(cd build/release && cpack\) && sudo apt install .*": "packages.py makes them, fresh_debian.py installs them",
    r"sudo apt install .*": "fresh_debian.py installs the packages",
    r"sudo adduser .*|sudo udevadm .*|sudo mkdir -p /etc/a351 && sudo systemd-sysusers": "changes the host",
    r"sudo systemctl .*": "booted_service.py runs the service in a booted system; here its daemon runs without systemd",
    r"xdg-open .*": "needs a desktop",
    r"ssh .*|rsync .*": "needs another computer or disk",
    r"a351ctl phone": "needs an address in a network",
    r"sim/relive ROOT": "relive.py runs it",
    r"a351d --config \S+ --identify": "identify.py runs it",
    r"a351d --config FILE": "FILE is any configuration; others are run",
    r"a351-correct amend .*": "game_day.py runs it on a day with findings",
    r"a351-correct calibrate .*": "calibration.py and record_calibration.py run it on their series",
}
# What has happened before a mistake of the guide's table is corrected.  STAY is the first one, from 08:45.
BEFORE = {"a351ctl start No.5 --at 08:45": "a351ctl discard", "a351ctl retime STAY --to 09:01": "a351ctl stop",
          "a351ctl not-moved": "a351ctl start No.5", "a351ctl resume": "a351ctl stop", "a351ctl restore STAY": "a351ctl discard STAY"}
KEY = r"\b(STAY|\d{8}T\d{6}Z)\b"
FIRST_WORD = r"(sudo|cmake|cpack|python3|ssh|rsync|xdg-open|timeout|a351d|a351ctl|a351-\w+|(sim|tests|config)/[\w./-]+)"


def is_command(code):
    words = code.split()
    if not words or not re.fullmatch(FIRST_WORD, words[0]):
        return False
    program = TOP / words[0]
    return len(words) > 1 or (program.is_file() and os.access(program, os.X_OK))


def commands_of(page):
    """Returns the commands of a page in their order, those of a code block without their comments."""
    commands = []
    for k, part in enumerate((TOP / page).read_text().split("```")):
        if k % 2 == 0:
            commands += [" ".join(code.split()) for code in re.findall(r"`([^`]+)`", part) if is_command(" ".join(code.split()))]
        elif "──" not in part:  # A drawing.
            commands += [re.split(r"\s+# ", line)[0] for line in part.strip().splitlines() if line.strip()]
    return commands


class Reader:
    """A reader who runs the commands of a page, in the clone or in a directory of its own."""

    def __init__(self, scratch, root, start):
        self.scratch, self.root, self.port = scratch, root, unused_port()
        self.own = scratch / f"reader-{self.port}"
        self.own.mkdir()
        (self.own / "short.toml").write_text(one_site("ideal", start, 24))
        now = datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%S.%fZ")
        self.clock = f"scaled:{SPEED}@{start},{now}"
        self.environment = {**os.environ, "PATH": f"{BIN}:{os.environ['PATH']}", "TZ": "UTC",
                            "A351_URL": f"http://127.0.0.1:{self.port}"}
        self.daemon = None
        self.sensor = self.start(f"a351-sim device --link sensor --scenario short.toml --clock {self.clock}")
        wait_for("the emulated sensor", (self.own / "sensor").is_symlink)

    def start(self, command, place=None):
        process = subprocess.Popen(["bash", "-c", f"exec {command}"], cwd=place or self.own, env=self.environment,
                                   stderr=open(self.own / "log", "a"))
        atexit.register(process.kill)  # If a demand fails.
        return process

    def end(self):
        self.stop_daemon()
        self.sensor.terminate()
        self.sensor.wait(timeout=30)

    def start_daemon(self, config):
        self.daemon = self.start(f"a351d --config {config} --clock {self.clock}")
        wait_for("the daemon has samples", lambda: (daemon_status(self.port) or {}).get("sample"))

    def stop_daemon(self):
        if self.daemon:
            self.daemon.send_signal(signal.SIGINT)
            demand("Ctrl-C ends the daemon with status 0", self.daemon.wait(timeout=30) == 0)
        self.daemon = None

    def key(self):
        return re.search(r"\d{8}T\d{6}Z", self.said("a351ctl list"))[0]

    def said(self, command, place=None, allowed=(0,)):
        done = subprocess.run(["bash", "-c", command], cwd=place or self.own, env=self.environment, capture_output=True, text=True)
        demand(f"`{command}` ends with {done.returncode} {done.stderr[-400:] if done.returncode else ''}", done.returncode in allowed)
        return done.stdout

    def changed(self, command):
        """Returns a command as it runs here."""
        command = re.sub(r"^timeout 1[hd] a351d", f"timeout {RECORD_S} a351d --clock {self.clock}", command)
        command = command.removeprefix("sudo ")
        command = re.sub(r"(?<![\w.])/(usr|etc|var)/", rf"{self.root}/\1/", command)  # Directories of the system.
        command = command.replace("/tmp/sensor", str(self.own / "other-sensor"))
        if re.search(KEY, command):
            command = re.sub(KEY, self.key(), command)
        command = command.replace("NAME --latitude DEG --longitude DEG", "No.99 --latitude 36.2 --longitude 140.1")
        if command.startswith("a351-correct table"):
            command += " --sites {0}/sites.csv --observations {0}/observations.csv".format(TOP / "tests/golden/tsukuba")
        return command

    def edit(self, file):
        """Changes a copied example as the comment beside the command says."""
        text = file.read_text()
        if file.name.startswith("day"):
            text = text.replace('"data"', f'"{self.scratch}/day"').replace('"sites.csv"', f'"{self.scratch}/day/sites.csv"')
        else:
            service = self.root / "var/lib/a351"
            root, sites = (service / "box1", service / "sites/sites.csv") if "etc" in file.parts else ("data", "sites.csv")
            text = re.sub(r'(?m)^port = "/dev/.*', f'port = "{self.own}/sensor"', text)
            text = text.replace('"127.0.0.1:8351"', f'"127.0.0.1:{self.port}"')
            text = text.replace('root = "data"', f'root = "{root}"').replace('sites = ""', f'sites = "{sites}"')
        file.write_text(text)

    def follow(self, command):
        """Runs one command of a page."""
        if command in BEFORE:
            self.follow(BEFORE[command])
        place = self.scratch / "clone" if re.search(r"\b(config|tests|build)/", command) else self.own
        as_run = self.changed(command)
        if re.match(r"a351-sim (device|replay)|a351d --config \S+$", command):
            self.serve(command, as_run, place)
            return
        if command.startswith("timeout"):
            self.stop_daemon()
        # `a351ctl status` ends as a monitoring plugin: 1 is a warning, 2 a fault.
        self.said(as_run, place, (0, 1, 2) if command == "a351ctl status" else (0,))
        if command.startswith("a351ctl"):
            time.sleep(0.3)  # No operator sets up and stops between two samples.
        if copied := re.search(r"^cp \S+ (\S+\.toml)$", as_run):
            self.edit(self.own / copied[1])

    def serve(self, command, as_run, place):
        """Starts a program that runs until it is stopped."""
        if command.startswith("a351d"):
            self.start_daemon(command.split()[2])
            return
        link = place / as_run.split()[as_run.split().index("--link") + 1]
        if link.is_symlink():
            self.end()
        server = self.start(as_run, place)
        wait_for(f"`{command}` serves its link", link.is_symlink)
        server.terminate()
        demand(f"`{command}` ends with status 0", server.wait(timeout=30) == 0)


def reason_not_to_run(command):
    return next((reason for pattern, reason in NOT_RUN.items() if re.fullmatch(pattern, command)), None)


def follow(reader, page):
    """Runs the commands of a page that can be run."""
    for command in commands_of(page):
        if reason := reason_not_to_run(command):
            print(f"not run: `{command}`: {reason}")
            instead_of_systemd(reader, command)
        else:
            reader.follow(command)


def instead_of_systemd(reader, command):
    if re.match(r"sudo systemctl (enable|start)", command):
        reader.start_daemon(reader.root / "etc/a351/box1.toml")
        wait_for(f"recorded until {GUIDE_RECORDED}", lambda: daemon_status(reader.port)["sample"]["utc"] > GUIDE_RECORDED)
    elif re.match(r"sudo systemctl stop", command):
        reader.stop_daemon()


def requested_records(own):
    """Computes the two records again that the README asks owners for."""
    frames = []
    for name in ("hour", "day"):
        folder = own / f"from-{name}"
        folder.mkdir()
        run("tar", "-xf", own / f"m-a351-{name}.tar", "-C", folder)
        files = sorted(path.relative_to(folder) for path in folder.rglob("*") if path.is_file())
        print(f"{name}: {(own / f'm-a351-{name}.tar').stat().st_size} bytes: {', '.join(map(str, files))}")
        demand(f"{name}: no configuration is in the file", not any("station.toml" in str(path) for path in files))
        made = run(BIN / "a351-correct", "retime", folder / "data", "--out", folder / "again").stdout
        frames.append(int(re.search(r"(\d+) frames", made).group(1)))
        demand(f"{name}: an archive and the metadata are made again from {frames[-1]} frames",
               any((folder / "again" / "archive").rglob("*.D.*")) and (folder / "again" / "metadata" / "station.xml").exists())
    demand("the second file continues the first", 0 < frames[0] < frames[1])


all_commands = [command for page in ("README.md", "daemon/field-guide.md") for command in commands_of(page)]
stale = [pattern for pattern in NOT_RUN if not any(re.fullmatch(pattern, command) for command in all_commands)]
demand(f"each entry of NOT_RUN is a command of the pages; others: {stale or 'none'}", not stale)
unknown = [command for command in all_commands if not reason_not_to_run(command) and not re.fullmatch(RUN, command)]
demand(f"each other command can be run here; others: {unknown or 'none'}", not unknown)
with Scratch() as scratch:
    root = scratch / "root"
    run("git", "clone", "-q", TOP, scratch / "clone")
    (scratch / "clone" / "build").mkdir()
    (scratch / "clone" / "build" / "release").symlink_to(BIN.parent)
    (scratch / "short.toml").write_text(short_day())
    run(BIN / "a351-sim", "survey", "--scenario", scratch / "short.toml", "--out", scratch / "day")
    reader = Reader(scratch, root, README_START)
    follow(reader, "README.md")
    reader.end()
    requested_records(reader.own)
    run("cmake", "--install", BIN.parent, "--prefix", root / "usr")  # As the packages do.
    (root / "etc" / "a351").mkdir(parents=True)
    reader = Reader(scratch, root, GUIDE_START)
    follow(reader, "daemon/field-guide.md")
    reader.end()
