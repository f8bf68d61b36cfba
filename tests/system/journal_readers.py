"""The journal's reader and the stranger's, stranger_journal.py, agree on the chunks and on the damage of any segment.

Segments are made of valid chunks, of chunks at and beyond the limits of their fields, and of damage of ten kinds, also with
checksums corrected afterwards.  A351_LONG=1: 200 000 segments; otherwise 4000.
"""

import json
import random
import struct

from programs import IS_LONG, TOOLS, TOP, Scratch, demand, run
from stranger_journal import PREAMBLE, crc, segment

COUNT = 200_000 if IS_LONG else 4000
BATCH = 2000
GOLDEN = segment((TOP / "tests/golden/journal/00000001_20260301T130000Z.a351j").read_bytes())[0]
EDGES = [0, 1, -1, 2**47, -2**47, 2**47 + 1, 2**53, -2**53, 2**53 + 1, 2**58, -2**58, 2**58 + 1, -2**58 - 1, 3_900_000_000_000_000_000,
         3_900_000_000_000_000_001, 2**63 - 1, -2**63]
OF_HEAD = ["session", "boot_id", "program_version", "network", "station", "location", "axes", "profile", "product_id", "serial_number",
           "firmware", "output_rate_hz", "filter", "burst_ctrl", "baud", "clock"]


def encode(kind, number, payload):
    front = struct.pack("<IBI", len(payload), kind, number)
    return front + struct.pack("<I", crc(front + payload)) + payload


def head(draw):
    """Returns a HEAD; every other one has a key that is missing or has another value."""
    value = json.loads(GOLDEN[0][2])
    if draw.random() < 0.5:
        where, key = draw.choice([(value, key) for key in OF_HEAD] + [(value["clock"], key) for key in sorted(value["clock"])])
        where.pop(key)
        if draw.random() < 0.7:
            # A number for a flag or a fraction for an integer is not tried: the page leaves them open.
            where[key] = draw.choice([None, "", "a", "AB", "A" * 6, [], {}, ["X", "Y", "Z"], ["X", "Y"], ["X", "Y", "z"]])
    return json.dumps(value).encode()


def payload(draw, kind):
    """Returns a payload of the type, whose integers are often at a limit or beyond it."""
    def wide():
        return draw.choice(EDGES) if draw.random() < 0.05 else draw.randrange(2**40)

    if kind == 1:
        return head(draw)
    if kind == 2:
        ends = sorted(draw.randrange(40) for _ in range(draw.randrange(4)))
        reads = b"".join(struct.pack("<Iq", end, wide()) for end in ends)
        return struct.pack("<qI", wide(), len(ends) + (draw.random() < 0.1)) + reads + bytes(ends[-1] if ends and draw.random() < 0.9 else 7)
    if kind == 4:
        return struct.pack("<qqqBqq", wide(), wide(), wide(), draw.choice([0, 1, 2, 3, 4, 5, 6, 7, 8, 255]), wide(), wide())
    if kind == 5:
        return struct.pack("<qqqB", wide(), wide(), wide(), draw.randrange(6))
    if kind == 7:
        return bytes(16) + b"".join(struct.pack("<B3sqq", 3, b"BNZ", wide(), wide()) for _ in range(draw.randrange(3)))
    if kind in (8, 9):
        registers = draw.randrange(4)
        return struct.pack("<qBBB", wide(), draw.randrange(8), 1, registers) + bytes(2 * registers)
    return struct.pack("<q", wide()) + draw.randbytes(draw.randrange(20))


def undamaged(draw):
    """Returns the chunks of a segment."""
    chunks = [GOLDEN[0] if draw.random() < 0.9 else (1, 0, head(draw))]
    for number in range(1, draw.randrange(2, 14)):
        kind = draw.choice([*range(2, 9), 2, 3, 6, draw.choice([0, 1, 9, 10, 200])])
        content = payload(draw, kind)
        if draw.random() < 0.3:
            kind, _, content = draw.choice(GOLDEN[1:])
        chunks.append((kind, number, content))
    return chunks


def damage(draw, chunks):
    """Returns the bytes of the chunks after a few damages."""
    for _ in range(draw.choice([0, 0, 1, 2])):
        at = draw.randrange(len(chunks))
        kind, number, content = chunks[at]
        way = draw.randrange(6)
        if way == 0:
            chunks.insert(at, chunks[at])
        elif way == 1:
            chunks.pop(draw.randrange(len(chunks)))
        elif way == 2:
            chunks[at] = kind, draw.choice([0, 1, number + 1, number + draw.randrange(300), 2**31]), content
        elif way == 3 and content:
            place = draw.randrange(len(content))
            chunks[at] = kind, number, content[:place] + bytes([content[place] ^ 1 << draw.randrange(8)]) + content[place + 1:]
        elif way == 4:
            chunks[at] = kind, number, content[:draw.randrange(len(content) + 1)]
        else:
            chunks[at] = draw.randrange(12), number, content
        if not chunks:
            break
    data = bytearray(PREAMBLE + b"".join(encode(*each) for each in chunks))
    for _ in range(draw.choice([0, 0, 1, 1, 2, 3])):
        at = draw.randrange(len(data) + 1)
        length = draw.choice([1, 2, 13, 40, 200])
        way = draw.randrange(5)
        if way == 0 and at < len(data):
            data[at] ^= 1 << draw.randrange(8)
        elif way == 1:
            del data[at:at + length]
        elif way == 2:
            data[at:at] = draw.randbytes(length)
        elif way == 3:
            data[at:at + length] = bytes(length)
        else:
            del data[at:]
    return bytes(data)


def printed(text):
    """Returns the lines of each segment, by its counter."""
    parts = text.split("segment ")[1:]
    return {int(part.split("\n", 1)[0]): part.split("\n")[1:-1] for part in parts}


def written(kind, number, content):
    """Returns the line of a chunk as a writer encodes it again: the first read of an RX has the delta 0."""
    if kind == 2:
        first, count = struct.unpack_from("<qI", content)
        reads = list(struct.iter_unpack("<Iq", content[12:12 + 12 * count]))
        moved = b"".join(struct.pack("<Iq", end, delta - reads[0][1]) for end, delta in reads)
        content = struct.pack("<qI", first + reads[0][1], count) + moved + content[12 + len(moved):]
    return f"chunk {kind} {number} {0 if kind == 1 else struct.unpack_from('<I', encode(kind, number, content), 9)[0]}"


def expected(data):
    chunks, places = segment(data)
    return [written(*each) for each in chunks] + [f"damage {at} {size}" for at, size in places]


draw = random.Random(1)
compared = different = chunks_read = damages = whole = 0
while compared < COUNT:
    with Scratch() as scratch:
        batch = {number: damage(draw, undamaged(draw)) for number in range(1, BATCH + 1)}
        for number, data in batch.items():
            (scratch / f"{number:08d}_20260301T130000Z.a351j").write_bytes(data)
        found = printed(run(TOOLS / "journal-chunks", scratch).stdout)
        for number, data in batch.items():
            wanted = expected(data)
            chunks_read += sum(line.startswith("chunk") for line in wanted)
            damages += sum(line.startswith("damage") for line in wanted)
            whole += not any(line.startswith("damage") for line in wanted)
            if found[number] != wanted:
                different += 1
                if different <= 3:
                    print(data.hex(), "read:", *found[number], "expected:", *wanted, sep="\n")
        compared += BATCH
demand(f"{compared} segments, {whole} of them whole, with {chunks_read} good chunks and {damages} damages: {different} are read differently",
       different == 0)
