"""Measures how soon the recorder names another sensor that is attached at a random place of a day.

Each day has an emulator and a recorder of its own, which start at a random instant of
tsukuba's day and run five times as fast.  A stay starts, and on half of the days it has ended before the exchange.  After 10 to
200 s of signal another sensor is attached.  Times are in s of signal: from the exchange, and from the last look at
which the other sensor had sent no frame.  Promised: 10 s after this look.
"""

import concurrent.futures
import datetime
import json
import random
import time

from command_line import add_days, command_line, end_with
import simulated_units  # noqa: F401  finds the modules of tests/system
from emulated_session import Session, wait_for
from programs import BIN, Scratch, daemon_status, events_of, instant, run

SPEED, AT_ONCE, DAY_H = 5, 3, 8.0
OWN, OTHER = "00000001", "87654321"
LIMIT_S = 10.0


def starts(seed):
    """Returns a random instant of the day, and the random numbers that follow."""
    draw = random.Random(f"exchange {seed}")
    with Scratch() as scratch:
        plan = run(BIN / "a351-sim", "plan", "--scenario", "tsukuba", "--out", ".", cwd=scratch).stdout
    begin = instant(dict(part.split("=", 1) for part in plan.split())["start_utc"])
    return (begin + datetime.timedelta(hours=draw.uniform(0, DAY_H))).strftime("%Y-%m-%dT%H:%M:%SZ"), draw


def named(seed):
    """Returns the seed, the start, the two times until the exchange is named, and what is wrong."""
    start, draw = starts(seed)
    with Scratch() as scratch:
        session = Session(scratch, speed=SPEED, start=start)
        session.wait_for_frames(50)
        session.ctl("start", "No.1")
        time.sleep(draw.uniform(10.0, 200.0) / SPEED)
        if draw.random() < 0.5:
            session.ctl("stop")
        runs = len(session.emulated()["runs"])
        began = time.monotonic()
        session.order(f"other_unit serial_number={OTHER}")
        last_silent = [began]

        def is_named():
            now = time.monotonic()
            if len(session.emulated()["runs"]) == runs:
                last_silent[0] = now
            status = daemon_status(session.port) or {}
            return any(f"{OTHER} after {OWN}" in reason for reason in status.get("reasons", []))

        wait_for("the exchange is named", is_named)
        end = time.monotonic()
        stays = json.loads(session.ctl("list", "--json"))["occupations"]
        wrong = [] if len(stays) == 1 and session.status()["occupation"] is None else ["the stay was not cut"]
        session.daemon.terminate()
        session.daemon.wait(timeout=60)
        session.sim.terminate()
        session.sim.wait(timeout=60)
        if [(event["serial_number"], event["before"]) for event in events_of(scratch / "data") if event["type"] == "other_unit"] != [(OTHER, OWN)]:
            wrong.append("not one event")
        return seed, start, SPEED * (end - began), SPEED * (end - last_silent[0]), wrong


line = command_line(__doc__, "exchanged_live.py 48301 2")
add_days(line, 48001, 4)
options = line.parse_args()
first, days = options.first, options.days
results = []
with concurrent.futures.ThreadPoolExecutor(AT_ONCE) as pool:
    for seed, start, after_s, sent_s, wrong in pool.map(named, range(first, first + days)):
        results.append((after_s, sent_s, wrong))
        print(f"seed {seed}: from {start}, {after_s:.1f} s after the exchange, {sent_s:.1f} s after the last silence  {'; '.join(wrong)}", flush=True)
late = sum(result[1] > LIMIT_S or bool(result[2]) for result in results)
print(f"{days} days: named at most {max(r[0] for r in results):.1f} s after the exchange, {max(r[1] for r in results):.1f} s after the "
      f"last silence (limit {LIMIT_S:.0f} s)")
end_with([f"late or wrong on {late} days"] if late else [])
