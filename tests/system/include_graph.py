"""The rooms (source directories) must include each other as in rooms.md, and no room of a later row.  --write brings the page up to date.

Each room has a namespace of its own, so a name that is used elsewhere says where it comes from."""

import collections
import re
import sys

from programs import TOP, demand

COMPONENTS = ("protocol", "daemon", "sim", "corrector")
MOST_MODULES = 23  # Largest number of modules in a room; the largest room has as many today.
PAGE = TOP / "tests/system/rooms.md"
ROW = re.compile(r"^(\| `([a-z0-9_/]+)` \|[^|]*\|)([^|]*)\|$", re.MULTILINE)
NAMESPACE = re.compile(r"^namespace (a351[a-z0-9_:]*) \{$", re.MULTILINE)
INCLUDE = re.compile(r'^#include "([^"]+)/[^/"]+"', re.MULTILINE)


def rooms_of_page():
    """Returns the rooms in the order of the page, each with the rooms that it includes."""
    return {room: set(re.findall(r"`([a-z0-9_/]+)`", below)) for _, room, below in ROW.findall(PAGE.read_text())}


def write_page(included):
    """Writes what each room of the page includes, in the order of the rows."""
    order = list(rooms_of_page())
    names = {room: " ".join(f"`{below}`" for below in order if below in included[room]) for room in order}
    PAGE.write_text(ROW.sub(lambda row: f"{row[1]} {names[row[2]]} |", PAGE.read_text()))


def rooms_of_sources():
    """Returns the rooms with the rooms that their sources include, and with their modules."""
    below, modules = collections.defaultdict(set), collections.defaultdict(set)
    for component in COMPONENTS:
        for source in (TOP / component).rglob("*.[ch]pp"):
            room = source.parent.relative_to(TOP).as_posix()
            modules[room].add(source.stem)
            below[room] |= set(INCLUDE.findall(source.read_text())) - {room}
    return below, modules


def namespace_of(source):
    """Returns the namespace that a source must have: protocol's rooms are a351::ROOM, the others a351::COMPONENT::ROOM."""
    component, *room = source.parent.relative_to(TOP).parts
    if (component, *room) == ("protocol", "core"):
        return "a351"
    return "::".join(["a351", *([] if component == "protocol" else [component]), *room])


def other_namespaces():
    """Returns the sources that declare something of a351 outside the namespace of their room."""
    for component in COMPONENTS:
        for source in (TOP / component).rglob("*.[ch]pp"):
            declared = set(NAMESPACE.findall(source.read_text()))
            if declared - {namespace_of(source)} or not (declared or source.name == "main.cpp"):
                yield source.relative_to(TOP).as_posix()


included, modules = rooms_of_sources()
if sys.argv[1:] == ["--write"]:
    write_page(included)
allowed = rooms_of_page()
demand(f"the page lists the {len(modules)} rooms of the sources and no others", set(allowed) == set(modules))
above = set(allowed)
for room, below in allowed.items():
    above.discard(room)
    demand(f"{room} includes the rooms of its row: missing on the page {sorted(included[room] - below)}, "
           f"no longer included {sorted(below - included[room])}", included[room] == below)
    demand(f"{room} includes no room of a later row", not below & above and room not in below)
largest = max(modules, key=lambda room: len(modules[room]))
demand(f"the largest room is {largest} with {len(modules[largest])} modules, must be at most {MOST_MODULES}",
       len(modules[largest]) <= MOST_MODULES)
elsewhere = list(other_namespaces())
demand(f"every source is in the namespace of its room, but for {elsewhere}", not elsewhere)
arrows = sum(len(below) for below in included.values())
print(f"{len(modules)} rooms, {arrows} include relations, {sum(len(one) for one in modules.values())} modules")
