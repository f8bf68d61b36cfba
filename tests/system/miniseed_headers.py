"""Reads headers of miniSEED 2 records, written from the SEED manual alone (chapter 8, blockettes 100 and 1001)."""

import calendar
import collections
import struct

RECORD = 512
Header = collections.namedtuple("Header", "file start_us samples rate_hz timing_quality is_time_questionable")


def headers(files):
    """Returns the headers of all records in these files of a channel, in the order in which they were written.

    After a leap second this is not the order of the day files.
    """
    found = []
    for file in files:
        data = file.read_bytes()
        found += [(data[at:at + 6], read(file, data[at:at + RECORD])) for at in range(0, len(data), RECORD)]
    return [header for _, header in sorted(found, key=lambda one: one[0])]


def read(file, record):
    year, day, hour, minute, second, fraction, samples, factor, multiplier = struct.unpack(">HHBBBxHHhh", record[20:36])
    quality_flags, blockette = record[38], struct.unpack(">H", record[46:48])[0]
    rate = (factor if factor > 0 else -1 / factor) * (multiplier if multiplier > 0 else -1 / multiplier)
    microseconds = timing_quality = 0
    while blockette:
        kind, following = struct.unpack(">HH", record[blockette:blockette + 4])
        if kind == 100:
            rate = struct.unpack(">f", record[blockette + 4:blockette + 8])[0]
        if kind == 1001:
            timing_quality, microseconds = struct.unpack(">Bb", record[blockette + 4:blockette + 6])
        blockette = following
    start_s = calendar.timegm((year, 1, 1, hour, minute, second)) + (day - 1) * 86400
    start_us = start_s * 1_000_000 + fraction * 100 + microseconds
    return Header(file, start_us, samples, rate, timing_quality, bool(quality_flags & 0x80))


def end_us(header):
    """Returns the time of the sample after the last one, in us since 1970."""
    return header.start_us + 1e6 * header.samples / header.rate_hz


def gaps_in_samples(records):
    """Returns the gaps between records that do not follow each other, in samples."""
    between = [round((after.start_us - end_us(before)) * after.rate_hz / 1e6)
               for before, after in zip(records, records[1:])]
    return [gap for gap in between if gap]
