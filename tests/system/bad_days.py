"""Survey days with missing or wrong input, corrected by the whole-day model.

The table and the report must name each fault, and all other readings must be computed.
"""

import json
import struct

from programs import BIN, Scratch, demand, read_json, rows, run

READINGS = 19
RECORD_BYTES = 512
# Largest change of a reading, in mGal.  Other occupations do not affect a reading, but the whole-day model cuts the ends of
# the day's temperature at other places.
LARGEST_SHIFT_MGAL = 0.01
LARGEST_ERROR_IN_U = 3.0


def hour_of(record):
    """Returns the hour of the day at which a miniSEED record starts (field 8 of its header)."""
    hour, minute, second = struct.unpack(">BBB", record[24:27])
    return hour + minute / 60 + second / 3600


def cut(root, channels, from_hour, to_hour):
    """Removes the records that start within these hours of the second day from the archive."""
    for channel in channels:
        file, = root.glob(f"archive/2017/XX/A351/{channel}.D/*.2017.197")
        data = file.read_bytes()
        records = [data[at:at + RECORD_BYTES] for at in range(0, len(data), RECORD_BYTES)]
        kept = [record for record in records if not from_hour <= hour_of(record) < to_hour]
        demand(f"{channel}: {len(records) - len(kept)} of {len(records)} records are removed", 0 < len(kept) < len(records))
        file.write_bytes(b"".join(kept))


def key(row):
    return row["site"], row["occupation"]


class Day:
    """A simulated day, corrected without and with faults in its input."""

    def __init__(self, scratch):
        self.scratch = scratch
        self.root = scratch / "day"
        run(BIN / "a351-sim", "survey", "--scenario", "tsukuba", "--seed", 3, "--out", self.root)
        self.schedule = (self.root / "schedule.csv").read_text().splitlines()
        self.gravity = {key(row): float(row["gravity_mgal"]) for row in rows(self.root / "truth.csv")}
        self.whole = {}
        self.correct("the day as it is")
        self.whole = {key(row): row for row in self.table}
        demand(f"{len(self.whole)} readings", len(self.whole) == READINGS)

    def correct(self, title, stays=None, lost=(), model="day", **keys):
        """Corrects the day.  Demands that exactly the readings `lost` have no value and all others are near the truth."""
        name = title.replace(" ", "-")
        (self.scratch / "occupations.csv").write_text("\n".join(stays or self.schedule) + "\n")
        settings = {"name": name, "root": "day", "sites": "day/sites.csv", "occupations": "occupations.csv",
                    "base": "No.0", "flags": "ignore"} | keys
        file = self.scratch / f"{name}.toml"
        file.write_text("[survey]\n" + "".join(f"{entry} = {json.dumps(value)}\n" for entry, value in settings.items()))
        self.said = run(BIN / "a351-correct", "survey", file, "--out", self.scratch / name).stderr
        self.report = (self.scratch / name / "report.html").read_text()
        self.table = rows(self.scratch / name / "occupations.csv")
        result = read_json(self.scratch / name / "result.json")
        print(f"{title}: {self.said.strip() or 'no message'}")
        demand(f"{title}: corrected by the model {result['model']}, expected {model}", result["model"] == model)
        empty = {key(row) for row in self.table if not row["corrected_mgal"]}
        demand(f"{title}: {len(empty)} of {len(self.table)} rows have no value, expected {len(set(lost))}", empty == set(lost))
        starts = [row["start_utc"] for row in self.table]
        demand(f"{title}: the rows are in order of time", starts == sorted(starts))
        good = [row for row in self.table if row["corrected_mgal"]]
        errors = [(float(row["corrected_mgal"]) - self.gravity[key(row)]) / float(row["u_corrected_mgal"]) for row in good]
        demand(f"{title}: {len(good)} values within {max(map(abs, errors)):.2f} u of the truth, limit {LARGEST_ERROR_IN_U:g}",
               max(map(abs, errors)) < LARGEST_ERROR_IN_U)
        if self.whole and model == "day":
            shifts = [abs(float(row["acceleration_mgal"]) - float(self.whole[key(row)]["acceleration_mgal"])) for row in good]
            demand(f"{title}: readings change by {max(shifts):.4f} mGal against the complete day, limit {LARGEST_SHIFT_MGAL}",
                   max(shifts) < LARGEST_SHIFT_MGAL)
        for row in self.table:
            if key(row) in empty:
                self.demand_said(title, f"{row['site']} ({row['occupation']}) at ")
                demand(f"{title}: its flag is {row['flags']}", row["flags"] != "" and row["used"] == "0")

    def demand_said(self, title, words):
        demand(f"{title}: stderr and report contain {words!r}", words in self.said and words in self.report)


with Scratch() as scratch:
    day = Day(scratch)
    head, *stays = day.schedule

    title = "an occupation without data"
    day.correct(title, [*day.schedule, "No.5,7,2017-07-16T18:00:00Z,2017-07-16T18:12:00Z,1,"], {("No.5", "7")})
    day.demand_said(title, "No.5 (7) at 2017-07-16T18:00:00Z is left out: no samples")

    title = "start and end swapped, rows out of order"
    site, number, start, end, used, note = stays[5].split(",")
    day.correct(title, [head, ",".join([site, number, end, start, used, note]), *reversed(stays[6:]), *stays[:5]],
                {(site, number)})
    day.demand_said(title, "is left out: ends before it starts")

    title = "a site without coordinates"
    sites = [line.split(",") for line in (day.root / "sites.csv").read_text().splitlines()]
    sites = [[name, "", "", "", gravity] if name == "No.1" else [name, *place, gravity] for name, *place, gravity in sites]
    (scratch / "sites.csv").write_text("".join(",".join(site) + "\n" for site in sites))
    day.correct(title, sites="sites.csv")
    day.demand_said(title, "No.1: no position in the table of sites; the mean of the others is used")

    title = "a log in another order"
    log = day.root / "events" / "2017-07.jsonl"
    events = log.read_text().splitlines()
    log.write_text("\n".join(events[-6:] + events[8:-6] + ['{"type":"st'] + events[:8]) + "\n")
    day.correct(title, occupations="")
    day.demand_said(title, "2017-07.jsonl:31: not an event, skipped")

    # The following cases damage the archive; the damage adds up.
    title = "half a day missing"
    late = {key(row) for row in day.table if row["start_utc"] > "2017-07-16T05:00"}
    demand(f"{title}: {len(late)} readings affected", 5 < len(late) < READINGS - 5)
    cut(day.root, ["BNZ", "BN1", "BN2", "BK1"], 5, 24)
    day.correct(title, lost=late)

    title = "the temperature of 40 minutes missing on the way"
    cut(day.root, ["BK1"], 1.32, 2.08)
    day.correct(title, lost=late)
    demand(f"{title}: the report says how much", "min of the temperature are missing" in day.report)
