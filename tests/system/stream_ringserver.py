"""A daemon's records reach slarchive through a351-stream and ringserver byte for byte, while all three are restarted.

ringserver, slarchive and slinktool are searched in PATH or named by A351_RINGSERVER, A351_SLARCHIVE and A351_SLINKTOOL
(https://github.com/EarthScope).  ObsPy reads the ring too, where it is installed.
"""

import os
import pathlib
import random
import shutil
import signal
import socket
import subprocess
import sys
import time

from emulated_session import Session, wait_for
from programs import BIN, IS_LONG, IS_SANITIZED, ONE_SITE, Scratch, demand, run, skip, unused_port

# Each mode: speed, begin, simulated minutes, seconds between restarts, and what is restarted.
MODES = {
    "short": (40 if IS_SANITIZED else 60, "2017-07-15T23:50:00Z", 20, (0.5, 2.0), ("stream", "ring", "slarchive")),
    "three-days": (1000, "2017-07-14T18:00:00Z", 66 * 60, (3.0, 15.0), ("stream", "ring", "slarchive")),
    "two-hours": (20, "2017-07-15T23:00:00Z", 120, (5.0, 30.0), ("stream", "ring", "slarchive", "daemon")),
    "one-hour": (1, "2017-07-15T23:30:00Z", 60, (60.0, 300.0), ("stream", "ring", "slarchive", "daemon")),
}
MODE = sys.argv[1] if len(sys.argv) > 1 else "three-days" if IS_LONG else "short"
SEED = int(sys.argv[2]) if len(sys.argv) > 2 else 1
SPEED, START, MINUTES, PAUSE, RESTARTED = MODES[MODE]


def program(name, variable, is_needed=True):
    found = shutil.which(os.environ.get(variable) or name)
    if found is None and is_needed:
        skip(f"{name} is not in PATH; install it or set {variable}")
    if found:
        version = subprocess.run([found, "-V"], capture_output=True, text=True)
        print((version.stdout + version.stderr).strip())
    return found


def day_files(root):
    root = pathlib.Path(root)
    return {str(file.relative_to(root)): file.read_bytes() for file in root.rglob("*.D.*")}


def is_listening(port):
    with socket.socket() as one:
        return one.connect_ex(("127.0.0.1", port)) == 0


class Service:
    """A program that is started again after each end."""

    def __init__(self, name, command, scratch):
        self.command, self.scratch, self.ends = command, scratch, 0
        self.log = open(scratch / f"{name}.log", "a")
        self.start()

    def start(self):
        self.process = subprocess.Popen(self.command, cwd=self.scratch, stdout=self.log, stderr=self.log)

    def end(self, how=signal.SIGTERM):
        self.process.send_signal(how)
        self.process.wait(timeout=60)
        self.ends += 1


def demand_dump(what, file, written):
    """Compares what slinktool wrote, a mixture of all streams, with the day files."""
    dump, came = file.read_bytes(), {}
    for at in range(0, len(dump), 512):
        record = dump[at:at + 512]
        year, day = int.from_bytes(record[20:22], "big"), int.from_bytes(record[22:24], "big")
        came.setdefault((record[15:18].decode(), f"{year}.{day:03}"), bytearray()).extend(record)
    expected = {(name.split(".")[-4], ".".join(name.split(".")[-2:])): data for name, data in written.items()}
    demand(f"{what} has the {len(dump) // 512} records byte for byte", came == expected)


def read_with_obspy(port, archive):
    try:
        import obspy
        from obspy.clients.seedlink.basic_client import Client
    except ImportError:
        print("ObsPy is not installed; the ring is not read with it")
        return
    start = obspy.UTCDateTime(START) + 300
    came = Client("127.0.0.1", port).get_waveforms("XX", "A351", "00", "BNZ", start, start + 300)
    kept = obspy.Stream()
    for file in sorted(pathlib.Path(archive).rglob("*.BNZ.D.*")):
        kept += obspy.read(str(file), starttime=start, endtime=start + 300)
    came.merge(), kept.merge()
    came.trim(start, start + 300)
    demand(f"ObsPy {obspy.__version__} reads the samples of the archive from the ring",
           len(came) == 1 and len(came[0]) > 14000 and (came[0].data == kept[0].data).all())


ringserver, slarchive = program("ringserver", "A351_RINGSERVER"), program("slarchive", "A351_SLARCHIVE")
slinktool = program("slinktool", "A351_SLINKTOOL", is_needed=False)
chance = random.Random(SEED)
scenario = f"""base = "quiet"
name = "restarts"
[schedule]
start_utc = "{START}"
duration_h = {MINUTES / 60 + 10}
""" + ONE_SITE

with Scratch() as scratch:
    archive, fetched, port = scratch / "data" / "archive", scratch / "fetched", unused_port()
    archive.mkdir(parents=True)
    (scratch / "ring").mkdir()
    (scratch / "ring.conf").write_text(
        f"RingDirectory ring\nRingSize 256M\nListenPort {port} DataLink SeedLink IPv4\nWriteIP 127.0.0.1\n")
    services = {"ring": Service("ring", [ringserver, "ring.conf"], scratch)}
    wait_for("ringserver listens", lambda: is_listening(port))
    # A client gets only data that come after its first connection, so it connects before the first record.
    services["slarchive"] = Service("slarchive", [slarchive, "-v", "-SDS", "fetched", "-nd", "1", "-x", "slarchive.state", "-S",
                                                  "XX_A351", f"127.0.0.1:{port}"], scratch)
    wait_for("slarchive is connected", lambda: "accepted" in (scratch / "slarchive.log").read_text())
    versions = (3, 4) if slinktool else ()
    for version in versions:
        services[f"slinktool {version}"] = Service(f"slinktool {version}", [
            slinktool, "-v", f"-{version}", "-nd", "1", "-x", f"{version}.state:1", "-o", f"{version}.mseed", "-S", "XX_A351",
            f"127.0.0.1:{port}"], scratch)
    time.sleep(1.0)
    services["stream"] = Service("stream", [BIN / "a351-stream", "data", f"127.0.0.1:{port}", "--state", "positions"], scratch)
    (scratch / "restarts.toml").write_text(scenario)
    session = Session(scratch, speed=SPEED, scenario="restarts.toml", start=START)
    counts = dict.fromkeys(RESTARTED, 0)
    try:
        end = time.monotonic() + MINUTES * 60 / SPEED
        while time.monotonic() < end:
            time.sleep(chance.uniform(*PAUSE))
            name = chance.choice(RESTARTED)
            if name == "slarchive" and not day_files(fetched):
                continue  # Without a first record it has no position, and begins with the next one.
            if name == "daemon":
                session.daemon.send_signal(chance.choice([signal.SIGTERM, signal.SIGKILL]))
                session.daemon.wait(timeout=60)
                session.daemon = session.start_daemon()
            else:
                services[name].end(chance.choice([signal.SIGTERM, signal.SIGKILL]) if name == "stream" else signal.SIGTERM)
                time.sleep(chance.uniform(0.0, 1.0))
                services[name].start()
            counts[name] += 1
        print(f"{MODE}, seed {SEED}: restarts {counts}")
        while_growing = sum(len(data) for data in day_files(fetched).values())
        wait_for("the daemon answers", lambda: session.status().get("counters"))
        session.end()
        written = day_files(archive)
        wait_for("all written data are fetched", lambda: sum(map(len, day_files(fetched).values())) >= sum(map(len, written.values())), 180)
        time.sleep(2.0)  # Time in which data might arrive twice.
        demand("all are still running", all(one.process.poll() is None for one in services.values()))
        came, size = day_files(fetched), sum(len(data) for data in written.values())
        print(f"{len(written)} day files, {size // 512} records; {while_growing // 512} were fetched while the files grew")
        demand("data were fetched while the archive grew", while_growing > 0)
        if "daemon" not in RESTARTED:
            session.archive_is_true(missing=0)
        for name in sorted(written):
            if came.get(name) != written[name]:
                print(f"{name}: {len(written[name]) // 512} records, {len(came.get(name, b'')) // 512} came")
        demand("exactly the day files are fetched, byte for byte", came == written)
        for version in versions:
            demand_dump(f"slinktool with SeedLink {version}", scratch / f"{version}.mseed", written)
        read_with_obspy(port, archive)
    finally:
        for service in services.values():
            if service.process.poll() is None:
                service.end()
