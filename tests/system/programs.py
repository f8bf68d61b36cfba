"""Shared parts of the system tests: the programs under test, a scratch directory, and small readers."""

import concurrent.futures
import csv
import datetime
import http.client
import json
import math
import os
import pathlib
import random
import shutil
import socket
import statistics
import subprocess
import sys
import tempfile
import urllib.request

TOP = pathlib.Path(__file__).resolve().parents[2]
BIN = pathlib.Path(os.environ.get("A351_BIN", TOP / "build/release/bin"))
TOOLS = pathlib.Path(os.environ.get("A351_TOOLS", TOP / "build/release/tests"))
IS_LONG = os.environ.get("A351_LONG") == "1"
IS_SANITIZED = bool(os.environ.get("A351_PRESET_SANITIZE"))
SKIPPED = 77
MEMORY = pathlib.Path("/dev/shm")
os.environ["A351_LANG"] = "en"  # Tests read English, whatever the host speaks.


def one_site(base, start_utc, hours):
    """Returns a scenario with one site and a constant ambient temperature; further tables may follow."""
    return f"""base = "{base}"
name = "one-site"
[schedule]
start_utc = "{start_utc}"
duration_h = {float(hours)}
[[site]]
name = "here"
longitude_deg = 140.0
latitude_deg = 36.0
altitude_m = 0.0
gravity_mgal = 979900.0
[[ambient]]
at_h = 0.0
degc = 25.0
"""


def run(*command, check=True, env=None, cwd=None):
    """Runs a program to its end and returns the result; if it fails and `check` is set, prints its output and ends the test."""
    result = subprocess.run([str(part) for part in command], capture_output=True, text=True, cwd=cwd,
                            env={**os.environ, **(env or {})})
    if check and result.returncode != 0:
        print(result.stdout[-4000:], result.stderr[-4000:], sep="\n")
        sys.exit(f"{command[0]} ended with {result.returncode}")
    return result


def refused(words, *command, cwd=None):
    """Demands that a program ends with status 2 and one line that has these words, a text or several."""
    result = run(*command, check=False, cwd=cwd)
    line = result.stderr.strip()
    demand(f"refused: {line}", result.returncode == 2 and line != "" and "\n" not in line
           and all(word in line for word in ([words] if isinstance(words, str) else words)))


def correct_survey(survey, out, *options, check=True):
    """Corrects a day without figures: PATH names a folder without gnuplot."""
    return run(BIN / "a351-correct", "survey", survey, "--out", out, *options, env={"PATH": str(out)}, check=check)


taken_ports = []


def unused_port():
    """Returns a TCP port that is free and that no other test gets while this process runs."""
    while True:
        port = random.randrange(20000, 32000)  # Below the ports of outgoing connections.
        mark = socket.socket(socket.AF_UNIX)  # A name in the kernel marks the port for other tests that run at the same time.
        try:
            mark.bind(f"\0a351-test-port-{port}")
            with socket.socket() as probe:
                probe.bind(("127.0.0.1", port))
        except OSError:
            mark.close()
            continue
        taken_ports.append(mark)
        return port


def daemon_config(port, host="127.0.0.1"):
    """Returns the smallest configuration with which a daemon records the emulated sensor linked as `sensor`."""
    return f"""[station]
latitude = 36.2
longitude = 140.1
elevation_m = 400.0
[sensor]
port = "sensor"
[storage]
root = "data"
[page]
listen = "{host}:{port}"
"""


def answer(port, path, timeout_s=2):
    """Returns the JSON that the daemon on that port answers."""
    with urllib.request.urlopen(f"http://127.0.0.1:{port}{path}", timeout=timeout_s) as reply:
        return json.load(reply)


def daemon_status(port):
    """Returns the status of the daemon on that port; None while it does not answer."""
    try:
        return answer(port, "/api/status")
    except (OSError, http.client.HTTPException):  # HTTPException: the daemon ended during its answer.
        return None


def together(*parts):
    """Runs these functions at the same time; the first that fails ends the test."""
    with concurrent.futures.ThreadPoolExecutor(len(parts)) as pool:
        for one in concurrent.futures.as_completed([pool.submit(part) for part in parts]):
            one.result()


def short_day():
    """Returns a scenario with six occupations of the tsukuba day, 40 minutes apart: enough for the whole-day model."""
    sites = ("No.0", "No.12", "No.1", "No.2", "No.4", "No.0")
    text = 'base = "tsukuba"\nname = "short"\n[schedule]\nlead_in_h = 2.5\n'
    for k, site in enumerate(sites):
        minutes = 23 * 60 + 40 + 40 * k
        text += (f'[[occupation]]\nsite = "{site}"\nnumber = {sites[:k + 1].count(site)}\nambient_degc = {27.0 + 0.3 * k}\n'
                 f'centre_utc = "2017-07-{15 + minutes // 1440}T{minutes // 60 % 24:02}:{minutes % 60:02}:00Z"\n')
    return text


def instant(text):
    """Returns the time of an RFC 3339 text in UTC, to the microsecond."""
    return datetime.datetime.fromisoformat(text[:26].rstrip("Z") + "+00:00")


def events_of(root):
    """Returns the events of a data root."""
    return [json.loads(line) for file in sorted((root / "events").glob("*.jsonl")) for line in file.read_text().splitlines()]


def write_events(root, events):
    """Writes the events of a data root whose log has one file."""
    file, = (root / "events").glob("*.jsonl")
    file.write_text("".join(json.dumps(event) + "\n" for event in events))


def rows(file):
    with open(file, newline="") as text:
        return list(csv.DictReader(text))


def write_sites(file, table, gravity_of):
    """Writes the list of sites of a table with the gravities of those that are known, by name."""
    columns = ("site", "longitude_deg", "latitude_deg", "altitude_m")
    lines = [",".join([*(row[column] for column in columns), str(gravity_of.get(row["site"], ""))]) for row in table]
    file.write_text("\n".join([",".join([*columns, "gravity_mgal"]), *lines]) + "\n")


def fields(line):
    """Returns the parts key=value of a line."""
    return dict(part.split("=", 1) for part in line.split())


def start_of(scenario, folder):
    """Plans a scenario in a folder and returns the begin of its record."""
    return fields(run(BIN / "a351-sim", "plan", "--scenario", scenario, "--out", ".", cwd=folder).stdout)["start_utc"]


def contents(folder, pattern="*"):
    """Returns the bytes of the files below a folder, by their path in it."""
    return {path.relative_to(folder).as_posix(): path.read_bytes()
            for path in sorted(pathlib.Path(folder).rglob(pattern)) if path.is_file()}


def end_cleanly(name, process, seconds=30):
    process.terminate()
    demand(f"{name} ends cleanly", process.wait(timeout=seconds) == 0)


def compare_truth(archive, truth):
    """Runs tests/support/compare_truth.cpp and returns its counts by channel; no frame may be altered or duplicated."""
    result = run(TOOLS / "compare-truth", archive, truth, check=False)
    print(result.stdout, result.stderr, sep="")
    channels = {}
    for line in result.stdout.splitlines():
        counts = fields(line)
        name = counts.pop("channel")
        channels[name] = one = {key: float(value) for key, value in counts.items()}
        demand(f"{name}: the archive holds no damaged, lost, repeated or altered frame",
               one["altered"] == one["duplicated"] == 0 < one["matched"])
    demand(f"four channels of {archive} were compared with the truth", len(channels) == 4)
    return channels


def demand(claim, is_true):
    """Prints whether the claim holds; the first claim that fails ends the test."""
    print(("holds: " if is_true else "FAILS: ") + claim)
    if not is_true:
        sys.exit(1)


def skip(reason):
    print("skipped:", reason)
    sys.exit(SKIPPED)


class Scratch:
    """Directory that is removed if the test succeeded, and kept for inspection if it failed."""

    def __init__(self, in_memory=False):
        """@param in_memory  puts it into memory if there is room, so that no disk can stall"""
        has_room = in_memory and MEMORY.is_dir() and shutil.disk_usage(MEMORY).free > 1 << 30
        self.parent = MEMORY if has_room else None

    def __enter__(self):
        self.path = pathlib.Path(tempfile.mkdtemp(prefix="a351-", dir=self.parent))
        return self.path

    def __exit__(self, kind, value, trace):
        is_good = kind is None or (kind is SystemExit and value.code in (0, None, SKIPPED))
        if is_good:
            shutil.rmtree(self.path, ignore_errors=True)
        else:
            print(f"files kept for inspection: {self.path}")


def read_json(file):
    return json.loads(pathlib.Path(file).read_text())


def rms(values):
    """Returns the root mean square of the values."""
    return math.sqrt(statistics.fmean(value * value for value in values))
