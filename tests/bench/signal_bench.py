"""Measures what the signal's LOOK finds at the benchmark, and how good the gravity beside it is.

The log of a day is cut after each stop, as the recorder has it then.  Without a mistake:
- clean: DAYS of tsukuba and of hot-afternoon, one set-up of 12 min in each stay, all benchmarks known;
- clean_two: the same with two set-ups of 6 min;
- assumed, assumed_two: the same, with units and noise that together are the priors of the corrector;
- one_known: DAYS of quadratic and of three-links, one set-up of 12 min, the base alone known; and the same with stays of 17 min.
With one mistake in a day with two set-ups, drawn, DAYS of both scenarios in turn:
- set_up: the second set-up of a stay is 12 mGal higher;
- names: the first two stays are under each other's names, whose references differ by more than 10 mGal;
- reference: the reference of one stay is 20 mGal too high;
- moved: the box was lifted and set down without *Next set-up*; its LOOK comes from the motion (signal_words_bench).
The mistake is found if its stay, or a later one up to the next benchmark, has a contradiction.
Error over u is that of the value which does not use the station's own reference: at the stop, with what the recorder knows then; and of
all stays after the last stop, as in the evening.

Promised: LOOK at no more than 3 % of the stays without a mistake; error over u in the evening 0.9 to 1.1, 0.8 to 1.2 with one known;
mistakes found on 95 % of the days, error over u then at most 2.  On few days error over u can be outside by chance.
"""

import concurrent.futures
import json
import os
import random
import shutil
import statistics
import subprocess

from command_line import at_least, command_line, end_with
from simulated_units import assumed, rms, simulate, simulate_unit, unit_of
from mseed_records import begin_of, records
from programs import BIN, Scratch, events_of, instant, rows, write_events, write_sites

SCENARIOS = ("tsukuba", "hot-afternoon")
CURVED = ("quadratic", "three-links")
TWO_SET_UPS = "[schedule]\nsetups = 2\n"
UNIT_SCATTER = 0.25  # The thermal parameters of a unit are within this share of their usual values, as in the other benches.
STAYS_s = (720, 1020)  # As they are, and 5 min longer.
DISPLACED_mgal, WRONG_mgal, LEAST_APART_mgal = 12.0, 20.0, 10.0


def so_far(day, events):
    """Returns the gravity so far with these events and the sites of now.csv."""
    write_events(day, events)
    answer = subprocess.run([BIN / "a351-correct", "survey", day, "--sites", day / "now.csv", "--json"], capture_output=True, text=True,
                            check=True)
    return json.loads(answer.stdout)


def displace(day, higher, start, end):
    """Takes the records of the vertical axis in [start, end) from the same day with a higher gravity."""
    for file in sorted((day / "archive").rglob("*.BNZ.D.*")):
        other = higher / file.relative_to(day)
        kept = [record for source in (file, other) for record, begin, _ in records(source.read_bytes())
                if (start <= begin < end) == (source == other)]
        file.write_bytes(b"".join(sorted(kept, key=begin_of)))


def stays_of(events):
    """Returns for each stay the places of its first and last event."""
    starts = [i for i, event in enumerate(events) if event["type"] == "start"]
    return [(i, next(k for k in range(i, len(events)) if events[k]["type"] == "stop")) for i in starts]


class Day:
    """A simulated survey day, its events and its benchmarks."""

    def __init__(self, folder, scenario, seed, more, unit=None):
        folder.mkdir()
        self.folder, self.path = folder, simulate_unit(folder, "day", scenario, seed, unit or unit_of(seed, UNIT_SCATTER), more)
        self.events = events_of(self.path)
        self.table = rows(self.path / "sites.csv")
        self.true = {row["site"]: float(row["gravity_mgal"]) for row in self.table}
        self.listed = dict(self.true)
        self.stays = stays_of(self.events)

    def site(self, k):
        return self.events[self.stays[k][0]]["site"]

    def after_stop(self, k):
        """Returns the texts of the contradictions and the stays, as after the stop of stay k."""
        write_sites(self.path / "now.csv", self.table, self.listed)
        answer = so_far(self.path, self.events[:self.stays[k][1] + 1])
        return [one["text"] for one in answer["contradictions"]], answer["stays"]

    def spread(self, stays):
        """Returns error and u of those that have a gravity and are not the only known ones."""
        return [(stay["gravity_mgal"] - self.true[stay["site"]], stay["u_mgal"]) for stay in stays
                if stay["gravity_mgal"] is not None and not (len(self.listed) == 1 and stay["site"] in self.listed)]


def without_mistake(scratch, scenario, seed, more, is_base_alone, is_assumed):
    """Returns the contradictions after each stop of a day, error and u of the stay that was stopped, and those of all in the evening."""
    unit, drawn = assumed(seeds.index(seed), len(seeds)) if is_assumed else (None, "")
    day = Day(scratch, scenario, seed, drawn + more, unit)
    if is_base_alone:
        day.listed = {day.site(0): day.true[day.site(0)]}
    answers = [day.after_stop(k) for k in range(len(day.stays))]
    shutil.rmtree(day.folder)
    return [found for found, _ in answers], [one for _, stays in answers for one in day.spread(stays[-1:])], day.spread(answers[-1][1])


def raise_second_set_up(day, scenario, seed, k):
    raised = {name: gravity + DISPLACED_mgal for name, gravity in day.true.items()}
    text = "".join(f"[[site]]\nname = \"{row['site']}\"\n" + "".join(
        f"{key} = {raised[row['site']] if key == 'gravity_mgal' else row[key]}\n"
        for key in ("longitude_deg", "latitude_deg", "altitude_m", "gravity_mgal")) for row in day.table)
    higher = simulate(day.folder, "higher", scenario, seed, UNIT_SCATTER, TWO_SET_UPS + text)
    start, stop = day.stays[k]
    second = next(i for i in range(start, stop) if day.events[i]["type"] == "setup")
    displace(day.path, higher, instant(day.events[second]["utc"]), instant(day.events[stop]["utc"]))


def with_mistake(scratch, kind, seed):
    """Returns the contradictions after the stop of the stay with the mistake and of the next one, and error and u of all stays
    then; None if this day has no place for it."""
    scenario = SCENARIOS[seed % len(SCENARIOS)]
    day = Day(scratch, scenario, seed, TWO_SET_UPS)
    draw = random.Random(seed)
    place = draw.randrange(1, len(day.stays) - 1)
    if kind == "names":
        place, first, second = 1, day.site(0), day.site(1)
        if abs(day.true[first] - day.true[second]) <= LEAST_APART_mgal:
            return None
        for k, name in ((0, second), (1, first)):
            for event in day.events[day.stays[k][0]:day.stays[k][1] + 1]:
                event["site"] = name
    elif kind == "reference":
        site = day.site(place)
        day.listed[site] += WRONG_mgal
        place = next(k for k in range(len(day.stays)) if day.site(k) == site)
    elif kind == "set_up":
        raise_second_set_up(day, scenario, seed, place)
    else:
        start, stop = day.stays[place]
        day.events = [event for i, event in enumerate(day.events) if not (start < i < stop and event["type"] == "setup")]
        day.stays = stays_of(day.events)
    answers = [day.after_stop(k) for k in range(place, place + 2)]
    shutil.rmtree(day.folder)
    return [found for found, _ in answers], [one for _, stays in answers for one in day.spread(stays)]


def show(days):
    if os.environ.get("A351_SHOW"):
        for found, *_ in days:
            print("   ", found)


def ratio_of(days):
    """Returns the rms of error over u, and the same in words with its standard error from the scatter of the days.

    @param days  error and u of the values of each day
    """
    squares = [statistics.fmean((error / u) ** 2 for error, u in day) for day in days if day]
    if not squares:
        return float("nan"), "not known"
    ratio = statistics.fmean(squares) ** 0.5
    scatter = statistics.stdev(squares) / len(squares) ** 0.5 / (2.0 * ratio) if len(squares) > 1 else float("nan")
    return ratio, f"{ratio:.2f} +- {scatter:.2f} of {sum(map(len, days))} values"


def rms_of(days):
    return rms(error for day in days for error, _ in day)


WITHOUT = {"clean": (SCENARIOS, [""], False, False), "clean_two": (SCENARIOS, [TWO_SET_UPS], False, False),
           "assumed": (SCENARIOS, [""], False, True), "assumed_two": (SCENARIOS, [TWO_SET_UPS], False, True),
           "one_known": (CURVED, [f"[schedule]\nlength_s = {length:.1f}\n" for length in STAYS_s], True, False)}
MISTAKES = ("set_up", "names", "reference", "moved")
LEAST_FOUND, MOST_LOOKS, MOST_RATIO = 0.95, 0.03, 2.0
EVENING = {True: (0.8, 1.2), False: (0.9, 1.1)}  # Error over u, with the base alone known or not.
line = command_line(__doc__, "signal_bench.py 92001 2 clean names")
line.add_argument("first", metavar="FIRST_SEED", type=at_least(0), help="seed of the first day")
line.add_argument("days", metavar="DAYS", type=at_least(1), help="number of days, one seed each")
line.add_argument("kinds", metavar="KIND", nargs="*", default=[*WITHOUT, *MISTAKES], help="kinds of days")
options = line.parse_args()
if unknown := [kind for kind in options.kinds if kind not in WITHOUT and kind not in MISTAKES]:
    line.error(f"KIND = {unknown[0]}: allowed: {', '.join([*WITHOUT, *MISTAKES])}")
seeds = range(options.first, options.first + options.days)
failures = []
with Scratch() as scratch, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    for kind in options.kinds:
        if kind in MISTAKES:
            days = [one for one in pool.map(lambda seed: with_mistake(scratch / f"{kind}-{seed}", kind, seed), seeds) if one]
            show(days)
            count = sum(any(found) for found, _ in days)
            ratio, words = ratio_of([spread for _, spread in days])
            print(f"{kind}: LOOK at the benchmark on {sum(bool(found[0]) for found, _ in days)}, there or at the next one on {count} of "
                  f"{len(days)} days; error over u then {words}", flush=True)
            if not days:
                failures.append(f"{kind}: no day has a place for it")
            if kind != "moved" and count < LEAST_FOUND * len(days):
                failures.append(f"{kind}: found on {count} of {len(days)} days, promised {100 * LEAST_FOUND:.0f} %")
            if ratio > MOST_RATIO:
                failures.append(f"{kind}: error over u {ratio:.2f}, promised {MOST_RATIO}")
            continue
        scenarios, plans, is_base_alone, is_assumed = WITHOUT[kind]
        for scenario, more in ((scenario, more) for scenario in scenarios for more in plans):
            days = list(pool.map(lambda seed: without_mistake(scratch / f"{kind}-{seed}", scenario, seed, more, is_base_alone, is_assumed), seeds))
            show(days)
            looks = [bool(stay) for found, *_ in days for stay in found]
            at_stop, evening = [[day[k] for day in days] for k in (1, 2)]
            name = f"{kind}, {scenario}{', ' + more.split()[-1] + ' s' if is_base_alone else ''}"
            ratio, words = ratio_of(evening)
            print(f"{name}: LOOK at {sum(looks)} of {len(looks)} stays ({100 * sum(looks) / len(looks):.1f} %); at the end of the stay error rms "
                  f"{rms_of(at_stop):.2f} mGal, over u {ratio_of(at_stop)[1]}; in the evening {rms_of(evening):.2f} mGal, over u {words}", flush=True)
            if sum(looks) > MOST_LOOKS * len(looks):
                failures.append(f"{name}: LOOK at {sum(looks)} of {len(looks)} stays, promised {100 * MOST_LOOKS:.0f} %")
            least, most = EVENING[is_base_alone]
            if not least <= ratio <= most:
                failures.append(f"{name}: error over u in the evening {ratio:.2f}, promised {least} to {most}")
end_with(failures)
