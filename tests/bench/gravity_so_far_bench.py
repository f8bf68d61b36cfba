"""Measures whether the gravity so far is as good as it says, at the moment of each stop.

Each seed draws a unit within +-25 % and a day.
The event log is cut after each stop.  Counted is the stay that was just stopped, if it is at a known benchmark and its difference
with the hidden reference can be computed, which needs another known benchmark; and then all stays that are shown at that time.
Promised for both: within 2 u for at least 92 % of stays.
"""

import concurrent.futures
import json
import os
import shutil

from command_line import add_seeds, command_line, end_with
from simulated_units import rms, rms_by_day, simulate
from programs import BIN, Scratch, run

PROMISED = 0.92


def looked_at(scratch, seed, scenario):
    """Returns difference and uncertainty of the newest stay after each stop, the same of all stays that are shown then, and the
    reasons where the newest has none."""
    folder = scratch / str(seed)
    folder.mkdir()
    day = simulate(folder, "day", scenario, seed, 0.25)
    log = next((day / "events").glob("*.jsonl"))
    events = log.read_text().splitlines(keepends=True)
    found, shown, reasons = [], [], []
    for k in range(2, len(events) + 1, 2):
        log.write_text("".join(events[:k]))
        answer = json.loads(run(BIN / "a351-correct", "survey", day, "--sites", day / "sites.csv", "--json").stdout)
        known = [stay for stay in answer["stays"] if stay["left_out_difference_mgal"] is not None]
        shown += [(stay["left_out_difference_mgal"], stay["u_mgal"]) for stay in known]
        if answer["stays"][-1] in known:
            found.append(shown[-1])
        else:
            reasons.append(answer["reason"] or "no other known benchmark")
    shutil.rmtree(folder)
    inside = [sum(abs(error) <= 2.0 * u for error, u in some) for some in (found, shown)]
    print(f"{seed}: within 2 u at their stop {inside[0]} of {len(found)}, as shown {inside[1]} of {len(shown)}", flush=True)
    return found, shown, reasons


def share_within(name, by_day):
    """Prints how the differences of days compare with their uncertainties; returns the share within 2 u."""
    differences = [one for day in by_day for one in day]
    error, u_error = rms_by_day([error for error, _ in day] for day in by_day)
    within = sum(abs(error) <= 2.0 * u for error, u in differences) / len(differences)
    print(f"{len(differences)} {name} of {len(seeds)} days: difference from the hidden reference {error:.2f} +- {u_error:.2f} mGal "
          f"rms, u {rms(u for _, u in differences):.2f} mGal rms; {100.0 * within:.1f} % within 2 u, promised {100.0 * PROMISED:.0f} %")
    return within


line = command_line(__doc__, "gravity_so_far_bench.py 14301-14302 hot-afternoon")
add_seeds(line, "14301-14320")
line.add_argument("scenario", metavar="SCENARIO", nargs="?", default="tsukuba", help="scenario of the days, name or file")
options = line.parse_args()
seeds, scenario = options.seeds, options.scenario
with Scratch() as scratch, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    days = list(pool.map(lambda seed: looked_at(scratch, seed, scenario), seeds))
reasons = [reason for _, _, day in days for reason in day]
print("without a difference: " + ", ".join(f"{reasons.count(reason)} {reason}" for reason in sorted(set(reasons))))
shares = [share_within("stays at their stop", [day[0] for day in days]),
          share_within("stays as they are shown after each stop", [day[1] for day in days])]
end_with([f"{100.0 * share:.1f} % within 2 u" for share in shares if share < PROMISED])
