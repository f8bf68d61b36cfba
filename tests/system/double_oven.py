"""The daemon reads two ovens, one around the other, and shows and records the second temperature beside the first.

Checked: status, a351ctl, history of the page, metrics, log, journal, archive and StationXML; the sensor loses nothing; an outer
oven that disappears is a warning of its own and does not disturb the inner one.  With a number of hours as argument, so much
of the simulated day is recorded (A351_SPEED: default 20, a number).
"""

import json
import os
import shutil
import signal
import struct
import subprocess
import sys
import time
import urllib.request
import xml.etree.ElementTree as ElementTree

from oven_daemon import journal_page, wait_for
from programs import BIN, TOOLS, Scratch, compare_truth, daemon_config, daemon_status, demand, run, unused_port

SPEED = float(os.environ.get("A351_SPEED", "20"))
INNER, OUTER = 8, 9
SET_POINTS = {INNER: 425, OUTER: 380}
CHANNELS = ("LK2", "LK3", "LYH", "LK4", "LK5", "LYO")


def polls(data):
    """Returns the registers of the answered polls by the type of their chunk."""
    found = {INNER: [], OUTER: []}
    for segment in sorted((data / "journal").glob("*.a351j")):
        for kind, payload in journal_page.chunks(segment):
            if kind in found and payload[8] == 0:
                found[kind].append(struct.unpack_from(f"<{payload[10]}H", payload, 11))
    return found


def main():
    seconds = 3600 * float(sys.argv[1]) if len(sys.argv) > 1 else 400.0
    with Scratch() as scratch:
        port = unused_port()
        (scratch / "a351d.toml").write_text(
            daemon_config(port) + '[oven]\nenabled = true\nport = "inner"\nparity = "N"\npoll_s = 2\n'
            '[oven.outer]\nenabled = true\nport = "outer"\nparity = "N"\npoll_s = 4\n')
        plan = run(BIN / "a351-sim", "plan", "--scenario", "double-oven", "--out", scratch)
        start = dict(part.split("=", 1) for part in plan.stdout.split())["start_utc"]
        host = time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime())
        clock = f"scaled:{SPEED}@{start},{host}"
        sim = subprocess.Popen(
            [BIN / "a351-sim", "device", "--link", "sensor", "--oven-link", "inner", "--outer-oven-link", "outer", "--scenario",
             "double-oven", "--clock", clock, "--truth", "truth.bin"], cwd=scratch)
        log = open(scratch / "a351d.log", "w")
        daemon = subprocess.Popen([BIN / "a351d", "--config", "a351d.toml", "--clock", clock], cwd=scratch, stderr=log)
        try:
            wait_for("both ovens answer and the sensor samples", lambda: (said := daemon_status(port)) and all(
                said[oven]["state"] == "answering" for oven in ("oven", "outer_oven")) and said["counters"]["frames"] > 500)
            time.sleep(seconds / SPEED)
            status = daemon_status(port)
            outer = status["outer_oven"]
            print("status:", {key: outer[key] for key in ("process_value_degc", "set_point_degc", "heating_percent", "polls")})
            demand("the status shows the outer oven's values", abs(outer["process_value_degc"] - 38.0) < 1.6
                   and outer["set_point_degc"] == 38.0 and status["oven"]["set_point_degc"] == 42.5)
            demand("the sensor's stream has no gap and no damage", status["counters"]["gaps"] == status["counters"]["bytes_skipped"] == 0)
            url = f"http://127.0.0.1:{port}"
            screen = run(BIN / "a351ctl", "--url", url, "status", check=False).stdout
            demand("a351ctl has a line for each oven", any(line.startswith("outer oven") and "set point 38.0 degC" in line
                                                        for line in screen.splitlines()))
            history = json.load(urllib.request.urlopen(f"{url}/api/history?channel=outer_oven"))
            demand(f"the page's history has {len(history['points'])} values of the outer oven",
                   history["channel"] == "outer_oven" and len(history["points"]) > 20
                   and all(abs(value - 38.0) < 1.6 and set_point == 38.0 for _, value, set_point in history["points"]))
            metrics = urllib.request.urlopen(f"{url}/metrics").read().decode()
            demand("the metrics have the outer oven", 'a351_temperature_celsius{at="outer_oven"}' in metrics
                   and "a351_outer_oven_polls_total" in metrics)
            (scratch / "outer").unlink()
            os.symlink("nowhere", scratch / "outer")
            sim.send_signal(signal.SIGTERM)
            demand("the emulator ends cleanly", sim.wait(timeout=30) == 0)
            wait_for("an outer oven that is gone is a warning of its own", lambda: any(
                reason.startswith("outer oven: ") for reason in daemon_status(port)["reasons"]))
            daemon.send_signal(signal.SIGTERM)
            demand("the daemon ends cleanly", daemon.wait(timeout=60) == 0)
        finally:
            sim.kill()
            daemon.kill()
            log.close()

        data = scratch / "data"
        for kind, found in polls(data).items():
            demand(f"the {len(found)} answers of type {kind} in the journal have the set point {SET_POINTS[kind]}",
                   len(found) > 20 and all(len(registers) == 5 and registers[2] == SET_POINTS[kind] for registers in found))
        for channel, counted in compare_truth(data / "archive", scratch / "truth.bin").items():
            demand(f"{channel}: all {counted['truth']:.0f} samples are archived",
                   counted["missing"] == counted["altered"] == counted["duplicated"] == 0)
        (scratch / "counts").mkdir()
        run(TOOLS / "archive-samples", data / "archive", scratch / "counts")
        counts = {code: [int(line) for line in (scratch / "counts" / code).read_text().split()] for code in CHANNELS}
        print("archive:", {code: len(values) for code, values in counts.items()})
        demand("LK4 follows the outer wall in steps of 0.1 degC", all(
            value % 100 == 0 and abs(value - 38_000) < 1_600 for value in counts["LK4"]) and len(set(counts["LK4"])) > 3)
        demand("LK2 and LK3, LK5 are those of their ovens", all(abs(value - 42_500) < 1_500 for value in counts["LK2"])
               and set(counts["LK3"]) == {42_500} and set(counts["LK5"]) == {38_000})
        namespace = {"s": "http://www.fdsn.org/xml/station/1"}
        stations = ElementTree.parse(data / "metadata" / "station.xml").findall(".//s:Channel", namespace)
        rates = {one.get("code"): float(one.find("s:SampleRate", namespace).text) for one in stations}
        demand(f"StationXML has the channels of both ovens, with their rates: {rates}", all(code in rates for code in CHANNELS)
               and rates["LK4"] == rates["LK5"] == rates["LYO"] and rates["LK4"] <= rates["LK2"])
        if len(sys.argv) > 2:
            shutil.copytree(data, sys.argv[2])


if __name__ == "__main__":
    sys.exit(main())
