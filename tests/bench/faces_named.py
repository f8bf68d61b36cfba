"""Measures how often a turn that was forgotten, and a face that was entered wrong, is named in the evening.

Days of tsukuba in the faces + - - +.  The log of each day has the planned face of each set-up, and that of one set-up
of some stay is the other one, as if its turn had been forgotten; in another stay a face was entered, and it is wrong.  Ten days are
simulated, the rest are the same days with other set-ups.
Promised: both are named, and nothing else about faces, on 95 of 100 days; nothing without these mistakes.
"""

import concurrent.futures
import json
import os
import random
import shutil

from command_line import add_days, command_line, end_with
from simulated_units import correct, hide_references, simulate
from programs import Scratch

PLAN = "+--+"
SIMULATED, LEAST_NAMED = 10, 0.95


def state_faces(day, draw):
    """Writes faces into the log and returns those that are wrong, as (site, occupation, code); without a draw none is."""
    log = next((day / "events").glob("*.jsonl"))
    events = [json.loads(line) for line in log.read_text().splitlines()]
    stays = []
    for event in events:
        if event["type"] == "start":
            stays.append([event])
        elif event["type"] == "setup":
            stays[-1].append(event)
            event["planned_face"] = PLAN[len(stays[-1]) - 1]
    wrong = set()
    if draw is not None:
        forgotten, entered = draw.sample(range(len(stays)), 2)
        visits = [sum(stay[0]["site"] == other[0]["site"] for other in stays[:k + 1]) for k, stay in enumerate(stays)]
        set_up = draw.randrange(1, len(PLAN))
        stays[forgotten][set_up]["planned_face"] = "+" if PLAN[set_up] == "-" else "-"
        set_up = draw.randrange(len(PLAN))
        stays[entered][set_up]["face"] = "+" if PLAN[set_up] == "-" else "-"
        wrong = {(stays[k][0]["site"], visits[k], code) for k, code in ((forgotten, "turn_forgotten"), (entered, "face_entered"))}
    log.write_text("".join(json.dumps(event, separators=(",", ":")) + "\n" for event in events))
    return wrong


def is_named(scratch, simulated, number, has_mistakes):
    day = scratch / f"day-{number}-{has_mistakes}"
    shutil.copytree(simulated, day)
    wrong = state_faces(day, random.Random(number) if has_mistakes else None)
    survey, _ = hide_references(day, {"No.0"}, "known")  # With one known station a correction takes a third of the time.
    text = survey.read_text()
    assert 'occupations = "schedule.csv"' in text
    survey.write_text(text.replace('occupations = "schedule.csv"', 'occupations = ""'))  # the event log
    result = json.loads((correct(day, survey, "result") / "result.json").read_text())
    named = {(one["site"], one["occupation"], one["code"]) for one in result["findings"] if one["kind"] == "turned"}
    shutil.rmtree(day)
    return named == wrong


def main():
    line = command_line(__doc__, "faces_named.py 97501 10")
    add_days(line, 97501, 100)
    options = line.parse_args()
    first, days = options.first, options.days
    with Scratch() as scratch, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        simulated = [*pool.map(lambda seed: simulate(scratch, f"{seed}", "tsukuba", seed, 0.25,
                                                     f"[schedule]\nsetups = {len(PLAN)}\nfaces = \"{PLAN}\"\n"),
                               range(first, first + min(SIMULATED, days)))]
        named = sum(pool.map(lambda k: is_named(scratch, simulated[k % len(simulated)], k, True), range(days)))
        quiet = sum(pool.map(lambda k: is_named(scratch, simulated[k], k, False), range(len(simulated))))
    print(f"named on {named} of {days} days; nothing said on {quiet} of {len(simulated)} days without a mistake")
    end_with([*(["named on 95 %"] if named < LEAST_NAMED * days else []),
              *(["nothing said without a mistake"] if quiet < len(simulated) else [])])


main()
