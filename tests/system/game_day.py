"""A tired operator's day: each mistake is said in the evening, and carrying out the proposals puts the day right."""

import re

from programs import BIN, IS_LONG, Scratch, demand, read_json, refused, rows, run
from tired_operator import MISTAKES, play

MOST_WORSE, MOST_WORSE_LATE = 1.5, 1.1
# Seed, scenario and mistakes of each day.
SHORT = ((6, "tsukuba", ("no_last_stop", "late_stop", "other_name", "no_stay", "early_stop")),)
LONG = ((1, "hot-afternoon", ("no_stop", "swapped_names", "early_start", "late_start")), (2, "tilted", ("wrong_reference", "knocks")),
        (4, "tsukuba", ("step", "missed_set_up")))


def scenario_of(folder, base):
    def scenario(sections):
        file = folder / "scenario.toml"
        file.write_text(f'base = "{base}"\nname = "game"\n{sections}')
        return file
    return scenario


with Scratch() as scratch:
    played = set()
    for seed, base, what in SHORT + (LONG if IS_LONG else ()):
        folder = scratch / str(seed)
        folder.mkdir()
        game = play(folder, scenario_of(folder, base), seed, names=[one["name"] for one in MISTAKES if one["what"] in what])
        played |= {mistake["what"] for mistake in game["made"]}
        for finding in game["findings"]:
            print("   ", finding["text"])
        for mistake in game["made"]:
            demand(f"{base}: {mistake['name']}: " + ("noticed by the operator" if mistake["is_noticed"] else "said" if
                   mistake["kinds"] else "nothing that must be named"), mistake["is_said"])
        demand(f"{base}: left-out error {game['raw']:.2f} times that without mistakes as it is, {game['amended']:.2f} times with "
               f"the proposals carried out, at most {MOST_WORSE}", game["amended"] <= MOST_WORSE)
    demand(f"all mistakes {'of the file' if IS_LONG else 'of the short form'} were played: {sorted(played)}",
           played == ({mistake["what"] for mistake in MISTAKES} if IS_LONG else set(SHORT[0][2])))

    folder = scratch / "late"
    folder.mkdir()
    game = play(folder, scenario_of(folder, "hot-afternoon"), 5, names=["stop pressed at the next benchmark"])
    kinds = [[finding["kind"] for finding in game[findings]] for findings in ("clean", "findings")]
    demand(f"a stop at the next benchmark alone does not spoil the day: {game['raw']:.3f} times the error, at most {MOST_WORSE_LATE}; "
           f"findings without and with it {kinds}", game["raw"] <= MOST_WORSE_LATE and game["made"][0]["is_said"]
           and not game["made"][0]["is_noticed"] and kinds == [["not_visited"], ["moved_box", "not_visited"]])

    day = scratch / str(SHORT[0][0]) / "day"
    late, = (finding for finding in read_json(day / "as-it-stands" / "result.json")["findings"] if finding["kind"] == "moved_box")
    flags = next(row["flags"] for row in rows(day / "as-it-stands" / "occupations.csv") if row["key"] == late["key"])
    demand(f"the finding of the late stop names the stay, whose reading is flagged: {flags}", "moved" in flags)
    survey = day / "survey.toml"
    amendments = (day / "survey-amendments.toml").read_text()
    demand("the survey file names the amendments", 'amendments = "survey-amendments.toml"' in survey.read_text())
    result = read_json(day / "amended" / "result.json")
    reasons = {one["reason"] for one in result["settings"]["amendments"]}
    demand(f"the result lists them with their reasons: {reasons}", len(reasons) >= 1)

    printed = run(BIN / "a351-correct", "amend", survey).stdout
    demand("without an option the proposals are only printed", (day / "survey-amendments.toml").read_text() == amendments)
    print(printed)
    amend = BIN / "a351-correct", "amend", survey
    refused("--finding = 99: no finding with a proposal; allowed: ", *amend, "--finding", "99")
    # The stay got another wrong name: the proposal of the right one contradicts this amendment.
    one = next(part for part in amendments.split("#") if "[[rename]]" in part)
    contradicting = re.sub(r'to = "[^"]*"', 'to = "P.3"', "#" + one)
    (day / "survey-amendments.toml").write_text(contradicting)
    before = survey.read_bytes(), (day / "survey-amendments.toml").read_bytes()
    refused("contradicts another amendment", *amend, "--all")
    demand("no file is changed", before == (survey.read_bytes(), (day / "survey-amendments.toml").read_bytes())
           and not list(day.glob("*.candidate")))
    (day / "survey-amendments.toml").write_text("# earlier\n")
    (day / "taken.toml").write_text("# of another survey\n")
    refused("taken.toml", *amend, "--all", "--out", day / "taken.toml")
    demand("a file that is not that of the survey is not taken over", (day / "taken.toml").read_text() == "# of another survey\n")
    # A new file has the earlier amendments too.
    run(*amend, "--all", "--out", day / "other.toml")
    demand("with --out the earlier amendments are kept and the survey names the new file",
           (day / "other.toml").read_text().startswith("# earlier\n") and 'amendments = "other.toml"' in survey.read_text())
