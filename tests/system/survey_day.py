"""Compares a simulated survey day with the truth, after emulator, pseudo-terminal, daemon, archive and corrector."""

import itertools
import re

from programs import IS_SANITIZED, TOP, Scratch, compare_truth, demand, events_of, instant, read_json, rows, run

scenario = "tsukuba"
# Sanitized programs run several times slower: a shorter day at a lower speed.
speed = "150" if IS_SANITIZED else "1000"


def shorter(day, name):
    """Writes a scenario with the first occupations of the day and returns its file."""
    stays = (("No.0", 1, "2017-07-15T23:42:00Z"), ("No.12", 1, "2017-07-16T00:40:00Z"),
             ("No.0", 2, "2017-07-16T01:13:00Z"), ("No.1", 1, "2017-07-16T02:11:00Z"))
    day.write_text(f'base = "{name}"\nname = "{name}-shorter"\n' + "".join(
        f'[[occupation]]\nsite = "{site}"\nnumber = {number}\ncentre_utc = "{centre}"\nambient_degc = 25\n'
        for site, number, centre in stays))
    return day


def words_at_stops(written):
    """Returns the words of the list in demo.txt."""
    part = written.split("The signal at each stop:\n")[1].split("\n\n")[0]
    return re.findall(r"\): ([a-z_]+)$", part, re.M)


def logged_words(root):
    """Returns the words of the signal in the event log without LOOK, and the time from each word to the next."""
    events = sorted((instant(event["utc"]), event["word"]) for event in events_of(root) if event["type"] == "signal")
    lengths_s = [(after - before).total_seconds() for (before, _), (after, _) in zip(events, events[1:])]
    return [word for word, _ in itertools.groupby(word for _, word in events if word != "look")], lengths_s


with Scratch() as scratch:
    out = scratch / "day"
    if IS_SANITIZED:
        scenario = shorter(scratch / "shorter.toml", scenario)
    demo = run(TOP / "sim" / "demo", scenario, "--seed", "7", "--speed", speed, "--out", out)
    print(demo.stdout)
    expected = 4 if IS_SANITIZED else 19
    demand("the demo ends with at most 15 lines", len(demo.stdout.splitlines()) <= 15)
    out_of_sample = r"(\d+\.\d+|-)" if IS_SANITIZED else r"\d+\.\d+"  # Four readings can be too few for this error.
    for method in (f"a351, {expected} readings", "the publication's method, [0-9]+ readings"):
        demand(f"the demo prints errors in and out of sample: {method}",
               re.search(rf"^  {method} +\d+\.\d+ +{out_of_sample}", demo.stdout, re.M))
    written = (out / "demo.txt").read_text()
    demand("demo.txt has the RMS of Error_1 of the day", "RMS of Error (1), before the drift step: " in written)
    demand("demo.txt has a table with the simulated truth", "Comparison with the simulated truth" in written)
    demand(f"all {expected} occupations are in the table", len(rows(out / "result" / "occupations.csv")) == expected)
    words = words_at_stops(written)
    demand(f"demo.txt has the signal at each stop: {words}", len(words) == expected)
    demand(f"{words.count('go')} stops were after YOU CAN GO", words.count("go") >= expected - 1)
    logged, lengths_s = logged_words(out / "data")
    stays = logged.count("keep_off")
    # A stay lasts 0.6 s of the host: a loaded host can press Start when its plan is already complete.
    demand(f"the log has {len(logged)} words, two for each of {stays} stays, however fast time runs",
           expected - 1 <= stays <= expected + 1 and 2 * stays <= len(logged) <= 2 * stays + 2 and min(lengths_s) >= 5)

    channels = compare_truth(out / "data" / "archive", out / "truth.bin")
    for name, counted in channels.items():
        demand(f"{name}: none of {counted['truth']:.0f} samples is missing",
               counted["missing"] == 0 and counted["matched"] == counted["truth"])
        demand(f"{name}: no record boundary steps by more than 15 ms", counted["steps"] == 0)

    report = read_json(out / "report.json")
    print("emulator:", report)
    if not IS_SANITIZED:
        ratio = report["mean_rate_real_hz"] / (50.0 * float(speed))
        demand(f"mean rate at {speed}x is {100 * ratio:.2f} % of nominal, must be at least 95", ratio >= 0.95)
