"""Compares the signal with the plan of a stay and the running reading with the truth, also after a crash of the daemon."""

import datetime
import json
import signal
import time

from emulated_session import Session, wait_for
from programs import IS_SANITIZED, Scratch, demand, events_of

G_MGAL = 980665.0
MOST_S = 40 if IS_SANITIZED else 10
SLOWER = 3 if IS_SANITIZED else 1  # Factor of lower speed and longer timeouts for slow programs, so that the daemon keeps up.
COUNTS_PER_G = 1 << 24


def word(session):
    return session.status().get("signal", {}).get("word")


def nanoseconds(utc):
    whole = datetime.datetime.strptime(utc, "%Y-%m-%dT%H:%M:%S.%fZ").replace(tzinfo=datetime.timezone.utc)
    return int(whole.timestamp() * 1000) * 10**6


def mean_norm_mgal(rows):
    return sum((x * x + y * y + z * z) ** 0.5 for _, x, y, z, *_ in rows) / len(rows) * G_MGAL / COUNTS_PER_G


with Scratch() as scratch:
    session = Session(scratch, speed=60 // SLOWER)
    wait_for("the box may go before the first stay", lambda: word(session) == "go", 60)
    wait_for("the details say why the reading is not stable",
             lambda: session.status()["details"]["reasons"][0].startswith("temperature known for"), 10)

    def logged():
        return [event["word"] for event in events_of(scratch / "data") if event["type"] == "signal"]

    print(session.ctl("start", "No.0"), end="")
    wait_for("keep off while the set-up runs", lambda: word(session) == "keep_off", 20)
    wait_for("the stay may end when the plan is complete", lambda: word(session) == "go", 60 * SLOWER)
    demand("at YOU CAN GO the plan has no time left", session.status()["occupation"]["set_up_left_s"] == 0)
    wait_for("the event log has the words", lambda: logged()[-2:] == ["keep_off", "go"], 10)
    demand(f"a word is logged once: {logged()}", all(a != b for a, b in zip(logged(), logged()[1:])))

    config = scratch / "a351d.toml"
    given = config.read_text()
    log = scratch / "a351d.log"

    def reload(text, claim, is_so):
        demand(f"before the reload this is not true: {claim}", not is_so())
        config.write_text(text)
        session.daemon.send_signal(signal.SIGHUP)
        wait_for(claim, is_so, 10)

    reload(given + "[verdict]\noperating_degc = 60.0\n", "the set point reloaded by SIGHUP is used",
           lambda: word(session) == "warming_up")
    reload("broken", "a broken file is refused at SIGHUP with its name", lambda: "a351d.toml:1: " in log.read_text())
    demand("the refused file changed nothing", word(session) == "warming_up")
    reload(given, "the earlier set point is used again", lambda: word(session) == "go")

    for how in (signal.SIGKILL, signal.SIGTERM):
        used_s = session.status()["occupation"]["reading"]["used_s"]
        session.daemon.send_signal(how)
        session.daemon.wait()
        if how == signal.SIGTERM:
            with open(next((scratch / "data" / "events").glob("*.jsonl")), "a") as events:
                events.write('{"type": "start\n')
        session.daemon = session.start_daemon()
        begun = time.monotonic()
        wait_for("the same word again", lambda: word(session) == "go", 60)
        took_s = time.monotonic() - begun
        demand(f"after {how.name} the signal is back after {took_s:.1f} s, limit {MOST_S}", took_s < MOST_S)
        wait_for("the reading continues", lambda: session.status()["occupation"]["reading"]["used_s"] > used_s, 20)

    demand("a damaged line of the event log is named", ".jsonl:" in log.read_text() and ": not an event, left out" in log.read_text())
    print(session.ctl("stop"), end="")
    stay = json.loads(session.ctl("list", "--json"))["occupations"][0]
    start, end, reading = stay["set_ups"][0]["start"], stay["set_ups"][-1]["end"], stay["reading"]["value_mgal"]
    session.order("silence seconds=100000")
    wait_for("NO DATA with the age of the last sample",
             lambda: word(session) == "no_data" and "last " in session.status()["signal"]["sentence"], 10)
    status = session.try_ctl("status")
    demand("a351ctl status ends with 1 or more, and begins with the state", status.returncode >= 1)

    session.sim.send_signal(signal.SIGTERM)
    session.sim.wait(timeout=30)
    between = [row for row in session.rows() if nanoseconds(start) <= row[0] < nanoseconds(end)]
    true = mean_norm_mgal(between)
    demand(f"the reading {reading} mGal is the mean of the {len(between)} samples that the sensor sent, {true:.2f}",
           abs(float(reading) - true) < 1.0)
