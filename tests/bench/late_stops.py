"""Measures what a stop that is pressed at the next benchmark does to a day, and *Next set-up* before or after the lifting.

On each of DAYS days of three scenarios each stop is moved to 30 s before the next start, one at a time.  CLEAN further days of tsukuba
have no mistake.  CHANGED further days of tsukuba have two set-ups of 6 min in each stay, with *Next set-up* at the lifting, then 60 s
before to 120 s after it, and then without it in one stay.
"""

import concurrent.futures
import datetime
import os
import random
import statistics

from command_line import add_days, at_least, command_line, end_with
from simulated_units import correct, simulate
from programs import Scratch, events_of, instant, read_json, write_events

MOST_WORSE = 1.10
PRESSED_S = (-60.0, 120.0)  # after the lifting


def corrected(folder, day, name):
    """Returns the left-out error of a day in mGal, and kind and site of its findings."""
    result = read_json(correct(folder, day / "survey.toml", name, "--model", "day") / "result.json")
    return result["cross_validated"]["loso_mgal"], [(finding["kind"], finding["site"]) for finding in result["findings"]]


def logged_day(scratch, scenario, seed, more=""):
    """Simulates a day whose stays are those of its log; returns its folders and its events."""
    folder = scratch / f"{scenario}-{seed}"
    folder.mkdir()
    day = simulate(folder, "day", scenario, seed, 0.0, more)
    survey = day / "survey.toml"
    survey.write_text(survey.read_text().replace('occupations = "schedule.csv"', 'occupations = ""'))
    return folder, day, events_of(day)


def moved(event, to, by_s):
    """Returns an event at an instant plus this time."""
    return {**event, "utc": (to + datetime.timedelta(seconds=by_s)).strftime("%Y-%m-%dT%H:%M:%S.%fZ")}


def look_at(scratch, scenario, seed, is_clean):
    """Returns the findings without a mistake, and for each late stop its site, findings and ratio of the errors."""
    folder, day, events = logged_day(scratch, scenario, seed)
    clean_mgal, false = corrected(folder, day, "clean")
    late = []
    for i, stop in enumerate(events):
        after = [event for event in events[i:] if event["type"] == "start"]
        if is_clean or stop["type"] != "stop" or not after or after[0]["site"] == stop["site"]:
            continue
        late_stop = moved(stop, instant(after[0]["utc"]), -30.0)
        write_events(day, [late_stop if event is stop else event for event in events])
        late_mgal, found = corrected(folder, day, "late")
        late.append((stop["site"], found, late_mgal / clean_mgal))
    return false, late


def change(scratch, seed):
    """Returns the findings that only one of two days has, with *Next set-up* beside the lifting and at it; the difference of their left-out
    errors; findings and error of the latter; whether a forgotten one is found and nothing else is new."""
    folder, day, events = logged_day(scratch, "tsukuba", seed, "[schedule]\nsetups = 2\n")
    draw = random.Random(seed)
    exact_mgal, usual = corrected(folder, day, "exact")
    pressed = [moved(event, instant(event["utc"]), draw.uniform(*PRESSED_S)) if event["type"] == "setup" else event for event in events]
    write_events(day, pressed)
    pressed_mgal, findings = corrected(folder, day, "pressed")
    forgotten = draw.choice([i for i, event in enumerate(events) if event["type"] == "setup"])
    site = next(event["site"] for event in reversed(events[:forgotten]) if event["type"] == "start")
    write_events(day, pressed[:forgotten] + pressed[forgotten + 1:])
    _, found = corrected(folder, day, "forgotten")
    return (set(findings) ^ set(usual), pressed_mgal - exact_mgal, usual, exact_mgal,
            set(found) - set(usual) - {("short_stay", site)} == {("missed_set_up", site)})


line = command_line(__doc__, "late_stops.py 13201 1 2 2")
add_days(line, 13201, 2, least=0)
line.add_argument("clean", metavar="CLEAN", nargs="?", type=at_least(0), default=30, help="number of days without a mistake")
line.add_argument("changed", metavar="CHANGED", nargs="?", type=at_least(0), default=20, help="number of days with two set-ups, 0 or from 2 on")
options = line.parse_args()
if options.changed == 1:
    line.error("CHANGED = 1: allowed: 0, or 2 and more, for the scatter of the days")
first, days, clean, changed = options.first, options.days, options.clean, options.changed
jobs = [(scenario, first + k, False) for scenario in ("tsukuba", "roadside", "tilted") for k in range(days)]
jobs += [("tsukuba", first + days + k, True) for k in range(clean)]
with Scratch() as scratch, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    looked = list(pool.map(lambda job: look_at(scratch, *job), jobs))
    changes = list(pool.map(lambda seed: change(scratch, seed), range(first + days + clean, first + days + clean + changed)))
failures = []
if looked:
    false = sum(bool(found) for found, _ in looked)
    late = [one for _, day in looked for one in day]
    right = sum(found == [("moved_box", site)] for site, found, _ in late)
    ratios = [ratio for *_, ratio in late]
    if late:
        print(f"{right} of {len(late)} late stops are found, and no other stay is named; left-out error {statistics.median(ratios):.3f} "
              f"times that of the day without the mistake (median), at most {max(ratios):.3f}, promised {MOST_WORSE}")
        if right < 0.95 * len(late) or max(ratios) > MOST_WORSE:
            failures.append("late stops")
    print(f"{false} of {len(looked)} days without a mistake have a finding")
    if false > 0.05 * len(looked):
        failures.append("days without a mistake")
if changes:
    differing, differences, usual, errors, is_found = zip(*changes)
    findings = [kind for day in differing for kind, _ in day]
    standard_error = statistics.stdev(differences) / len(changes) ** 0.5
    print(f"Next set-up beside the lifting, {len(changes)} days: {len(findings)} differing findings {sorted(set(findings))}, and "
          f"{sum(map(len, usual))} with the press at the lifting too; left-out error {statistics.fmean(differences):+.4f} mGal, standard error "
          f"{standard_error:.4f}, of {statistics.fmean(errors):.3f}; {sum(is_found)} forgotten ones are found, and nothing else is new")
    if findings or abs(statistics.fmean(differences)) > 2.0 * standard_error or sum(is_found) < 0.95 * len(changes):
        failures.append("Next set-up beside the lifting")
end_with(failures)
