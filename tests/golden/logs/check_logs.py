"""Reads the golden logs by the format pages alone and compares with the expected files beside them.

    check_logs.py DIRECTORY          every log in it
    check_logs.py --write LOG.a351j  writes the expected files of a new log

Rules of decoding: protocol/wire/burst_decoder.hpp; of indices: protocol/timing/sample_index.hpp.
"""

import json
import pathlib
import struct
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "system"))
from stranger_journal import HEAD, RX, journal, received  # noqa: E402

SIZE, RATE_HZ, STEP, WRAP, PERIOD = 24, 50, 80, 65536, 4096


def fault(frame):
    if frame[0] != 0x80:
        return "framing"
    if frame[23] != 0x0D:
        return "framing"
    return None if sum(struct.unpack(">10H", frame[1:21])) % WRAP == struct.unpack(">H", frame[21:23])[0] \
        else "checksum"


def count_of(frame):
    return struct.unpack(">H", frame[19:21])[0]


def is_ahead(count, before):
    ahead = (count - before) % WRAP
    return ahead % STEP == 0 and 0 < ahead <= WRAP // 2


def decode(stream):
    """Events (end offset, frame or reason of a run); the rest is pending."""
    at, is_behind, last, run = 0, False, None, None
    while at < len(stream):
        frame, reason = stream[at:at + SIZE], None
        if frame[0] != 0x80:
            reason = "framing"
        elif len(frame) < SIZE:
            break
        else:
            reason = fault(frame)
        if not reason and not is_behind and not (last is not None and is_ahead(count_of(frame), last)):
            seconds = range(at + SIZE, at + 4 * SIZE - SIZE + 1)
            seen = [s for s in seconds if s + SIZE <= len(stream)]
            if not any(not fault(stream[s:s + SIZE]) and is_ahead(count_of(stream[s:s + SIZE]), count_of(frame))
                       for s in seen):
                if len(seen) < len(seconds):
                    break
                reason = "framing"
        if reason:
            run = run or [reason, 0]
            run[1] += 1
            at, is_behind = at + 1, False
            if run[1] == SIZE:
                yield at, run[0], run[1]
                run = None
            continue
        if run:
            yield at, run[0], run[1]
            run = None
        at, is_behind, last = at + SIZE, True, count_of(frame)
        yield at, frame, SIZE


def read_log(file):
    """Samples and counters of a log of one session."""
    stream, ends = b"", []
    for kind, payload in journal(file):
        if kind == HEAD:
            header = json.loads(payload)
            assert header["burst_ctrl"] == 0xC703 and header["output_rate_hz"] == RATE_HZ
        elif kind == RX:
            for time, data in received(payload):
                stream += data
                ends.append((len(stream), time))
    counters = dict(bytes=len(stream), frames=0, bytes_skipped=0, checksum_errors=0, framing_errors=0, gaps=0,
                    samples_missing=0, duplicates=0, anomalies=0, sessions=1)
    samples, skipped, index, at_read, start = [], 0, None, 0, None
    for end, event, size in decode(stream):
        if isinstance(event, str):
            counters["bytes_skipped"] += size
            counters[event + "_errors"] += 1
            skipped += size
            continue
        counters["frames"] += 1
        while ends[at_read][0] < end:
            at_read += 1
        arrival = ends[at_read][1] / 1e9
        _, temp, x, y, z, count = struct.unpack(">HiiiiH", event[1:21])
        if index is None:
            ahead, index, start = 1, -1, arrival
        else:
            ticks = (count - last_count) % WRAP
            if skipped > 400 * SIZE or arrival - last_arrival >= 10.0:
                predicted = (arrival - start) * RATE_HZ - index
                ahead = min((n for n in range(1, int(predicted) + 2 * PERIOD) if n * STEP % WRAP == ticks),
                            key=lambda n: abs(n - predicted))
            else:
                assert ticks % STEP == 0
                ahead = ticks // STEP
        skipped = 0
        if ahead == 0:
            counters["duplicates"] += 1
            continue
        if samples and ahead > 1:
            counters["gaps"] += 1
            counters["samples_missing"] += ahead - 1
        index, last_count, last_arrival = index + ahead, count, arrival
        start = min(start, arrival - index / RATE_HZ)
        samples.append([index, count, x, y, z, temp])
    return samples, counters


def texts(log):
    samples, counters = read_log(log)
    rows = [["index", "count", "x", "y", "z", "temp"]] + samples
    return {".csv": "".join(",".join(map(str, row)) + "\n" for row in rows),
            ".counters": "".join(f"{key} {value}\n" for key, value in counters.items())}


if __name__ == "__main__":
    if sys.argv[1] == "--write":
        log = pathlib.Path(sys.argv[2])
        for suffix, text in texts(log).items():
            log.with_suffix(suffix).write_text(text)
    else:
        logs = sorted(pathlib.Path(sys.argv[1]).glob("*.a351j"))
        for log in logs:
            for suffix, text in texts(log).items():
                if log.with_suffix(suffix).read_text() != text:
                    sys.exit(f"{log.with_suffix(suffix)} differs from what a second reader finds:\n{text[:2000]}")
            print(f"{log.name}: as expected")
        sys.exit(not logs)
