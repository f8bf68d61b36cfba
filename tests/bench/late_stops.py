"""Measures what a stop that is pressed at the next benchmark does to a day.

usage: late_stops.py [FIRST_SEED [DAYS [CLEAN]]]    (A351_BIN, A351_TOOLS)
FIRST_SEED: default 13201.  On each of DAYS days (default 2) of three scenarios each stop is moved to 30 s before the next start,
one at a time.  CLEAN further days of tsukuba (default 30) have no mistake.
"""

import concurrent.futures
import datetime
import json
import os
import statistics
import sys

from simulated_units import correct, simulate
from programs import Scratch, read_json

MOST_WORSE = 1.10


def corrected(folder, day, name):
    result = read_json(correct(folder, day / "survey.toml", name, "--model", "day") / "result.json")
    return result["cross_validated"]["loso_mgal"], [(finding["kind"], finding["site"]) for finding in result["findings"]]


def look_at(scratch, scenario, seed, is_clean):
    """Returns the findings without a mistake, and for each late stop its site, findings and ratio of the errors."""
    folder = scratch / f"{scenario}-{seed}"
    folder.mkdir()
    day = simulate(folder, "day", scenario, seed, 0.0)
    survey = day / "survey.toml"
    survey.write_text(survey.read_text().replace('occupations = "schedule.csv"', 'occupations = ""'))
    clean_mgal, false = corrected(folder, day, "clean")
    log = next((day / "events").glob("*.jsonl"))
    events = [json.loads(line) for line in log.read_text().splitlines()]
    late = []
    for i, stop in enumerate(events):
        after = [event for event in events[i:] if event["type"] == "start"]
        if is_clean or stop["type"] != "stop" or not after or after[0]["site"] == stop["site"]:
            continue
        begin = datetime.datetime.fromisoformat(after[0]["utc"][:26] + "+00:00")
        utc = (begin - datetime.timedelta(seconds=30)).strftime("%Y-%m-%dT%H:%M:%S.%fZ")
        log.write_text("".join(json.dumps({**event, "utc": utc} if event is stop else event) + "\n" for event in events))
        late_mgal, found = corrected(folder, day, "late")
        late.append((stop["site"], found, late_mgal / clean_mgal))
    return false, late


first, days, clean = (int(sys.argv[k]) if len(sys.argv) > k else default for k, default in ((1, 13201), (2, 2), (3, 30)))
jobs = [(scenario, first + k, False) for scenario in ("tsukuba", "roadside", "tilted") for k in range(days)]
jobs += [("tsukuba", first + days + k, True) for k in range(clean)]
with Scratch() as scratch, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    looked = list(pool.map(lambda job: look_at(scratch, *job), jobs))
false = sum(bool(found) for found, _ in looked)
late = [one for _, day in looked for one in day]
right = sum(found == [("moved_box", site)] for site, found, _ in late)
ratios = [ratio for *_, ratio in late]
print(f"{right} of {len(late)} late stops are found, and no other stay is named; left-out error {statistics.median(ratios):.3f} "
      f"times that of the day without the mistake (median), at most {max(ratios):.3f}, promised {MOST_WORSE}; "
      f"{false} of {len(looked)} days without a mistake have a finding")
sys.exit(right < 0.95 * len(late) or max(ratios) > MOST_WORSE or false > 0.05 * len(looked))
