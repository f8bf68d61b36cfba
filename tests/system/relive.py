"""Relives a simulated day whose log has every kind of change: the new root has the same bytes and the same stays."""

import json
import re
import sys

from programs import BIN, TOP, Scratch, demand, events_of, one_site, run
from stranger_journal import RX, journal, received

SPEED = 500
# Three stays of the day; the emulator's own schedule of set-ups does not matter.
SCENARIO = one_site("ideal", "2017-07-15T23:40:00Z", 1).replace('"here"', '"No.0"')


def at(minute, second=0):
    hour = 23 if minute < 60 else 0
    return f"2017-07-{15 if minute < 60 else 16}T{hour:02}:{minute % 60:02}:{second:02}.500000000Z"


FIRST, SECOND, THIRD = "20170715T234200Z", "20170715T235100Z", "20170716T000500Z"
LOG = [
    {"type": "start", "utc": at(42), "key": FIRST, "site": "No.0", "operator": "T. Sato", "note": "calm"},
    {"type": "setup", "utc": at(46), "site": "No.0"},
    {"type": "stop", "utc": at(50), "site": "No.0"},
    {"type": "start", "utc": at(51), "key": SECOND, "site": "No.3"},
    {"type": "note", "utc": at(53), "key": SECOND, "note": "a lorry, <b>parked</b>"},
    {"type": "stop", "utc": at(58), "site": "No.3"},
    {"type": "resume", "utc": at(59), "key": SECOND, "site": "No.3"},
    {"type": "not_moved", "utc": at(59, 30), "key": SECOND, "site": "No.3"},
    {"type": "stop", "utc": at(61), "site": "No.3"},
    {"type": "rename", "utc": at(62), "key": SECOND, "site": "No.2", "reason": "wrong line"},
    {"type": "retime", "utc": at(63), "key": FIRST, "site": "No.0", "from": at(41), "reason": "late"},
    {"type": "discard", "utc": at(64), "key": FIRST, "site": "No.0", "reason": "wind"},
    {"type": "start", "utc": at(65), "key": THIRD, "site": "No.0"},
    {"type": "restore", "utc": at(66), "key": FIRST, "site": "No.0"},
    {"type": "stop", "utc": at(70), "site": "No.0"},
    # Entered late, for an earlier time.
    {"type": "start", "utc": at(62, 10), "key": "20170716T000210Z", "site": "No.4"},
    {"type": "stop", "utc": at(63, 40), "site": "No.4"},
]
PLACED = ("start", "stop", "setup")  # Changes that keep their instant; the others have that of their entry.


def bytes_of(root):
    return b"".join(data for file in sorted((root / "journal").glob("*.a351j")) for kind, payload in journal(file)
                    if kind == RX for _, data in received(payload))


def seconds(rfc3339):
    hour, minute, second = rfc3339[11:-1].split(":")
    return (float(hour) * 60 + float(minute)) * 60 + float(second) + 86400 * int(rfc3339[8:10])


def stays_of(root):
    lines = run(BIN / "a351-sim", "replay", "--show", root).stdout.splitlines()
    return lines[0], [line.split(",") for line in lines[2:]]


with Scratch() as scratch:
    (scratch / "short.toml").write_text(SCENARIO)
    run(BIN / "a351-sim", "survey", "--scenario", scratch / "short.toml", "--out", scratch / "old")
    (scratch / "old" / "events").mkdir(exist_ok=True)
    log = scratch / "old" / "events" / "2017-07.jsonl"
    log.write_text("".join(json.dumps(event) + "\n" for event in LOG))
    facts, old_stays = stays_of(scratch / "old")
    print(facts)
    demand("--show prints the first instant of the data", facts.startswith("start_utc=2017-07-15T23:40:0"))
    demand("--show prints every set-up of the stays", len(old_stays) == 5)

    result = run(TOP / "sim" / "relive", scratch / "old", "--speed", SPEED, "--out", scratch / "new", env={"A351_BIN": str(BIN)})
    print(result.stdout, result.stderr, sep="")
    demand("sim/relive prints the first instant", re.search(r"^first instant: 2017-07-15T23:40:0", result.stdout, re.M) is not None)
    demand(f"all {len(LOG)} changes are repeated", f"{len(LOG)} of {len(LOG)} changes repeated" in result.stdout)

    counted = int(re.search(r"(\d+) bytes of the sensor", result.stdout)[1])
    old, new = bytes_of(scratch / "old"), bytes_of(scratch / "new" / "data")
    demand(f"the new journal has the same {len(old)} bytes of the sensor", old == new != b"")
    demand(f"sim/relive reports {counted} bytes", counted == len(old))
    again = [event for event in events_of(scratch / "new" / "data") if event["type"] != "signal"]
    strip = lambda event: {key: value for key, value in event.items() if key not in ("utc", "session", "index", "key")}  # noqa: E731
    demand("the new log has the same changes in the same order, with the same texts", [strip(e) for e in again] == [strip(e) for e in LOG])
    off = [abs(seconds(one["utc"]) - seconds(other["utc"])) for one, other in zip(LOG, again) if one["type"] in PLACED]
    demand(f"starts, stops and set-ups are at most {max(off):.3f} s from their instants, limit 0.05", max(off) <= 0.05)
    late = [seconds(other["utc"]) - seconds(one["utc"]) for one, other in zip(LOG, again) if one["type"] not in PLACED]
    print(f"the other changes were made up to {max(late):.0f} s of recorded time later")
    _, new_stays = stays_of(scratch / "new" / "data")
    demand("the new stays have the same sites, numbers and times within 0.05 s",
           [stay[:2] for stay in new_stays] == [stay[:2] for stay in old_stays]
           and all(abs(seconds(one[k]) - seconds(other[k])) <= 0.05 for one, other in zip(old_stays, new_stays) for k in (2, 3)))

    relive = [sys.executable, TOP / "sim" / "relive"]
    for title, arguments, status, part in (
            ("a directory that is not empty", [scratch / "old", "--out", scratch / "new"], 2, "not empty"),
            ("a root that is not there", [scratch / "absent", "--out", scratch / "x"], 2, "absent"),
            ("a wrong speed", [scratch / "old", "--speed", "0", "--out", scratch / "x"], 2, "allowed: 0.1 to 5000")):
        refused = run(*relive, *arguments, check=False, env={"A351_BIN": str(BIN)})
        print(f"{title}: {refused.stderr.strip()}")
        demand(f"{title}: status {status} and one line", refused.returncode == status and part in refused.stderr
               and refused.stderr.strip().count("\n") == 0)
    demand("nothing was written", not (scratch / "x").exists())
