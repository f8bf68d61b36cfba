"""How far the files of two runs differ: not at all, or in numbers, by so many units in the last place."""

import math
import pathlib
import re
import struct

# A number by itself: not the digits of a name, of a date or of a checksum.
NUMBER = re.compile(rb"(?<![\w.:+-])[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?(?![\w.:])")


def ordered(value):
    """A double as an integer that counts the doubles from zero to it."""
    bits, = struct.unpack("<q", struct.pack("<d", value))
    return bits if bits >= 0 else -(bits & 0x7FFF_FFFF_FFFF_FFFF)


def ulps(first, second):
    """Doubles from one to the other; of a difference from zero they are many."""
    return abs(ordered(first) - ordered(second))


def files_of(folder):
    return {path.relative_to(folder).as_posix(): path for path in pathlib.Path(folder).rglob("*") if path.is_file()}


def difference(first, second):
    """Returns 0 for equal files, else the largest ulps() of their numbers, or infinity if anything else differs."""
    one, other = first.read_bytes(), second.read_bytes()
    if one == other:
        return 0
    if NUMBER.sub(b"#", one) != NUMBER.sub(b"#", other):
        return math.inf
    return max(ulps(float(a), float(b)) for a, b in zip(NUMBER.findall(one), NUMBER.findall(other)))


def differences(first, second):
    """Returns the files that differ, each with its difference(), and the number of all files."""
    one, other = files_of(first), files_of(second)
    found = {name: math.inf for name in one.keys() ^ other.keys()}
    for name in one.keys() & other.keys():
        if (apart := difference(one[name], other[name])) > 0:
            found[name] = apart
    return dict(sorted(found.items())), len(one.keys() | other.keys())
