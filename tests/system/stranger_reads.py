"""Readers of journal, archive and event log, written from the format pages alone, with about 30 lines each.

check_logs.py beside the golden logs reads the frames in a journal.
"""

import csv
import datetime
import json
import struct

from programs import TOP, demand
from stranger_journal import journal, received

GOLDEN = TOP / "tests" / "golden"


def signed(word, shift, bits):
    value = word >> shift & (1 << bits) - 1
    return value - (1 << bits) if value >> bits - 1 else value


# Number and bits of the differences in a word, by its nibble and two upper bits: SEED manual 2.4, appendix B, Steim-2.
CUTS = {(1, None): (4, 8), (2, 1): (1, 30), (2, 2): (2, 15), (2, 3): (3, 10), (3, 0): (5, 6), (3, 1): (6, 5), (3, 2): (7, 4)}


def record(data):
    """Returns channel, start in ns, rate and samples of a record of 512 bytes: protocol/archive/archive-format.md."""
    year, day, hour, minute, second, ten_thousandths = struct.unpack_from(">HHBBBxH", data, 20)
    count, factor, multiplier = struct.unpack_from(">Hhh", data, 30)
    begin, = struct.unpack_from(">H", data, 44)
    coding, microseconds = data[52], struct.unpack_from(">b", data, 61)[0]
    rate = struct.unpack_from(">f", data, 68)[0] if data[39] == 3 else factor if factor > 0 else -1 / factor
    days = (datetime.date(year, 1, 1) - datetime.date(1970, 1, 1)).days + day - 1
    start = ((((days * 24 + hour) * 60 + minute) * 60 + second) * 10000 + ten_thousandths) * 100000 + microseconds * 1000
    code = ".".join(data[a:b].decode().strip() for a, b in ((18, 20), (8, 13), (13, 15), (15, 18)))
    if coding == 3:
        return code, start, rate, list(struct.unpack_from(f">{count}i", data, begin))
    differences, first, last = [], None, None
    for frame in range(begin, 512, 64):
        words = struct.unpack_from(">16I", data, frame)
        for i in range(1, 16):
            nibble = words[0] >> 30 - 2 * i & 3
            if frame == begin and i < 3:
                first, last = (signed(words[i], 0, 32), last) if i == 1 else (first, signed(words[i], 0, 32))
            elif nibble:
                number, bits = CUTS[nibble, None if nibble == 1 else words[i] >> 30]
                differences += [signed(words[i], bits * (number - 1 - k), bits) for k in range(number)]
    values = [first]
    for difference in differences[1:count]:
        values.append(values[-1] + difference)
    assert values[-1] == last
    return code, start, rate, values


def occupations(folder):
    """Returns [site, number, set-up, start, end, note] of each set-up in order of time: protocol/events/event-format.md."""
    finished, running = [], None

    def lay_down(utc):
        if utc != running["begin"]:
            running["setups"].append((running["begin"], utc))
        running["begin"] = utc

    for line in (line for file in sorted(folder.glob("*.jsonl")) for line in file.read_text().splitlines()):
        try:
            event = json.loads(line)
        except ValueError:
            continue
        kind, utc = event["type"], event["utc"]
        if kind in ("start", "stop") and running:
            if kind == "stop" and event.get("note"):
                running["notes"].append(event["note"])
            lay_down(utc)
            finished += [running] if running["setups"] else []
            running = None
        if kind == "start":
            running = {"site": event["site"], "setups": [], "begin": utc, "notes": [event["note"]] if event.get("note") else []}
        elif kind == "setup" and running:
            lay_down(utc)
        elif kind == "note" and running:
            running["notes"].append(event["note"])
        elif kind == "rename" and (running or finished):
            stay = running or finished[-1]
            stay["site"] = event["site"]
            stay["notes"] += [event["note"]] if event.get("note") else []
        elif kind == "discard":
            finished, running = (finished, None) if running else (finished[:-1], None)
    stays, table = {}, []
    for stay in sorted(finished, key=lambda stay: stay["setups"][0][0]):
        stays[stay["site"]] = stays.get(stay["site"], 0) + 1
        table += [[stay["site"], str(stays[stay["site"]]), str(i), begin, end, "; ".join(stay["notes"])]
                  for i, (begin, end) in enumerate(stay["setups"], 1)]
    return table


def rows(file):
    with open(file, newline="") as text:
        return list(csv.reader(text))[1:]


found = list(journal(GOLDEN / "journal" / "00000001_20260301T130000Z.a351j"))
demand(f"the worked example has chunks {[kind for kind, _ in found]}", [kind for kind, _ in found] == [1, 3, 4, 2, 5, 6, 7, 8])
demand("the header has the session", json.loads(found[0][1])["session"] == bytes(range(16)).hex())
demand("the example has two reads, 20 ms apart", received(found[3][1]) ==
       [(1000100000000, b"\x80ABC"), (1000120000000, b"DEF\r")])

damaged = bytearray((GOLDEN / "journal" / "00000001_20260301T130000Z.a351j").read_bytes())
damaged[0x282] ^= 4  # In the header of the RX chunk.
demand("behind a damaged chunk the next ones are found", [kind for kind, _ in journal(bytes(damaged))] == [1, 3, 4, 5, 6, 7, 8])

code, start, rate, values = record((GOLDEN / "miniseed" / "XX.A351.00.BNZ_steim2_blockette100.mseed").read_bytes())
instant = datetime.datetime.fromtimestamp(start // 10**9, datetime.timezone.utc).strftime("%FT%T") + f".{start % 10**9:09d}"
print(code, instant, rate, len(values))
demand("the miniSEED record has the expected channel, start and rate",
       (code, instant) == ("XX.A351.00.BNZ", "2026-03-01T12:00:00.123456000")
       and abs(rate - 50.0005) < 2e-6)
demand("its 112 samples are those of the formula",
       values == [16000000 + (5 * i * i if i % 2 == 0 else -3 * i * i) for i in range(112)])

demand("the occupations of the event log are those worked out by hand",
       occupations(GOLDEN / "events") == rows(GOLDEN / "events" / "occupations.csv"))
