"""Writes the made-up golden logs and what must come out of them, which is known from the making: see README.md.

    make_logs.py DIRECTORY
"""

import pathlib
import random
import struct
import sys

import check_logs
import journal_page

RATE_HZ, STEP, BAUD = 50, 80, 460800
START_NS = 1772370000 * 10**9  # 2026-03-01T13:00:00Z
RAW_NS = 3600 * 10**9
FIRST_COUNT = 65536 - 200 * STEP  # The counter wraps in every log.


class Log:
    """Samples by index, their frames, and the bytes that were received in their stead."""

    def __init__(self, name, seed):
        self.name, self.random = name, random.Random(seed)
        self.received = []  # (time in ns since the start, bytes)
        self.samples = []   # rows of the expected CSV
        self.frames = 0
        self.more = dict.fromkeys(
            "checksum_errors framing_errors gaps samples_missing duplicates anomalies".split(), 0)

    def values(self, index):
        noise = [self.random.randrange(-40, 41) for _ in range(4)]
        return [0x8E00, -1981 + noise[3] % 3, noise[0] - 203896, noise[1] + 9000,
                noise[2] + 16760439, (FIRST_COUNT + index * STEP) % 65536]

    @staticmethod
    def frame(values):
        payload = struct.pack(">HiiiiH", *values)
        total = sum(struct.unpack(">10H", payload))
        return b"\x80" + payload + struct.pack(">H", total % 65536) + b"\x0d"

    def receive(self, index, data):
        self.received.append(((index + 1) * 10**9 // RATE_HZ, data))

    def keep(self, index, values):
        if self.samples and index != self.samples[-1][0] + 1:
            self.more["gaps"] += 1
            self.more["samples_missing"] += index - self.samples[-1][0] - 1
        self.samples.append([index, values[5], *values[2:5], values[1]])
        self.frames += 1

    def good(self, index, values=None):
        values = values or self.values(index)
        self.keep(index, values)
        self.receive(index, self.frame(values))

    def run(self, first, end):
        for index in range(first, end):
            self.good(index)

    def write(self, directory):
        stream, cuts = [], []
        for time, data in self.received:  # cut anywhere, as reads are
            while data:
                size = self.random.choice([1, 2, 7, 24, 24, 24, 48])
                cuts.append((RAW_NS + time + self.random.randrange(3 * 10**6), data[:size]))
                data = data[size:]
        latest = 0
        for time, part in cuts:
            latest = max(latest, time)
            if stream and latest - stream[-1][0][0] < 10**9 and len(stream[-1]) < 200:
                stream[-1].append((latest, part))
            else:
                stream.append([(latest, part)])
        chunks = [journal_page.head(
            session=f"{self.random.getrandbits(128):032x}", boot_id="made-up", program_version="made-up",
            network="XX", station="A351", location="00", axes=["1", "2", "Z"], profile="A351",
            product_id="A351AU10", serial_number="00000001", firmware=1, output_rate_hz=RATE_HZ,
            filter="k512_fc9", burst_ctrl=0xC703, baud=BAUD,
            clock={"raw_ns": RAW_NS, "boottime_ns": RAW_NS, "realtime_ns": START_NS,
                   "synchronised": True, "max_error_us": 500, "estimated_error_us": 100})]
        for reads in stream:
            chunks.append(journal_page.rx(reads))
            raw = reads[-1][0]
            chunks.append(journal_page.clock(raw, START_NS + raw - RAW_NS))
        (directory / f"{self.name}.a351j").write_bytes(journal_page.segment(chunks))
        total = sum(len(data) for _, data in self.received)
        frames = self.frames + self.more["duplicates"]
        for key in [key for key, value in self.more.items() if value is None]:
            self.more[key] = check_logs.read_log(directory / f"{self.name}.a351j")[1][key]
        counters = {"bytes": total, "frames": frames, "bytes_skipped": total - 24 * frames,
                    **self.more, "sessions": 1}
        (directory / f"{self.name}.counters").write_text(
            "".join(f"{key} {value}\n" for key, value in counters.items()))
        with open(directory / f"{self.name}.csv", "w") as out:
            out.write("index,count,x,y,z,temp\n")
            for row in self.samples:
                out.write(",".join(map(str, row)) + "\n")


def flipped_bits(log):
    """One flipped bit in each field of a frame in turn: that frame is gone and no other."""
    log.run(0, 20)
    for i, byte in enumerate([0, 1, 4, 6, 9, 10, 14, 17, 18, 20, 21, 23]):
        index = 20 + 20 * i
        data = bytearray(log.frame(log.values(index)))
        data[byte] ^= 1 << (i % 8)
        log.receive(index, bytes(data))
        log.more["framing_errors" if byte in (0, 23) else "checksum_errors"] += 1
        log.run(index + 1, index + 20)


def lost_bytes_and_garbage(log):
    """Bytes lost from a frame, and bytes of nobody between frames.  How the skipped bytes fall into runs
    is for the decoder's rules: these two counters are what check_logs.py finds."""
    log.run(0, 40)
    at = 40
    for lost, where in [(1, 0), (1, 12), (1, 23), (5, 3), (23, 0), (24, 0)]:
        data = log.frame(log.values(at))
        log.receive(at, data[:where] + data[where + lost:])
        log.run(at + 1, at + 30)
        at += 30
    for count in [1, 2, 23, 24, 25, 300, 2000]:
        log.receive(at, bytes(log.random.choice([0x80, 0x0D, log.random.randrange(256)]) for _ in range(count)))
        log.run(at, at + 30)
        at += 30
    log.more.update(checksum_errors=None, framing_errors=None)


def gap_over_a_wrap(log):
    """Silence of 30 s, longer than a wrap of the counter, and of 100 s, longer than the 81.92 s after
    which counter and index agree again; and 7 frames lost with no silence to speak of."""
    log.run(0, 200)
    log.run(1700, 1900)
    log.run(6900, 7000)
    log.run(7007, 7100)


def duplicates(log):
    """Frames sent twice and three times; and one that has a counter seen before but other values: the
    first stands."""
    at = 0
    for copies in [1, 2, 1, 1]:
        log.run(at, at + 49)
        values = log.values(at + 49)
        log.good(at + 49, values)
        for _ in range(copies):
            log.receive(at + 49, log.frame(values))
            log.more["duplicates"] += 1
        at += 50
    other = log.values(at)
    log.good(at, other)
    log.receive(at, log.frame(other[:2] + [other[2] + 1000] + other[3:]))
    log.more["duplicates"] += 1
    log.run(at + 1, at + 40)


def markers_in_payload(log):
    """Start and end bytes, and what terminals take for themselves, as data; the log begins within a
    frame."""
    special = [0x80, 0x0D, 0x0A, 0x11, 0x13, 0x03, 0x1A, 0x00, 0xFF]
    fragment = log.frame(log.values(0))[9:]
    log.receive(0, fragment)
    log.more["framing_errors"] = 1
    for index in range(1, 400):
        word = lambda: int.from_bytes(bytes(log.random.choice(special) for _ in range(4)), "big", signed=True)
        axes = [word() for _ in range(3)]
        axes = [1 if axis == 0x64000000 else axis for axis in axes]
        log.good(index, [0x8E00, word(), *axes, (FIRST_COUNT + index * STEP) % 65536])
    first = log.samples[0][0]
    for row in log.samples:
        row[0] -= first


if __name__ == "__main__":
    for seed, make in enumerate([flipped_bits, lost_bytes_and_garbage, gap_over_a_wrap, duplicates,
                                 markers_in_payload], start=1):
        log = Log(make.__name__, seed)
        make(log)
        log.write(pathlib.Path(sys.argv[1]))
