"""Compares the files of two runs and lists the columns and keys that differ, with their differences."""

import csv
import io
import json
import math
import pathlib


def relative(first, second):
    """Returns |a - b| / max(|a|, |b|), or infinity if one of both is no number."""
    try:
        a, b = float(first), float(second)
    except (TypeError, ValueError):
        return math.inf
    return abs(a - b) / max(abs(a), abs(b)) if a != b else 0.0


def leaves(value, key=""):
    """Yields every value of a JSON document with the innermost key above it."""
    if isinstance(value, dict):
        for name, inner in value.items():
            yield "key", name
            yield from leaves(inner, name)
    elif isinstance(value, list):
        yield "length", len(value)
        for inner in value:
            yield from leaves(inner, key)
    else:
        yield key, value


def cells(text):
    """Yields every cell of a CSV table with its column."""
    header, *rows = csv.reader(io.StringIO(text, newline=""))
    yield "header", ",".join(header)
    for row in rows:
        yield "length", len(row)
        yield from zip(header, row)


READERS = {".json": lambda text: leaves(json.loads(text)), ".csv": cells}


def difference(first, second):
    """Returns the relative() difference of each column or key that differs; "" is any other difference of the files."""
    one, other = first.read_bytes(), second.read_bytes()
    if one == other:
        return {}
    if first.suffix not in READERS:
        return {"": math.inf}
    one, other = (list(READERS[first.suffix](content.decode())) for content in (one, other))
    if [key for key, _ in one] != [key for key, _ in other]:
        return {"": math.inf}
    found = {}
    for (key, a), (_, b) in zip(one, other):
        if a != b:
            found[key] = max(found.get(key, 0.0), relative(a, b))
    return found or {"": math.inf}


def files_of(folder):
    return {path.relative_to(folder).as_posix(): path for path in pathlib.Path(folder).rglob("*") if path.is_file()}


def differences(first, second):
    """Returns the difference() of each file that differs, and the number of all files."""
    one, other = files_of(first), files_of(second)
    found = {name: {"": math.inf} for name in one.keys() ^ other.keys()}
    for name in one.keys() & other.keys():
        if apart := difference(one[name], other[name]):
            found[name] = apart
    return dict(sorted(found.items())), len(one.keys() | other.keys())
