"""The journal as its format page describes it, for the golden logs: no code of the library is used."""

import json
import struct

LARGEST = 65536
HEAD, RX, TX, CLOCK = 1, 2, 3, 4

_TABLE = []
for _byte in range(256):
    for _ in range(8):
        _byte = _byte >> 1 ^ (0x82F63B78 if _byte & 1 else 0)
    _TABLE.append(_byte)


def crc32c(data):
    value = 0xFFFFFFFF
    for byte in data:
        value = value >> 8 ^ _TABLE[(value ^ byte) & 0xFF]
    return value ^ 0xFFFFFFFF


assert crc32c(b"123456789") == 0xE3069283


def segment(chunks):
    """The bytes of a segment from (type, payload) pairs."""
    out = b"A351JRNL" + struct.pack("<I", 1)
    for sequence, (kind, payload) in enumerate(chunks):
        front = struct.pack("<IBI", len(payload), kind, sequence)
        out += front + struct.pack("<I", crc32c(front + payload)) + payload
    return out


def head(**fields):
    return HEAD, json.dumps(fields, separators=(",", ":")).encode()


def rx(reads):
    """One chunk of (raw time in ns, bytes) pairs."""
    first, end, stamps, data = reads[0][0], 0, b"", b""
    for time, part in reads:
        end += len(part)
        stamps += struct.pack("<Iq", end, time - first)
        data += part
    return RX, struct.pack("<qI", first, len(reads)) + stamps + data


def clock(raw, realtime):
    return CLOCK, struct.pack("<qqqBqq", raw, raw, realtime, 1, 500, 100)


def chunks(file):
    """(type, payload) of every good chunk; stops where the page says a reader stops."""
    data = open(file, "rb").read()
    assert data[:12] == b"A351JRNL" + struct.pack("<I", 1)
    at, expected = 12, 0
    while at + 13 <= len(data):
        length, kind, sequence, crc = struct.unpack_from("<IBII", data, at)
        payload = data[at + 13:at + 13 + length]
        if length > LARGEST or len(payload) < length or sequence != expected:
            return
        if crc32c(data[at:at + 9] + payload) != crc:
            return
        yield kind, payload
        at, expected = at + 13 + length, expected + 1


def reads(payload):
    """(raw time in ns, bytes) of each read of an RX chunk."""
    first, count = struct.unpack_from("<qI", payload)
    data, begin = payload[12 + 12 * count:], 0
    for i in range(count):
        end, delta = struct.unpack_from("<Iq", payload, 12 + 12 * i)
        yield first + delta, data[begin:end]
        begin = end
