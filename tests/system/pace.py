"""At --speed 1 the emulator sends each frame at its due time, and the times do not drift against the host's clock."""

import datetime
import os
import select
import statistics
import subprocess
import time

from emulated_session import DELAY_NS, FRAME
from programs import BIN, IS_LONG, IS_SANITIZED, Scratch, demand, end_cleanly, read_json, start_of

SECONDS = 600 if IS_LONG else 20
START_LOGGING = "FE010D 85060D 86060D 88010D 8C030D 8DC70D FE000D 83010D"


def listen(port, seconds):
    """Returns for each frame the host time in ns of the read that completed it."""
    arrivals, received = [], 0
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if not select.select([port], [], [], 2.0)[0]:
            break
        received += len(os.read(port, 4096))
        now = time.time_ns()
        arrivals += [now] * (received // FRAME - len(arrivals))
    return arrivals


with Scratch() as scratch:
    start = start_of("tsukuba", scratch)
    host_ns = time.time_ns() // 1000 * 1000
    host = datetime.datetime.fromtimestamp(host_ns // 10**9, datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%S")
    sim = subprocess.Popen(
        [BIN / "a351-sim", "device", "--link", "sensor", "--scenario", "tsukuba", "--report", "report.json",
         "--clock", f"scaled:1@{start},{host}.{host_ns % 10**9:09d}Z"], cwd=scratch)
    time.sleep(2.0)
    port = os.open(scratch / "sensor", os.O_RDWR | os.O_NOCTTY)
    for command in START_LOGGING.split():
        os.write(port, bytes.fromhex(command))
        time.sleep(0.01)
    arrivals = listen(port, SECONDS)
    os.write(port, bytes.fromhex("83020D"))
    time.sleep(0.5)
    end_cleanly("the emulator", sim)
    os.close(port)
    report = read_json(scratch / "report.json")

    demand("every frame arrived", len(arrivals) >= 50 * (SECONDS - 1))
    first_ns = host_ns + report["runs"][0]["first_index"] * 20_000_000 + DELAY_NS
    late_ms = [(arrival - first_ns - k * 20_000_000) / 1e6 for k, arrival in enumerate(arrivals)]
    within = sum(1 for late in late_ms if late <= 1.0) / len(late_ms)
    ends = [min(part) for part in (late_ms[:500], late_ms[-500:])]  # The least delay is used, because load only delays frames.
    print(f"{len(arrivals)} frames in {SECONDS} s; at the host: {100 * within:.2f} % within 1 ms of their due time, "
          f"median {statistics.median(late_ms):.3f} ms, largest {max(late_ms):.3f} ms, least in the first "
          f"and last ten seconds {ends[0]:.3f} and {ends[1]:.3f} ms")
    print(f"at the emulator: {report['frames_late']} of {report['frames_sent']} frames later than 1 ms, "
          f"largest {1e3 * report['largest_lateness_s']:.3f} ms")
    demand("no frame arrived before its due time", min(late_ms) >= 0.0)
    demand(f"the least late frame arrived {min(late_ms):.3f} ms after its due time, limit 1", min(late_ms) < 1.0)
    demand(f"the times drifted by {ends[1] - ends[0]:+.3f} ms, limit 0.5", abs(ends[1] - ends[0]) < 0.5)
    if IS_LONG and not IS_SANITIZED:
        demand("99 % of the frames are sent within 1 ms of their due time",
               report["frames_late"] <= 0.01 * report["frames_sent"])
