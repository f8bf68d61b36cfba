"""A stop that is pressed at the next benchmark: the stay ends where the box was moved, and the day is hardly worse.
*Next set-up* before or after the lifting: nothing is said; without it a set-up is proposed."""

import datetime
import json

from programs import BIN, Scratch, demand, read_json, rows, run

MOST_WORSE = 1.10


def instant(text):
    return datetime.datetime.fromisoformat(text.replace("Z", "")[:26] + "+00:00")


def shifted(event, by_s):
    """Returns an event this time later."""
    return {**event, "utc": (instant(event["utc"]) + datetime.timedelta(seconds=by_s)).strftime("%Y-%m-%dT%H:%M:%S.%fZ")}


def write(log, events):
    log.write_text("".join(json.dumps(event) + "\n" for event in events))


def logged_day(day, scenario, seed):
    """Simulates a day whose stays are those of its log; returns the survey file, the log and its events."""
    run(BIN / "a351-sim", "survey", "--scenario", scenario, "--seed", seed, "--out", day)
    survey = day / "survey.toml"
    survey.write_text(survey.read_text().replace('occupations = "schedule.csv"', 'occupations = ""'))
    log = next((day / "events").glob("*.jsonl"))
    return survey, log, [json.loads(line) for line in log.read_text().splitlines()]


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
    survey, log, events = logged_day(day, "hot-afternoon", 5)
    clean, clean_mgal = corrected(day, "clean")
    demand("a day without a mistake has no finding", clean["findings"] == [])

    stop = next(i for i, event in enumerate(events) if event["type"] == "stop" and event["site"] == "No.1")
    starts = [event for event in events[stop:] if event["type"] == "start"]
    true = instant(events[stop]["utc"])
    events[stop]["utc"] = shifted(starts[0], -30.0)["utc"]
    late = instant(events[stop]["utc"])
    write(log, events)
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

    day = scratch / "two-set-ups"
    (scratch / "two.toml").write_text('base = "tsukuba"\nname = "two"\n[schedule]\nsetups = 2\n')
    survey, log, events = logged_day(day, scratch / "two.toml", 7)
    changes = [i for i, event in enumerate(events) if event["type"] == "setup"]
    late_s = dict(zip(changes, (-55.0, -35.0, -15.0, 15.0, 45.0, 75.0, 105.0, 180.0) * len(changes)))
    pressed = [shifted(event, late_s.get(i, 0.0)) for i, event in enumerate(events)]
    write(log, pressed)
    result, pressed_mgal = corrected(day, "pressed")
    demand(f"Next set-up beside the lifting is no finding: {[finding['text'] for finding in result['findings']]}", result["findings"] == [])
    flags = [row["flags"] for row in rows(day / "pressed" / "occupations.csv")]
    demand("no reading is flagged as moved", len(flags) == 2 * len(changes) and not any("moved" in one for one in flags))
    start = events[changes[0] - 1]
    write(log, pressed[:changes[0]] + pressed[changes[0] + 1:])
    result, _ = corrected(day, "forgotten")
    demand(f"a forgotten one is proposed: {[finding['text'] for finding in result['findings']]}",
           [(finding["kind"], finding["site"], finding["is_headline"]) for finding in result["findings"]]
           == [("missed_set_up", start["site"], False)])
    finding = result["findings"][0]
    found_s = (instant(finding["time_utc"]) - instant(events[changes[0]]["utc"])).total_seconds()
    demand(f"at its time, {found_s:.0f} s beside it", abs(found_s) < 30.0)
    amend(day, survey, finding)
    result, amended_mgal = corrected(day, "amended")
    demand(f"with the proposal the day is that with the press: {amended_mgal:.3f} and {pressed_mgal:.3f} mGal",
           result["findings"] == [] and abs(amended_mgal - pressed_mgal) < 0.02)
