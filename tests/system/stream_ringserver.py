"""A daemon's records reach slarchive through a351-stream and ringserver byte for byte, while all three are restarted.

ringserver, slarchive and slinktool are searched in PATH or named by A351_RINGSERVER, A351_SLARCHIVE and A351_SLINKTOOL.
slinktool and ObsPy (with_obspy.py) read the ring too, where they are installed.
"""

import pathlib
import random
import signal
import subprocess
import sys
import time

from emulated_session import Session, wait_for
from programs import BIN, IS_LONG, IS_SANITIZED, Scratch, contents, demand, one_site, unused_port
from seedlink import is_listening, program
from with_obspy import HINT, has_obspy

if has_obspy():
    import obspy
    from obspy.clients.seedlink.basic_client import Client
else:
    obspy = None
    print(f"{HINT}: it does not read the ring")

CLIENTS = ("stream", "ring", "slarchive")
# Each mode: speed, begin, simulated minutes, how often each is restarted, and what is restarted.  "hang" stops the ring for a while.
MODES = {
    "short": (40 if IS_SANITIZED else 60, "2017-07-15T23:50:00Z", 20, 3, (*CLIENTS, "hang")),
    "three-days": (1000, "2017-07-14T18:00:00Z", 72 * 60, 20, (*CLIENTS, "hang")),
    "two-hours": (20, "2017-07-15T23:00:00Z", 120, 20, (*CLIENTS, "hang", "daemon")),
    "one-hour": (1, "2017-07-15T23:30:00Z", 60, 20, (*CLIENTS, "hang", "daemon")),
}
LONGEST_HANG_S = 5.0  # a351-stream counts 10 s without an answer as an outage, after which records may come twice.
MODE = sys.argv[1] if len(sys.argv) > 1 else "three-days" if IS_LONG else "short"
SEED = int(sys.argv[2]) if len(sys.argv) > 2 else 1
SPEED, START, MINUTES, TIMES, RESTARTED = MODES[MODE]


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
    """Compares what a client wrote, a mixture of all streams, with the day files."""
    dump, came = file.read_bytes(), {}
    for at in range(0, len(dump), 512):
        record = dump[at:at + 512]
        year, day = int.from_bytes(record[20:22], "big"), int.from_bytes(record[22:24], "big")
        came.setdefault((record[15:18].decode(), f"{year}.{day:03}"), bytearray()).extend(record)
    expected = {(name.split(".")[-4], ".".join(name.split(".")[-2:])): data for name, data in written.items()}
    demand(f"{what} has the {len(dump) // 512} records byte for byte", came == expected)


def read_with_obspy(port, archive):
    """Asks ObsPy for five minutes of the past."""
    start = obspy.UTCDateTime(START) + 60 * MINUTES - 900
    came = Client("127.0.0.1", port).get_waveforms("XX", "A351", "00", "BNZ", start, start + 300)
    kept = obspy.Stream()
    for file in sorted(pathlib.Path(archive).rglob("*.BNZ.D.*")):
        kept += obspy.read(str(file), starttime=start, endtime=start + 300)
    came.merge(), kept.merge()
    came.trim(start, start + 300)
    demand(f"ObsPy {obspy.__version__} reads the samples of the archive from the ring",
           len(came) == 1 and len(came[0]) > 14000 and (came[0].data == kept[0].data).all())


def plan(seconds):
    """Returns what happens and when, in s from the begin: every kind equally often, in random order at random instants."""
    names = [name for name in RESTARTED for _ in range(TIMES)]
    chance.shuffle(names)
    return zip(sorted(chance.uniform(0.0, 0.95 * seconds) for _ in names), names)


def disturb(name):
    """Restarts a program, or stops the ring for a while."""
    if name == "hang":
        services["ring"].process.send_signal(signal.SIGSTOP)
        time.sleep(chance.uniform(0.0, min(LONGEST_HANG_S, MINUTES * 3 / SPEED)))
        services["ring"].process.send_signal(signal.SIGCONT)
    elif name == "daemon":
        session.daemon.send_signal(chance.choice([signal.SIGTERM, signal.SIGKILL]))
        session.daemon.wait(timeout=60)
        session.daemon = session.start_daemon()
    else:
        ended = [one for one in services if one.startswith(name)]
        for one in ended:
            services[one].end(chance.choice([signal.SIGTERM, signal.SIGKILL]) if name == "stream" else signal.SIGTERM)
        time.sleep(chance.uniform(0.0, 1.0))
        for one in ended:
            services[one].start()


ringserver, slarchive = program("ringserver"), program("slarchive")
slinktool = program("slinktool", is_needed=False)
if slinktool:
    RESTARTED = (*RESTARTED, "slinktool")
chance = random.Random(SEED)
scenario = one_site("quiet", START, MINUTES / 60 + 10)

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
    dumps = {}  # What the other clients write, by its file.
    for version in (3, 4) if slinktool else ():
        services[f"slinktool {version}"] = Service(f"slinktool {version}", [
            slinktool, "-v", f"-{version}", "-nd", "1", "-x", f"{version}.state", "-o", f"{version}.mseed", "-S", "XX_A351",
            f"127.0.0.1:{port}"], scratch)
        dumps[scratch / f"{version}.mseed"] = f"slinktool with SeedLink {version}"
    if obspy:
        services["obspy"] = Service("obspy", [sys.executable, pathlib.Path(__file__).with_name("obspy_client.py"), str(port),
                                              "obspy.mseed"], scratch)
        dumps[scratch / "obspy.mseed"] = f"ObsPy {obspy.__version__}"
        wait_for("ObsPy is connected", lambda: "connected to" in (scratch / "obspy.log").read_text())
    time.sleep(1.0)
    services["stream"] = Service("stream", [BIN / "a351-stream", "data", f"127.0.0.1:{port}", "--state", "positions"], scratch)
    (scratch / "restarts.toml").write_text(scenario)
    session = Session(scratch, speed=SPEED, scenario="restarts.toml", start=START)
    counts = dict.fromkeys(RESTARTED, 0)
    try:
        # Without a first record a client has no position: after a restart it would begin with the next one.
        wait_for("every client has a record", lambda: contents(fetched, "*.D.*") and all(one.exists() and one.stat().st_size for one in dumps), 180)
        begin, seconds = time.monotonic(), MINUTES * 60 / SPEED
        for at, name in plan(seconds):
            time.sleep(max(0.0, begin + at - time.monotonic()))
            disturb(name)
            counts[name] += 1
        time.sleep(max(0.0, begin + seconds - time.monotonic()))
        print(f"{MODE}, seed {SEED}: restarts {counts}")
        while_growing = sum(len(data) for data in contents(fetched, "*.D.*").values())
        wait_for("the daemon answers", lambda: session.status().get("counters"))
        session.end()
        written = contents(archive, "*.D.*")
        size = sum(map(len, written.values()))
        wait_for("all written data are fetched", lambda: sum(map(len, contents(fetched, "*.D.*").values())) >= size, 180)
        for file, what in dumps.items():
            wait_for(f"{what} has fetched as many bytes", lambda: file.stat().st_size >= size, 300)
        time.sleep(2.0)  # Time in which data might arrive twice.
        demand("all are still running", all(one.process.poll() is None for one in services.values()))
        came = contents(fetched, "*.D.*")
        print(f"{len(written)} day files, {size // 512} records; {while_growing // 512} were fetched while the files grew")
        demand("data were fetched while the archive grew", while_growing > 0)
        if "daemon" not in RESTARTED:
            session.archive_is_true(missing=0)
        for name in sorted(written):
            if came.get(name) != written[name]:
                print(f"{name}: {len(written[name]) // 512} records, {len(came.get(name, b'')) // 512} came")
        demand("exactly the day files are fetched, byte for byte", came == written)
        for file, what in dumps.items():
            demand_dump(what, file, written)
        if obspy:
            read_with_obspy(port, archive)
    finally:
        for service in services.values():
            if service.process.poll() is None:
                service.end()
