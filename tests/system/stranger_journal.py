"""A reader of journal segments, written from protocol/journal/journal-format.md alone."""

import json
import re
import struct

PREAMBLE = b"A351JRNL\1\0\0\0"
HEAD, RX, UNKNOWN = 1, 2, 10
STRINGS = {"session": "[0-9a-f]{32}", "network": "[A-Z0-9]{1,2}", "station": "[A-Z0-9]{1,5}", "location": "([A-Z0-9]{2})?",
           **dict.fromkeys(("boot_id", "program_version", "profile", "product_id", "serial_number", "filter"), "(?s).*")}
INTEGERS = "firmware", "output_rate_hz", "burst_ctrl", "baud"


def crc_table():
    table = list(range(256))
    for _ in range(8):
        table = [value >> 1 ^ 0x82F63B78 * (value & 1) for value in table]
    return table


TABLE = crc_table()


def crc(data):
    """Returns the CRC-32C."""
    value = 0xFFFFFFFF
    for byte in data:
        value = value >> 8 ^ TABLE[(value ^ byte) & 0xFF]
    return value ^ 0xFFFFFFFF


def is_instant(value):
    return -2**58 <= value <= 3_900_000_000_000_000_000


def is_head(payload):
    try:
        head = json.loads(payload.decode())
        return (all(re.fullmatch(form, head[key]) for key, form in STRINGS.items()) and all(isinstance(head[key], int) for key in INTEGERS)
                and len(head["axes"]) == 3 and all(re.fullmatch("[A-Z0-9]", axis) for axis in head["axes"])
                and all(1 <= head.get(key, 1) <= 3600 for key in ("oven_interval_s", "outer_oven_interval_s"))
                and 1 <= head.get("record_age_s", 60) <= 60
                and head["clock"].get("leap", 0) in (0, 1, 2)
                and isinstance(head["clock"]["synchronised"], bool)
                and all(is_instant(head["clock"][key]) for key in ("raw_ns", "boottime_ns", "realtime_ns"))
                and all(abs(head["clock"][key]) <= 2**47 for key in ("max_error_us", "estimated_error_us")))
    except (ValueError, KeyError, TypeError, AttributeError):
        return False


def is_mark(payload):
    at = 16
    while at < len(payload):
        end = at + 1 + payload[at] + 16
        if end > len(payload):
            return False
        index, utc = struct.unpack_from("<qq", payload, end - 16)
        if abs(index) > 2**53 or not is_instant(utc):
            return False
        at = end
    return at == len(payload)


def is_rx(payload):
    if len(payload) < 12:
        return False
    first, count = struct.unpack_from("<qI", payload)
    if not count or 12 + 12 * count > len(payload) or not is_instant(first):
        return False
    reads = list(struct.iter_unpack("<Iq", payload[12:12 + 12 * count]))
    ends = [0] + [end for end, _ in reads]
    return (all(a < b for a, b in zip(ends, ends[1:])) and ends[-1] == len(payload) - 12 - 12 * count
            and all(abs(delta) <= 2**58 for _, delta in reads))


def is_clock(payload):
    if len(payload) != 41:
        return False
    raw, boottime, realtime, state, most, estimated = struct.unpack("<qqqBqq", payload)
    return all(map(is_instant, (raw, boottime, realtime))) and state >> 1 <= 2 and abs(most) <= 2**47 and abs(estimated) <= 2**47


def is_model(payload):
    if len(payload) != 25:
        return False
    index, utc, uncertainty, state = struct.unpack("<qqqB", payload)
    return abs(index) <= 2**53 and is_instant(utc) and abs(uncertainty) <= 2**58 and state <= 3


def is_oven(payload):
    if len(payload) < 11:
        return False
    time, outcome, _, registers = struct.unpack_from("<qBBB", payload)
    return is_instant(time) and len(payload) == 11 + 2 * registers and outcome <= 6 and (registers > 0) == (outcome == 0)


VALID = {1: is_head, 2: is_rx, 3: lambda payload: len(payload) >= 8 and is_instant(*struct.unpack_from("<q", payload)), 4: is_clock,
         5: is_model, 6: lambda payload: True, 7: is_mark, 8: is_oven, 9: is_oven}


def chunk(data, at):
    """Returns type, sequence number and payload of the chunk at this place; None if it is damaged whatever its number."""
    if at + 13 > len(data):
        return None
    length, kind, number, check = struct.unpack_from("<IBII", data, at)
    payload = data[at + 13:at + 13 + length]
    if length > 65536 or len(payload) < length or (kind == HEAD) != (number == 0):
        return None
    if crc(data[at:at + 9] + payload) != check or not VALID.get(kind, lambda _: True)(payload):
        return None
    return kind, number, payload


def search(data, at, least):
    """Returns the place of the next good chunk with this sequence number or a larger one; None if there is none."""
    for place in range(at, len(data) - 12):
        length, kind, number = struct.unpack_from("<IBI", data, place)
        if kind and length <= len(data) - place - 13 and least <= number <= least + len(data) // 13 and chunk(data, place):
            return place
    return None


def segment(data):
    """Returns the good chunks of a segment, (type, sequence number, payload), and the damage, (offset, bytes)."""
    good = chunk(data, 12) if data[:12] == PREAMBLE else None
    if not good or good[1]:
        return [], [(0, len(data))]
    chunks, damage, at, due = [], [], 12, 0
    while at < len(data):
        good = chunk(data, at)
        if good and good[1] == due:
            chunks.append(good)
            at, due = at + 13 + len(good[2]), due + 1
            continue
        place = search(data, at, due)
        damage.append((at, (len(data) if place is None else place) - at))
        if place is None:
            break
        at, due = place, struct.unpack_from("<I", data, place + 5)[0]
    return [good for good in chunks if good[0] < UNKNOWN and good[0]], damage


def received(payload):
    """Returns (raw time in ns, bytes) of each read of an RX chunk."""
    first, count = struct.unpack_from("<qI", payload)
    reads = list(struct.iter_unpack("<Iq", payload[12:12 + 12 * count]))
    data = payload[12 + 12 * count:]
    return [(first + delta, data[begin:end]) for (begin, _), (end, delta) in zip([(0, 0)] + reads, reads)]


def journal(file):
    """Yields (type, payload) of each good chunk."""
    for kind, _, payload in segment(file if isinstance(file, bytes) else file.read_bytes())[0]:
        yield kind, payload
