"""One order starts, sets up and stops the stays of three boxes at the same instant, also if one of them is dead.

The dead box is named, the others carry the order out, and repeating the order does what is missing and nothing twice.
"""

import json
import re
import time

from box_group import SAMPLE_S, Boxes, last_sample, spread_s
from emulated_session import wait_for
from programs import Scratch, demand


def running(session):
    return session.status()["occupation"]


def stays(session):
    return json.loads(session.ctl("list", "--json"))["occupations"]


def repeat_instant(boxes, said):
    """Demands that an order names the dead box, the last one, and returns the instant with which to repeat it."""
    again = re.search(r"repeat it with --at (\S+);", said.stderr)
    demand(f"{len(boxes.sessions)} boxes, one dead: the order names it: {said.stderr.strip()}",
           said.returncode == 1 and f"{boxes.urls[-1]}: no daemon answers" in said.stderr and again)
    return again[1]


def orders(boxes):
    """All stays by the terminal, with one box dead at the start and at the stop."""
    count, dead, alive = len(boxes.sessions), boxes.sessions[-1], boxes.sessions[:-1]
    before = min(last_sample(session) for session in boxes.sessions)
    received = dead.status()["received"]
    wait_for("the journal has what was received", lambda: dead.status()["journaled"] >= received)
    boxes.kill(dead)
    said = boxes.ctl("start", "No.1", "--operator", "Ito", "--at", before)
    again = repeat_instant(boxes, said)
    starts = [running(session)["start"] for session in alive]
    demand(f"{count} boxes: the {len(starts)} others began at the same instant, within {spread_s(starts)} s, limit {SAMPLE_S}",
           spread_s(starts) <= SAMPLE_S)
    boxes.revive(dead)
    said = boxes.ctl("start", "No.1", "--operator", "Ito", "--at", again)
    print(said.stdout, said.stderr)
    demand(f"{count} boxes: repeated, the {len(starts)} that did it say so and change nothing",
           said.stdout.count("as ordered before") == len(starts) and [running(session)["start"] for session in alive] == starts)
    starts.append(running(dead)["start"])
    demand(f"{count} boxes: the box that was dead began at the same instant, within {spread_s(starts)} s",
           said.returncode == 0 and spread_s(starts) <= SAMPLE_S)
    for command in (("setup",), ("note", "wind")):
        time.sleep(1.0)
        said = boxes.ctl(*command)
        demand(f"{count} boxes: {command[0]} is carried out by all: {said.stderr.strip()}",
               said.returncode == 0 and len(said.stdout.splitlines()) == count)
    boxes.kill(dead)
    again = repeat_instant(boxes, boxes.ctl("stop"))
    boxes.revive(dead)
    demand("the dead box still has its stay, which is stopped by itself", running(dead) and "stopped No.1" in dead.ctl("stop"))
    said = boxes.ctl("stop", "--at", again)
    demand(f"{count} boxes: repeated, the {len(alive)} that stopped say so", said.stdout.count("as ordered before") == len(alive))
    made = [stays(session) for session in boxes.sessions]
    demand(f"{count} boxes: each has one stay of two set-ups", all(len(one) == 1 and len(one[0]["set_ups"]) == 2 for one in made))
    for what, instants in (("the set-up began", [one[0]["set_ups"][1]["start"] for one in made]),
                           ("the stay ended", [one[0]["set_ups"][1]["end"] for one in made[:-1]])):
        demand(f"{count} boxes: {what} at the same instant, within {spread_s(instants)} s", spread_s(instants) <= SAMPLE_S)


with Scratch() as scratch:
    group = Boxes(scratch, 3)
    orders(group)
    group.end()
