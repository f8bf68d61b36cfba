"""a351-stream sends every record of a growing archive to a DataLink server once, in order, whatever happens to either side.

The server is datalink_ring.py, with restarts, refusals, floods and hangs; the client is killed too.  A daemon records beside
it and must lose nothing.  Then the archive is torn and repaired as after a power cut, and the ring loses packets.
"""

import datetime
import random
import shutil
import signal
import subprocess
import threading
import time

from datalink_ring import Ring, fdsn_name
from emulated_session import Session, wait_for
from mseed_records import begin_of
from programs import BIN, IS_SANITIZED, Scratch, demand, instant, one_site, run, unused_port

SEED = 7
SPEED = 20 if IS_SANITIZED else 60
SCENARIO = one_site("quiet", "2017-07-15T23:52:00Z", 10)
FRAMES = 16 * 60 * 50
RECORD = 512
SEVEN_MOODS = ["mute", "forgetful", "refuse", "flood", "deaf", "forgetful", "babble"]


class Client:
    """a351-stream as a process that can be killed."""

    def __init__(self, root, port, log, state):
        self.command = [BIN / "a351-stream", root, f"127.0.0.1:{port}", "--state", state]
        self.log = open(log, "a")
        self.start()

    def start(self):
        self.process = subprocess.Popen(self.command, stderr=self.log)

    def end(self, how=signal.SIGTERM):
        """Returns what is wrong with the end, or nothing: demand() in a thread ends the thread only."""
        self.process.send_signal(how)
        try:
            status = self.process.wait(timeout=30)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
            return [f"a351-stream does not end on signal {how}"]
        return [] if status == (0 if how == signal.SIGTERM else -how) else [f"a351-stream ends on signal {how} with {status}"]

    def end_well(self, how=signal.SIGTERM):
        faults = self.end(how)
        demand(f"a351-stream ends as told {faults}", not faults)


def archived(archive):
    """Returns the records of each stream, day after day, as the ring names the stream."""
    streams = {}
    for file in sorted(archive.rglob("*.D.*"), key=lambda one: one.name):
        network, station, location, channel, _, _, _ = file.name.split(".")
        name = fdsn_name(f"{network}_{station}_{location}_{channel}/MSEED")
        streams[name] = streams.get(name, b"") + file.read_bytes()
    return streams


def demand_same(what, ring, archive):
    written = archived(archive)
    wait_for(f"{what}: the ring has as many bytes as the archive",
             lambda: sum(len(ring.data_of(name)) for name in written) >= sum(map(len, written.values())))
    time.sleep(0.6)  # Time in which a record might arrive twice.
    for name, data in written.items():
        came = ring.data_of(name)
        demand(f"{what}: {name} has the {len(data) // RECORD} records of the archive, in order, none twice", came == data)
    demand(f"{what}: the ring has no other streams", ring.streams() == sorted(written))
    demand(f"{what}: the client kept to the protocol {ring.faults}", not ring.faults)


def first_sample(record):
    """Returns the start of a record in us."""
    return (begin_of(record) - instant("1970-01-01T00:00:00Z")) // datetime.timedelta(microseconds=1)


def demand_headers(ring):
    wrong = [packet[:4] for packet in ring.packets
             if packet[2] != first_sample(packet[4]) or not packet[2] <= packet[3] < packet[2] + 61 * 10**6]
    demand(f"each packet says when its record begins and ends {wrong[:3]}", not wrong)


def trouble_for(ring, client, stop, faults):
    """Restarts server and client until told to stop; every mood comes at least once.  It adds what goes wrong to `faults`."""
    chance = random.Random(SEED)
    ring.moods = list(SEVEN_MOODS)
    restarts = 0
    while not stop.is_set():
        stop.wait(chance.uniform(0.3, 1.2))
        if chance.random() < 0.5:
            ring.stop()
            stop.wait(chance.uniform(0.0, 0.5))
            ring.start()
        else:
            faults += client.end(chance.choice([signal.SIGTERM, signal.SIGKILL]))
            client.start()
        restarts += 1
    print(f"{restarts} restarts, {ring.connections} connections: {', '.join(ring.seen)}")


def live(scratch):
    """A daemon records at SPEED while server and client have their troubles."""
    (scratch / "midnight.toml").write_text(SCENARIO)
    ring = Ring(unused_port())
    ring.start()
    (scratch / "data").mkdir()
    client = Client(scratch / "data", ring.port, scratch / "stream.log", scratch / "positions")
    patient = Ring(unused_port())  # Its client waits for acknowledgements until its time limit.
    patient.moods = ["deaf"]
    patient.start()
    waiting = Client(scratch / "data", patient.port, scratch / "waiting.log", scratch / "waiting.positions")
    session = Session(scratch, speed=SPEED, scenario="midnight.toml")
    stop, faults = threading.Event(), []
    trouble = threading.Thread(target=trouble_for, args=(ring, client, stop, faults))
    trouble.start()
    session.wait_for_frames(FRAMES)
    stop.set()
    trouble.join()
    demand(f"the client ended as told each time {faults}", not faults)
    while_growing = len(ring.packets)
    demand(f"{while_growing} packets came while the archive grew", while_growing > 0)
    session.end()
    session.archive_is_true(missing=0)
    demand("every kind of trouble happened", set(SEVEN_MOODS) <= set(ring.seen))
    if client.process.poll() is None:
        client.end_well()
    client.start()
    demand_same("after all troubles", ring, scratch / "data" / "archive")
    demand_headers(ring)
    client.end_well()
    demand_same("after a hang", patient, scratch / "data" / "archive")
    waiting.end_well()
    said = (scratch / "waiting.log").read_text()
    for text in ("no answer within 10 s", "connected again"):
        demand(f"the hang is reported: {text}", said.count(f"a351-stream: 127.0.0.1:{patient.port}: {text}\n") == 1)
    return ring


def torn(scratch):
    """The last records are cut off, are half written, and come again, as after a power cut and its repair."""
    root, ring = scratch / "torn", Ring(unused_port())
    source = scratch / "data" / "archive"
    days = sorted((one.relative_to(source) for one in source.rglob("*.BNZ.D.*")), key=lambda one: one.name)
    content = {day: (source / day).read_bytes() for day in days}
    (root / "archive" / days[0]).parent.mkdir(parents=True)
    ring.start()
    client = Client(root, ring.port, scratch / "torn.log", scratch / "torn.positions")
    chance, cuts = random.Random(SEED), 0
    for day in days:
        file, data, size = root / "archive" / day, content[day], RECORD
        file.write_bytes(data[:size])
        while size < len(data):
            size = min(len(data), size + chance.randrange(3000))
            with open(file, "ab") as out:
                out.write(data[file.stat().st_size:size])
            time.sleep(0.05)
            if chance.random() < 0.2:  # Records that were sent, perhaps, are lost and made again.
                size = max(RECORD, (size // RECORD - chance.randrange(3)) * RECORD)
                time.sleep(chance.choice([0.0, 0.6]))
                with open(file, "ab") as out:
                    out.truncate(size)
                cuts += 1
                if chance.random() < 0.3:
                    client.end_well(signal.SIGKILL)
                    client.start()
    print(f"{cuts} cuts of {len(days)} day files")
    demand_same("after cuts", ring, root / "archive")

    # A record is damaged, and good ones follow it: it is skipped and reported.
    client.end_well()
    damaged = scratch / "damaged"
    shutil.copytree(root / "archive", damaged / "archive")
    file = damaged / "archive" / days[0]
    data = bytearray(file.read_bytes())
    data[2 * RECORD:3 * RECORD] = bytes(RECORD)
    file.write_bytes(data)
    other = Ring(unused_port())
    other.start()
    said = run(BIN / "a351-stream", damaged, f"127.0.0.1:{other.port}", "--once").stderr
    demand(f"damage is reported: {said.strip()}", f"{file.name}: offset 1024: 512 bytes are not a record" in said)
    demand("all records but the damaged one are sent",
           b"".join(packet[4] for packet in other.packets) == bytes(data[:2 * RECORD] + data[3 * RECORD:]) + content[days[1]])
    return ring


def lost(scratch, ring):
    """The ring loses the packets of some streams, then all of them."""
    archive = scratch / "data" / "archive"
    command = [BIN / "a351-stream", scratch / "data", f"127.0.0.1:{ring.port}", "--once", "--state", scratch / "positions"]
    slow = fdsn_name("XX_A351_00_LK1/MSEED")
    newest = max(packet[0] for packet in ring.packets if packet[1] == slow)
    ring.drop(lambda packet: packet[0] <= newest)  # Packets are replaced in the order in which they came.
    left = list(ring.packets)
    demand(f"the ring still has {len(left)} packets, none of the slow stream", left)
    said = run(*command).stderr
    demand(f"what other packets replaced is not sent again: {said.strip()}",
           ring.packets == left and "XX_A351_00_LK1 is not in the ring; it continues after record" in said)
    ring.packets, ring.next_id = [], 1
    run(*command)
    demand_same("in a new ring", ring, archive)
    ring.packets, ring.next_id = [], 1
    run(*command, "--from", "2017-07-16T00:00:00Z")
    second_day = archived(archive / "2017")
    for name in second_day:
        came = ring.data_of(name)
        demand(f"--from: {name} begins with the record of that instant, not with the first",
               second_day[name].endswith(came) and 0 < len(came) < len(second_day[name]))

    ring.packets, ring.next_id = [(1, slow, 0, 0, bytes(RECORD))], 2
    said = run(*command).stderr
    others = {name: data for name, data in archived(archive).items() if name != slow}
    demand("a packet of another program stops its own stream only, with a message",
           "XX_A351_00_LK1: the last packet in the ring is not a record" in said
           and ring.data_of(slow) == bytes(RECORD) and all(ring.data_of(name) == data for name, data in others.items()))


with Scratch() as scratch:
    ring = live(scratch)
    torn(scratch)
    lost(scratch, ring)
    print((scratch / "stream.log").read_text()[-1500:])
