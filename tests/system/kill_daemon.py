"""kill -9 in the middle of a day at 20x: what was journaled stays, the day goes on, nothing doubles.

The stream is adopted when the counter tells it: at 20x what the killed daemon had read but not
written may be more than the second of signal within which that is sure, then the sensor is
configured anew.  Either is right.
"""

import datetime
import random
import signal
import subprocess
import threading
import time

from programs import BIN, IS_LONG, Scratch, compare_truth, daemon_config, daemon_status, demand, read_json, run

SPEED = 20


def wait_for_samples(port, count, seconds=30):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        state = daemon_status(port)
        if state and (state.get("journaled") or 0) >= count:
            return state
        time.sleep(0.05)
    demand(f"{count} samples are journaled within {seconds} s", False)


def wait_for_more(port, session, journaled, count):
    """`count` samples behind those of a session, or in another one."""
    state = wait_for_samples(port, 1)
    wait_for_samples(port, count + (journaled if state["session"] == session else 0))


def archive_is_whole(archive):
    """There are day files of four sampled channels, and all are of whole records or, at their very end, the start of one."""
    files = list(archive.rglob("*.D.*"))
    for file in files:
        data = file.read_bytes()
        whole = len(data) // 512
        for i in range(whole):
            if not (data[i * 512:i * 512 + 6].isdigit() and data[i * 512 + 6:i * 512 + 7] == b"D"):
                return False
    return sum(not file.name.split(".")[3].startswith("L") for file in files) == 4


def archived(archive):
    """The records of each channel, day after day."""
    channels = {}
    for file in sorted(archive.rglob("*.D.*")):
        channels.setdefault(file.name.split(".")[3], bytearray()).extend(file.read_bytes())
    return channels


def recoveries(scratch):
    return [line for line in (scratch / "a351d.log").read_text().splitlines() if "recovery" in line]


def compare_recovery(daemon, port, scratch):
    """Another start replays the last session into the archive, all of whose channels must be as the journal has them."""
    before = archived(scratch / "data" / "archive")
    with open(scratch / "a351d.log", "a") as log:
        third = subprocess.Popen(daemon, cwd=scratch, stderr=log)
        while len(recoveries(scratch)) < 3 and third.poll() is None:
            time.sleep(0.05)
        third.send_signal(signal.SIGTERM)
        demand("a daemon without its sensor ends cleanly", third.wait(timeout=30) == 0)
    said = recoveries(scratch)
    print(*said, sep="\n")
    demand("recovery finds nothing in the archive that disagrees with the journal",
           len(said) == 3 and not any("disagree" in line for line in said))
    demand("after a clean end there is nothing to add", "0 records added" in said[2])
    demand(f"the archive stays as it is: {sorted(before)}",
           {"LCE", "LCQ", "LK1"} < set(before) and archived(scratch / "data" / "archive") == before)


def round_of(number, scratch):
    generator = random.Random(number)
    port = generator.randrange(20000, 40000)
    (scratch / "a351d.toml").write_text(daemon_config(port))
    plan = run(BIN / "a351-sim", "plan", "--scenario", "tsukuba", "--seed", number, "--out", scratch)
    start = dict(part.split("=", 1) for part in plan.stdout.split())["start_utc"]
    host = datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%S.%fZ")
    clock = f"scaled:{SPEED}@{start},{host}"
    sim = subprocess.Popen([BIN / "a351-sim", "device", "--link", "sensor", "--scenario", "tsukuba",
                            "--seed", str(number), "--clock", clock, "--truth", "truth.bin",
                            "--report", "report.json"], cwd=scratch, stderr=subprocess.DEVNULL)
    daemon = [BIN / "a351d", "--config", "a351d.toml", "--clock", clock]
    with open(scratch / "a351d.log", "w") as log:
        first = subprocess.Popen(daemon, cwd=scratch, stderr=log)
        session = wait_for_samples(port, 2000)["session"]
        time.sleep(generator.uniform(0.0, 1.5))
        last_published = 0
        stop = threading.Event()

        def watch():
            nonlocal last_published
            while not stop.is_set():
                state = daemon_status(port)
                if state:
                    last_published = max(last_published, state.get("journaled") or 0)

        watcher = threading.Thread(target=watch)
        watcher.start()
        time.sleep(0.5)
        killed = time.monotonic()
        first.send_signal(signal.SIGKILL)
        first.wait()
        stop.set()
        watcher.join()
        demand("the archive is readable right after the kill",
               archive_is_whole(scratch / "data" / "archive"))
        second = subprocess.Popen(daemon, cwd=scratch, stderr=log)
        wait_for_samples(port, 1)
        down_s = time.monotonic() - killed
        wait_for_more(port, session, last_published, 2000)
        second.send_signal(signal.SIGTERM)
        demand("the restarted daemon ends cleanly", second.wait(timeout=30) == 0)
    sim.send_signal(signal.SIGTERM)
    sim.wait(timeout=30)
    compare_recovery(daemon, port, scratch)

    report = read_json(scratch / "report.json")
    print("emulator:", report, "last published journaled:", last_published)
    runs = report["runs"]
    is_adopted = len(runs) == 1
    print("the stream was adopted" if is_adopted else "the sensor was configured anew")
    demand("the emulator saw one run of sampling, or two", len(runs) in (1, 2))
    channels = compare_truth(scratch / "data" / "archive", scratch / "truth.bin")
    for name, counted in channels.items():
        demand(f"{name}: nothing altered or duplicated",
               counted["altered"] == counted["duplicated"] == 0)
        kept = counted["archived"]
        first_run = counted["first_missing"]
        if is_adopted:
            demand(f"{name}: at most one gap", counted["missing_runs"] <= 1)
        else:
            demand(f"{name}: one gap, from the last chunk written to the last frame the emulator "
                   "sent before the restart",
                   counted["missing_runs"] == 1
                   and first_run + counted["missing"] == runs[0]["frames"])
        demand(f"{name}: times within 0.2 s of the truth ({counted['largest_time_error_s']:.3f})",
               counted["largest_time_error_s"] < 0.2)
        # Before the kill at most 0.2 s of real time; after it no more than the daemon was away, and
        # nothing where the terminal held it for the next one.
        bound = (0.2 + (0.0 if is_adopted else down_s)) * 50 * SPEED
        demand(f"{name}: {counted['missing']:.0f} missing within the {bound:.0f} of 0.2 s and "
               f"{down_s:.2f} s of absence", counted["missing"] <= bound)
        demand(f"{name}: {first_run:.0f} samples of the first run are there, {last_published + 1} "
               "were published as journaled",
               counted["missing"] == 0 or first_run >= last_published + 1)


for number in range(1, 21 if IS_LONG else 3):
    with Scratch() as scratch:
        round_of(number, scratch)
