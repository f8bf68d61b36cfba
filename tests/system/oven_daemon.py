"""The daemon reads two emulated ovens, one around the other, together with the emulated sensor.

Their values are in status, a351ctl, history, metrics, journal, archive and StationXML.  A silent oven, and one that is
unplugged, is a warning of its own, ends without a restart, and costs no sample of the sensor.  oven_link_test.cpp has
all faults of the line.
"""

import struct
import urllib.request
import xml.etree.ElementTree as ElementTree

from emulated_session import Session, wait_for
from programs import TOOLS, Scratch, answer, daemon_config, daemon_status, demand, read_json, run, unused_port
from stranger_journal import journal

OVENS = """[oven]
enabled = true
port = "oven"
parity = "N"
poll_s = 2
[oven.outer]
enabled = true
port = "outer"
parity = "N"
poll_s = 4
"""
SET_POINTS = {8: 425, 9: 380}  # By the type of the chunk: inner and outer oven.
CHANNELS = ("LK2", "LK3", "LYH", "LK4", "LK5", "LYO")
OUTCOMES = ["answered", "timed_out", "bad_crc", "exception", "other_unit", "malformed", "no_port"]


def polls(data, kind):
    """Returns (outcome, registers) of each poll of an oven in the journal, as the format page describes."""
    found = []
    for segment in sorted((data / "journal").glob("*.a351j")):
        for of_chunk, payload in journal(segment):
            if of_chunk == kind:
                _, outcome, _, count = struct.unpack_from("<qBBB", payload)
                found.append((OUTCOMES[outcome], struct.unpack_from(f"<{count}H", payload, 11)))
    return found


def oven(session):
    return session.status()["oven"]


def warnings(session):
    status = session.status()
    return [reason for reason in status["reasons"]
            if reason.startswith("oven: ")] if status["level"] == "warning" else []


def is_well(session):
    return oven(session)["state"] == "answering" and not oven(session)["is_stale"] and not warnings(session)


def show(session):
    """The values of both ovens, wherever they are shown."""
    status = session.status()
    inner, outer = status["oven"], status["outer_oven"]
    demand(f"the status shows the values of both: {inner}, {outer}", abs(inner["process_value_degc"] - 42.5) < 1.5
           and inner["set_point_degc"] == 42.5 and abs(outer["process_value_degc"] - 38.0) < 1.6
           and outer["set_point_degc"] == 38.0)
    screen = session.try_ctl("status").stdout.splitlines()
    demand("a351ctl has a line for each oven", any(line.startswith("oven ") and "set point 42.5 degC" in line
                                                   for line in screen)
           and any(line.startswith("outer oven") and "set point 38.0 degC" in line for line in screen))
    points = answer(session.port, "/api/history?channel=outer_oven")["points"]
    demand(f"the page's history has {len(points)} values of the outer oven",
           points and all(abs(value - 38.0) < 1.6 and set_point == 38.0 for _, value, set_point in points))
    metrics = urllib.request.urlopen(f"{session.url}/metrics").read().decode()
    demand("the metrics have the outer oven", 'a351_temperature_celsius{at="outer_oven"}' in metrics)


def disturb(session, scratch):
    """Silence, another name of the port, and a second daemon on it."""
    before = oven(session)["polls"]["timed_out"]
    session.order("oven_silence count=-1")
    wait_for("the oven is silent, with a warning", lambda: oven(session)["state"] == "silent" and warnings(session)
             == ["oven: silent; check the controller's cable (sensor data are not affected)"])
    demand("its last values are marked stale", oven(session)["is_stale"])
    session.order("oven_silence count=0")
    wait_for("the oven is read again", lambda: is_well(session))
    demand("the answers that did not come are counted", oven(session)["polls"]["timed_out"] > before)
    name = (scratch / "oven").readlink()
    session.order("oven_unplug")
    wait_for("an unplugged oven is searched for, with a warning", lambda: oven(session)["state"] == "searching"
             and warnings(session))
    session.order("oven_unplug count=0")
    wait_for("the oven is read again under another name",
             lambda: is_well(session) and (scratch / "oven").readlink() != name)
    (scratch / "second").mkdir()
    port = unused_port()
    inner = OVENS.split("[oven.outer]")[0].replace('"oven"', '"../oven"')
    (scratch / "second" / "a351d.toml").write_text(daemon_config(port) + inner)
    second = session.start_daemon("second/a351d.toml")
    wait_for("a second daemon reports that the port is in use", lambda: "in use by another process" in
             (daemon_status(port) or {"oven": {"trouble": ""}})["oven"]["trouble"])
    second.terminate()
    second.wait(timeout=30)
    demand("it does not disturb the oven of the first one", is_well(session))


with Scratch() as scratch:
    session = Session(scratch, speed=20, scenario="double-oven", config=OVENS,
                      emulator=("--oven-link", "oven", "--outer-oven-link", "outer"))
    wait_for("both ovens answer and the sensor samples", lambda: (status := session.status()) and all(
        status[one]["state"] == "answering" for one in ("oven", "outer_oven")) and status["counters"]["frames"] > 3000)
    show(session)
    disturb(session, scratch)
    _, counters = session.end()
    demand("the sensor's stream has no gap and no damage",
           counters["gaps"] == counters["samples_missing"] == counters["bytes_skipped"] == 0
           and counters["sessions"] == 1)
    session.archive_is_true(missing=0)

    data = scratch / "data"
    for kind, set_point in SET_POINTS.items():
        found = polls(data, kind)
        good = [registers for outcome, registers in found if outcome == "answered"]
        demand(f"the {len(good)} answers of type {kind} have five registers with the set point, the others none",
               len(good) > 10 and all(len(registers) == 5 and registers[2] == set_point for registers in good)
               and all(not registers for outcome, registers in found if outcome != "answered"))
    (scratch / "counts").mkdir()
    run(TOOLS / "archive-samples", data / "archive", scratch / "counts")
    counts = {code: [int(line) for line in (scratch / "counts" / code).read_text().split()] for code in CHANNELS}
    demand("LK2 and LK3, LK4 and LK5 are those of their ovens", all(abs(value - 42_500) < 1_500
                                                                    for value in counts["LK2"])
           and all(value % 100 == 0 and abs(value - 38_000) < 1_600 for value in counts["LK4"])
           and set(counts["LK3"]) == {42_500} and set(counts["LK5"]) == {38_000})
    namespace = {"s": "http://www.fdsn.org/xml/station/1"}
    stations = ElementTree.parse(data / "metadata" / "station.xml").findall(".//s:Channel", namespace)
    rates = {one.get("code"): float(one.find("s:SampleRate", namespace).text) for one in stations}
    demand(f"StationXML has the channels of both ovens, with their rates: {rates}",
           all(code in rates for code in CHANNELS)
           and rates["LK4"] == rates["LK5"] == rates["LYO"] and rates["LK4"] <= rates["LK2"])
    report = read_json(scratch / "report.json")["oven"]
    demand(f"the daemon sent only read requests: {report}",
           report["unreadable"] == report["for_other_units"] == report["broadcasts"] == report["resets"] == 0)
