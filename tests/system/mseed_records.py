"""Records of miniSEED 2 as the archiver writes them (SEED manual 2.4, fixed section of the header and blockette 1001)."""

import datetime
import struct

BYTES = 512


def begin_of(record):
    """Returns the time of the first sample."""
    year, day, hour, minute, second, _, fraction = struct.unpack_from(">HHBBBBH", record, 20)
    return datetime.datetime(year, 1, 1, hour, minute, second, tzinfo=datetime.timezone.utc) + datetime.timedelta(
        days=day - 1, microseconds=100 * fraction + struct.unpack_from(">b", record, 61)[0])


def records(data):
    """Yields each record of a file with the times of its first sample and of the one that would follow its last."""
    for at in range(0, len(data), BYTES):
        record = data[at:at + BYTES]
        count, factor, multiplier = struct.unpack_from(">Hhh", record, 30)
        rate = (factor if factor > 0 else -1.0 / factor) * (multiplier if multiplier > 0 else -1.0 / multiplier)
        begin = begin_of(record)
        yield record, begin, begin + datetime.timedelta(seconds=count / rate)
