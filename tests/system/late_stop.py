"""A stop that is pressed at the next benchmark: the stay ends where the box was moved, and the day is hardly worse.

move_meaning_test.cpp has all other moves, and *Next set-up* before or after the lifting.
"""

import datetime
import json

from programs import BIN, Scratch, demand, read_json, rows, run

MOST_WORSE = 1.10


def instant(text):
    return datetime.datetime.fromisoformat(text.replace("Z", "")[:26] + "+00:00")


def amend(day, survey, finding):
    (day / "amendments.toml").write_text(finding["amendment"])
    survey.write_text(survey.read_text().replace("base = ", 'amendments = "amendments.toml"\nbase = '))


def corrected(day, name):
    run(BIN / "a351-correct", "survey", day / "survey.toml", "--model", "day", "--out", day / name,
        env={"PATH": str(day)})  # A folder without gnuplot: no figures are drawn.
    result = read_json(day / name / "result.json")
    return result, result["cross_validated"]["loso_mgal"]


with Scratch() as scratch:
    day = scratch / "day"
    run(BIN / "a351-sim", "survey", "--scenario", "hot-afternoon", "--seed", 5, "--out", day)
    survey = day / "survey.toml"
    survey.write_text(survey.read_text().replace('occupations = "schedule.csv"',
                                                 'occupations = ""'))  # The stays are those of the log.
    log = next((day / "events").glob("*.jsonl"))
    events = [json.loads(line) for line in log.read_text().splitlines()]
    clean, clean_mgal = corrected(day, "clean")
    demand("a day without a mistake has no finding", clean["findings"] == [])

    stop = next(i for i, event in enumerate(events) if event["type"] == "stop" and event["site"] == "No.1")
    starts = [event for event in events[stop:] if event["type"] == "start"]
    true = instant(events[stop]["utc"])
    late = instant(starts[0]["utc"]) - datetime.timedelta(seconds=30)
    events[stop]["utc"] = late.strftime("%Y-%m-%dT%H:%M:%S.%fZ")
    log.write_text("".join(json.dumps(event) + "\n" for event in events))
    result, late_mgal = corrected(day, "late")
    demand(f"one finding: {[finding['text'] for finding in result['findings']]}", len(result["findings"]) == 1)
    finding = result["findings"][0]
    key = next(row["key"] for row in rows(day / "late" / "occupations.csv") if row["site"] == "No.1")
    demand("it names the stay and its kind", (finding["kind"], finding["site"], finding["occupation"], finding["key"])
           == ("moved_box", "No.1", 1, key))
    found = instant(finding["time_utc"])
    demand(f"the stop was {(late - true).total_seconds() / 60:.1f} min late; the move is found between the true stop and "
           f"the next start, {(found - true).total_seconds() / 60:.1f} min after the stop",
           true - datetime.timedelta(seconds=30) <= found < late)
    demand(f"left out {late_mgal:.2f} mGal, {clean_mgal:.2f} without the mistake, at most {MOST_WORSE} times",
           late_mgal <= MOST_WORSE * clean_mgal)
    flags = next(row["flags"] for row in rows(day / "late" / "occupations.csv") if row["site"] == "No.1")
    demand(f"the reading is flagged: {flags}", "moved" in flags)

    amend(day, survey, finding)
    result, amended_mgal = corrected(day, "amended")
    demand("pasted as an amendment the proposal is accepted, and nothing is found any more",
           len(result["settings"]["amendments"]) == 1 and result["findings"] == [])
    demand(f"the amended day is the same: {amended_mgal:.4f} and {late_mgal:.4f} mGal",
           abs(amended_mgal - late_mgal) < 0.01)
