"""With storage.record_age_s = 1 a record reaches clients of ringserver within 2 s, and the archive keeps what it promises.

The time counts from the last sample of the record; its first sample is a second older.  ringserver 4.5.3 takes up to a second of it:
it looks for new records once a second when it has sent all.  The way is the real one: emulated sensor, daemon, archive, a351-stream,
ringserver, slinktool; without the last two (see stream_ringserver.py) it ends at datalink_ring.py.  Then the daemon is killed and
started again, and records that are lost are made again from the journal (recovery_test.cpp has all cases).
A351_LONG=1: for a minute; otherwise for half a minute.
"""

import datetime
import signal
import statistics
import subprocess
import time

from datalink_ring import Ring
from emulated_session import Session, wait_for
from programs import BIN, IS_LONG, IS_SANITIZED, ONE_SITE, Scratch, demand, unused_port
from seedlink import day_files, is_listening, program

RECORD, SECONDS = 512, 60 if IS_LONG else 30
MOST_S = 2.0
TIME_ERROR_S = 0.01  # That of kill_daemon.py at factor 1.
START = "2017-07-15T23:59:45Z"  # A quarter of a minute before midnight.
SCENARIO = f"""base = "quiet"
name = "short-records"
[schedule]
start_utc = "{START}"
duration_h = 10.0
""" + ONE_SITE


def first_sample(record):
    """Returns the time of the first sample of a record, from its fixed header and blockette 1001."""
    year, day = int.from_bytes(record[20:22], "big"), int.from_bytes(record[22:24], "big")
    begin = datetime.datetime(year, 1, 1, *record[24:27], tzinfo=datetime.timezone.utc) + datetime.timedelta(days=day - 1)
    microseconds = int.from_bytes(record[28:30], "big") * 100 + int.from_bytes(record[61:62], "big", signed=True)
    return begin + datetime.timedelta(microseconds=microseconds)


class Server:
    """ringserver with slinktool, or the ring of the tests; fetched() returns all records so far, one after the other."""

    def __init__(self, scratch):
        self.port, self.programs, self.file = unused_port(), [], scratch / "fetched.mseed"
        ringserver, slinktool = program("ringserver", is_needed=False), program("slinktool", is_needed=False)
        self.has_both = bool(ringserver and slinktool)
        if not self.has_both:
            self.ring = Ring(self.port)
            return self.ring.start()
        (scratch / "ring.conf").write_text(
            f"VolatileRing 1\nRingSize 64M\nListenPort {self.port} DataLink SeedLink IPv4\nWriteIP 127.0.0.1\n")
        log = open(scratch / "server.log", "w")
        self.programs.append(subprocess.Popen([ringserver, "ring.conf"], cwd=scratch, stdout=log, stderr=log))
        wait_for("ringserver listens", lambda: is_listening(self.port))
        self.programs.append(subprocess.Popen([slinktool, "-4", "-o", self.file, "-S", "XX_A351", f"127.0.0.1:{self.port}"],
                                              cwd=scratch, stdout=log, stderr=log))
        time.sleep(1.0)

    def fetched(self):
        if self.has_both:
            return self.file.read_bytes() if self.file.exists() else b""
        with self.ring.lock:
            return b"".join(packet[4] for packet in self.ring.packets)

    def end(self):
        for one in reversed(self.programs):
            one.send_signal(signal.SIGTERM)
            one.wait(timeout=30)


def latencies(session, server):
    """Returns how old the oldest and the newest sample of each record are on arrival, in s, for the channels of the sensor."""
    start, host = (datetime.datetime.fromisoformat(part.replace("Z", "+00:00")) for part in session.clock.split("@")[1].split(","))
    begin, seen, oldest, newest = None, 0, [], []
    end = time.monotonic() + SECONDS
    while time.monotonic() < end:
        time.sleep(0.01)
        data, now = server.fetched(), start + (datetime.datetime.now(datetime.timezone.utc) - host)
        for at in range(seen, len(data) // RECORD * RECORD, RECORD):
            record = data[at:at + RECORD]
            seen = at + RECORD
            if record[15:16] != b"B":
                continue
            begin = begin or first_sample(record)
            if first_sample(record) < begin + datetime.timedelta(seconds=3):
                continue  # The times of the first 2 s of a stream are not known at once.
            age_s = (now - first_sample(record)).total_seconds()
            oldest.append(age_s)
            newest.append(age_s - (int.from_bytes(record[30:32], "big") - 1) / 50.0)
    return oldest, newest


with Scratch() as scratch:
    (scratch / "short-records.toml").write_text(SCENARIO)
    (scratch / "data").mkdir()
    server = Server(scratch)
    stream = subprocess.Popen([BIN / "a351-stream", "data", f"127.0.0.1:{server.port}"], cwd=scratch)
    session = Session(scratch, speed=1, scenario="short-records.toml", start=START, storage="record_age_s = 1\n")
    try:
        oldest, newest = latencies(session, server)
    finally:
        stream.send_signal(signal.SIGTERM)
        stream.wait(timeout=30)
        server.end()
    print(f"from the sensor to {'slinktool' if server.has_both else 'the ring'}: {len(oldest)} records; oldest sample of a record "
          f"median {statistics.median(oldest):.2f} s, worst {max(oldest):.2f} s; newest sample median {statistics.median(newest):.2f} s, "
          f"worst {max(newest):.2f} s")
    demand(f"{len(oldest)} records came, four a second", len(oldest) > 3.5 * (SECONDS - 10))
    late = sum(age > MOST_S for age in newest)
    demand(f"{late} records came later than {MOST_S} s after their last sample", IS_SANITIZED or late == 0)

    for how in (signal.SIGKILL, signal.SIGTERM, signal.SIGKILL):
        session.daemon.send_signal(how)
        session.daemon.wait(timeout=60)
        session.daemon = session.start_daemon()
        session.settled()
    session.end()
    for name, counted in session.counted().items():
        demand(f"{name}: no sample was altered or repeated by three restarts", counted["altered"] == counted["duplicated"] == 0)
        demand(f"{name}: times are right within {counted['largest_time_error_s'] * 1e3:.1f} ms, limit {TIME_ERROR_S * 1e3:.0f} ms",
               counted["largest_time_error_s"] <= TIME_ERROR_S)

    def started_again():
        session.log = open(scratch / "a351d.log", "w")
        session.daemon = session.start_daemon()
        wait_for("the journal is replayed", lambda: "records added" in (scratch / "a351d.log").read_text())
        session.daemon.send_signal(signal.SIGTERM)
        session.daemon.wait(timeout=60)

    archive = scratch / "data" / "archive"
    written = day_files(archive)
    started_again()
    demand(f"a start after a clean end changes none of the {len(written)} day files", day_files(archive) == written)
    for name in written:  # The last record is lost and the one before torn, as in a power cut.
        if name.endswith(max(written).rsplit(".", 1)[1]) and ".B" in name:
            with open(archive / name, "ab") as file:
                file.truncate(len(written[name]) - RECORD - 100)
    started_again()
    demand("records that were lost are made again from the journal, byte for byte", day_files(archive) == written)
