"""Compares the verdict and the running reading at a benchmark with the truth, also after a crash of the daemon."""

import atexit
import datetime
import json
import shutil
import signal
import subprocess
import time
import urllib.request

from emulated_session import Session, wait_for
from programs import BIN, IS_SANITIZED, Scratch, daemon_config, demand, rows, run, unused_port

G_MGAL = 980665.0
MOST_S = 40 if IS_SANITIZED else 10
SLOWER = 3 if IS_SANITIZED else 1  # Factor of lower speed and longer timeouts for slow programs, so that the daemon keeps up.
COUNTS_PER_G = 1 << 24


def ctl(session, *order, check=True):
    return run(BIN / "a351ctl", "--url", f"http://127.0.0.1:{session.port}", *order, check=check)


def state(session):
    return session.status().get("verdict", {}).get("state")


def slope_limit(session):
    """Waits until the status shows the limit of the temperature slope, and returns it.

    The state alone does not show which threshold is used, because the box at a benchmark is disturbed for seconds repeatedly.
    While it is disturbed, there is no check of the slope.
    """
    limits = []

    def is_shown():
        limits.extend(check["limit"] for check in session.status().get("verdict", {}).get("checks", [])
                      if check["quantity"] == "temperature slope")
        return limits

    wait_for("the limit of the temperature slope is shown", is_shown, 20)
    return limits[-1]


def nanoseconds(utc):
    whole = datetime.datetime.strptime(utc, "%Y-%m-%dT%H:%M:%S.%fZ").replace(tzinfo=datetime.timezone.utc)
    return int(whole.timestamp() * 1000) * 10**6


def mean_norm_mgal(rows):
    return sum((x * x + y * y + z * z) ** 0.5 for _, x, y, z, *_ in rows) / len(rows) * G_MGAL / COUNTS_PER_G


with Scratch() as scratch:
    session = Session(scratch, speed=60 // SLOWER)
    wait_for("settling at first, because the temperature is not known for long enough",
             lambda: state(session) == "settling", 20)
    first = session.status()["verdict"]
    demand(f"the verdict settling has its reason: {first['reasons'][0]}",
           first["reasons"][0].startswith("temperature known for"))
    wait_for("stable", lambda: state(session) == "stable", 60 * SLOWER)

    def logged():
        lines = [line for file in (scratch / "data/events").glob("*.jsonl") for line in file.read_text().splitlines()]
        return [event["state"] for event in map(json.loads, lines) if event["type"] == "verdict"]

    wait_for("the event log has the verdicts", lambda: logged()[-1:] == ["stable"] or state(session) != "stable", 10)
    demand(f"a verdict is logged once: {logged()}", "settling" in logged() and all(a != b for a, b in zip(logged(), logged()[1:])))

    print(ctl(session, "start", "No.0").stdout, end="")
    wait_for("a standard error", lambda: session.status()["occupation"]["reading"]["standard_error_mgal"],
             30 * SLOWER)
    ctl(session, "target", "0.01")
    demand("the target is not reached", not session.status()["occupation"]["reading"]["is_good_enough"])
    wait_for("the time needed for the target is estimated",
             lambda: session.status()["occupation"]["reading"]["needed_s"], 10 * SLOWER)
    ctl(session, "target", "5")
    wait_for("a less strict target is reached",
             lambda: session.status()["occupation"]["reading"]["is_good_enough"], 10 * SLOWER)
    wait_for("a further set-up is proposed", lambda: session.status()["occupation"]["propose_set_up"],
             30 * SLOWER)

    config = scratch / "a351d.toml"
    given = config.read_text()
    log = scratch / "a351d.log"

    def reload(text, claim, is_so):
        demand(f"before the reload this is not true: {claim}", not is_so())
        config.write_text(text)
        session.daemon.send_signal(signal.SIGHUP)
        wait_for(claim, is_so, 10)

    shipped = slope_limit(session)
    print(f"shipped threshold: {shipped} degC/h")
    reload(given + "[verdict]\nslope_degc_per_h = 0.001\n", "the threshold reloaded by SIGHUP is used",
           lambda: slope_limit(session) == 0.001)
    wait_for("settling by the new threshold", lambda: state(session) == "settling", 10)
    reload("broken", "a broken file is refused at SIGHUP with its name", lambda: "a351d.toml:1: " in log.read_text())
    demand("the refused file changed no threshold", slope_limit(session) == 0.001)
    reload(given, "the earlier threshold is used again", lambda: slope_limit(session) == shipped)
    wait_for("stable by the earlier threshold", lambda: state(session) == "stable", 10)

    for how in (signal.SIGKILL, signal.SIGTERM):
        used_s = session.status()["occupation"]["reading"]["used_s"]
        session.daemon.send_signal(how)
        session.daemon.wait()
        session.daemon = session.start_daemon()
        begun = time.monotonic()
        wait_for("stable again", lambda: state(session) == "stable", 60)
        took_s = time.monotonic() - begun
        demand(f"after {how.name} the verdict is back after {took_s:.1f} s, limit {MOST_S}", took_s < MOST_S)
        wait_for("the reading continues", lambda: session.status()["occupation"]["reading"]["used_s"] > used_s, 20)
        demand("the target is kept", session.status()["target_mgal"] == 5)

    print(ctl(session, "stop").stdout, end="")
    listed = ctl(session, "list").stdout.splitlines()
    _, _, start, end, reading, *_ = listed[1].split()
    session.order("silence seconds=100000")
    wait_for("no data", lambda: state(session) == "no data", 10)
    demand(f"the verdict no data has the time of the last sample: {session.status()['verdict']['reasons']}",
           session.status()["verdict"]["reasons"][0].startswith("last "))

    session.sim.send_signal(signal.SIGTERM)
    session.sim.wait(timeout=30)
    between = [row for row in session.rows() if nanoseconds(start) <= row[0] < nanoseconds(end)]
    true = mean_norm_mgal(between)
    demand(f"the reading {reading} mGal is the mean of the {len(between)} samples that the sensor sent, {true:.2f}",
           abs(float(reading) - true) < 1.0)

# Readings whose journal is deleted are computed again from the archive.
with Scratch() as scratch:
    run(BIN / "a351-sim", "survey", "--scenario", "ideal", "--out", scratch / "data")
    shutil.rmtree(scratch / "data" / "journal")
    end = rows(scratch / "data" / "schedule.csv")[-1]["end_utc"]
    port = unused_port()
    (scratch / "a351d.toml").write_text(daemon_config(port))
    daemon = subprocess.Popen([BIN / "a351d", "--config", "a351d.toml", "--clock", f"scaled:1@{end}"], cwd=scratch)
    atexit.register(daemon.kill)

    def readings():
        try:
            with urllib.request.urlopen(f"http://127.0.0.1:{port}/api/occupations", timeout=5) as reply:
                return [one["reading"]["value_mgal"] for one in json.load(reply)["occupations"]]
        except OSError:
            return []

    wait_for("the readings of the whole day", lambda: readings() and None not in readings(), 30 * SLOWER)
    print(f"computed from the archive: {len(readings())} readings, {min(readings()):.1f} to {max(readings()):.1f} mGal")
    daemon.terminate()
    demand("the daemon ends cleanly", daemon.wait(timeout=30) == 0)
