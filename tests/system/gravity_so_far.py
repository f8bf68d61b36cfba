"""Gravity at the benchmark: stays of an emulated day, and the corrector that the daemon runs beside the recording.

After each stop the value must be there within 15 s of real time.  In the end the daemon's answer must be what the
corrector finds in a copy of the data root.  The recording must not notice any of it.
"""

import json
import math
import shutil
import time

from emulated_session import Session, told_at, wait_for
from programs import BIN, IS_SANITIZED, Scratch, answer, demand, end_cleanly, rows, run

SPEED = 60 if IS_SANITIZED else 800
MOST_S = 15.0
MOST_MEMORY_MB = 60.0
DAY = 'base = "tsukuba"\nname = "tsukuba-gravity"\n' + "".join(
    f'[[occupation]]\nsite = "{site}"\nnumber = {number}\ncentre_utc = "{centre}"\nlength_s = 720\nambient_degc = 25\n'
    for site, number, centre in (("No.0", 1, "2017-07-15T23:42:00Z"), ("No.12", 1, "2017-07-16T00:20:00Z"),
                                 ("No.1", 1, "2017-07-16T00:55:00Z"), ("No.0", 2, "2017-07-16T01:30:00Z")))


def survey(session):
    return answer(session.port, "/api/survey", 10)


def is_there(document, site, number, is_running):
    """Returns True if a stay has a value, or the reason why there is none yet."""
    stay = next((stay for stay in document["stays"] if (stay["site"], stay["occupation"]) == (site, number)), None)
    if stay is None or stay["is_running"] is not is_running:
        return False
    return stay["gravity_mgal"] is not None or document["reason"] == "too_few_readings"


with Scratch() as scratch:
    (scratch / "day.toml").write_text(DAY)
    session = Session(scratch, speed=SPEED, scenario=scratch / "day.toml",
                      config='[survey]\nsites = "sites.csv"\ngravity_every_min = 0.02\n')
    wait_for("the daemon answers", lambda: session.status())
    before = survey(session)
    demand(f"before the first start there is a reason and no figure: {before['reason']}",
           before["reason"] == "not_yet" and before["stays"] == [])
    waited = []
    for stay in rows(scratch / "schedule.csv"):
        place = stay["site"], int(stay["occupation"])
        told_at(session, stay["start_utc"], "start", stay["site"])
        wait_for(f"{place} runs with a value", lambda: is_there(survey(session), *place, True), 30)  # noqa: B023
        told_at(session, stay["end_utc"], "stop")
        begin = time.monotonic()
        wait_for(f"{place} has a value after its stop",
                 lambda: is_there(survey(session), *place, False), 60)  # noqa: B023
        waited.append(time.monotonic() - begin)
    demand(f"each value is there after {min(waited):.2f} to {max(waited):.2f} s of real time, limit {MOST_S}",
           max(waited) < MOST_S)

    demand("the emulator sends the rest of its day and ends cleanly", session.sim.wait(timeout=1800) == 0)
    wait_for("the archive has everything", lambda: session.status()["archived"] == session.status()["received"], 60)
    session.ctl("note", "end of the test")
    last = survey(session)["as_of_utc"]
    wait_for("figures of the silent sensor", lambda: survey(session)["as_of_utc"] != last, 30)
    shown = survey(session)
    print(session.ctl("survey"), end="")
    copy = scratch / "last"
    shutil.copytree(scratch / "data", copy)
    corrected = json.loads(run(BIN / "a351-correct", "survey", copy, "--sites", scratch / "sites.csv", "--json").stdout)
    for key in ("reason", "model", "stays", "findings"):
        demand(f"the daemon's {key} are those of the corrector on a copy of its root", shown[key] == corrected[key])
    demand("the corrector has changed nothing in the root that it read",
           not (copy / "result").exists() and sorted(p.name for p in copy.iterdir()) == sorted(p.name for p in (scratch / "data").iterdir()))

    truth = {(row["site"], int(row["occupation"])): float(row["gravity_mgal"]) for row in rows(scratch / "truth.csv")}
    for stay in shown["stays"]:
        error = stay["gravity_mgal"] - truth[stay["site"], stay["occupation"]]
        demand(f"{stay['site']} ({stay['occupation']}): {error:+.2f} mGal from the truth, limit 4 u",
               math.fabs(error) < 4.0 * stay["u_mgal"])
    memory_mb = next(int(line.split()[1]) for line in open(f"/proc/{session.daemon.pid}/status") if line.startswith("VmHWM")) / 1000
    end_cleanly("the daemon", session.daemon)
    session.archive_is_true(missing=0)
    demand(f"the daemon needed {memory_mb:.1f} MB, limit {MOST_MEMORY_MB:.0f}", memory_mb < MOST_MEMORY_MB
           or IS_SANITIZED)
    warnings = [line for line in (scratch / "a351d.log").read_text().splitlines() if "gravity" in line]
    demand(f"nothing was reported as failed: {warnings}", warnings == [])
