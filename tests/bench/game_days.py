"""Measures what three mistakes do to a survey day, and what is left of them when every proposal is carried out.

Days of tsukuba, hot-afternoon and tilted in turn.  Each seed draws a unit within +-25 % and three mistakes
of tests/system/mistakes.toml (tired_operator.py).
"""

import concurrent.futures
import os
import shutil
import statistics

from command_line import add_days, command_line, end_with
from simulated_units import unit_of
from programs import Scratch
from tired_operator import play

MOST_MEDIAN, MOST_EVER, MOST_CHANGED = 1.15, 1.5, 2.0
SCENARIOS = ("tsukuba", "hot-afternoon", "tilted")


def game(scratch, seed):
    folder = scratch / str(seed)
    folder.mkdir()

    def scenario(sections):
        file = folder / "scenario.toml"
        error = "".join(f"{key} = {value}\n" for key, value in unit_of(seed, 0.25).items())
        file.write_text(f'base = "{SCENARIOS[seed % len(SCENARIOS)]}"\nname = "game"\n[temperature_error]\n{error}{sections}')
        return file

    result = play(folder, scenario, seed)
    shutil.rmtree(folder)
    return result


line = command_line(__doc__, "game_days.py 23001 3")
add_days(line, 23001, 40)
options = line.parse_args()
first, count = options.first, options.days
with Scratch() as scratch, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    games = []
    for seed, one in zip(range(first, first + count), pool.map(lambda seed: game(scratch, seed), range(first, first + count))):
        games.append(one)
        made = "; ".join(f"{mistake['name']}{' (noticed)' if mistake['is_noticed'] else '' if mistake['is_said'] else ' (UNSAID)'}"
                         for mistake in one["made"])
        print(f"seed {seed}: {SCENARIOS[seed % len(SCENARIOS)]}: {one['raw']:.2f} as it is, {one['amended']:.2f} amended, "
              f"changed by at most {one['changed']:.1f} u: {made}", flush=True)
        if os.environ.get("A351_SHOW"):
            for finding in one["findings"]:
                print("   ", finding["text"])
ratios = [one["amended"] for one in games]
unsaid = [one for one in games for mistake in one["made"] if not mistake["is_said"]]
harmful = [one for one in unsaid if one["changed"] > MOST_CHANGED]
silent = [one for one in harmful if not one["is_misfit"]]
print(f"{count} days with {sum(len(one['made']) for one in games)} mistakes: left-out error as it is "
      f"{statistics.median(one['raw'] for one in games):.2f} times that without mistakes (median), with every proposal carried "
      f"out {statistics.median(ratios):.3f} (promised {MOST_MEDIAN}), at most {max(ratios):.3f} (promised {MOST_EVER}); "
      f"{len(unsaid)} mistakes unsaid, {len(harmful)} of them on days that are changed by more than {MOST_CHANGED:.0f} u, "
      f"{len(silent)} without a word that the model does not fit")
end_with([*(["the median"] if statistics.median(ratios) > MOST_MEDIAN else []), *(["the largest"] if max(ratios) > MOST_EVER else []),
          *(["a word on each day with a mistake that harms"] if silent else [])])
