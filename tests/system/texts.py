"""Completeness of the Japanese catalogue: every text of the sources is in it and translated, none is left over or marked fuzzy, and
both languages have the same places for arguments.  Then the programs themselves: they answer in the language of the environment,
without installed locales, and their machine-readable output stays the same.
"""

import re
import subprocess
import sys

from programs import BIN, TOP, Scratch, demand, read_json, run

check = subprocess.run([TOP / "protocol" / "text" / "update_catalogue.py", "--check"], capture_output=True, text=True)
if check.returncode != 0:
    print(check.stdout, check.stderr, sep="\n")
    sys.exit("the catalogue does not agree with the sources: CONTRIBUTING.md, \"A new text\"")
print(check.stdout.strip())

answers = {}
for language, variables in (("en", {"A351_LANG": "en"}), ("ja", {"A351_LANG": "ja"}), ("locale", {"A351_LANG": "", "LC_ALL": "ja_JP.UTF-8"}),
                            ("unknown", {"A351_LANG": "", "LC_ALL": "fr_FR.UTF-8"})):
    answers[language] = run(BIN / "a351ctl", "--url", "http://127.0.0.1:9", "note", "x", check=False, env=variables).stderr
    print(f"{language}: {answers[language].strip()}")
demand("English and Japanese differ", answers["en"] != answers["ja"])
demand("A351_LANG and the locale give the same text", answers["ja"] == answers["locale"])
demand("a language without a catalogue is English", answers["en"] == answers["unknown"])


def rows_of_english(text):
    """Returns the rows of four English words in a text."""
    return re.findall(r"[A-Za-z]{2,}(?:[ ,]+[a-z]{2,}){3,}", text)


def english_phrases(page):
    """Returns those in a page, except those of figures and of the settings of result.json beside it."""
    text = re.sub(r"<(style|svg|pre|title)\b.*?</\1>|<[^>]+>", "\n", page.read_text(), flags=re.DOTALL)
    settings = str(read_json(page.parent / "result.json").get("settings"))
    return [row for row in rows_of_english(text) if row not in settings]


with Scratch() as scratch:
    run(BIN / "a351-sim", "survey", "--scenario", "tsukuba", "--seed", 3, "--out", "day", cwd=scratch)
    said = {language: run(BIN / "a351-correct", "survey", "day/survey.toml", "--out", language, "--verbose", cwd=scratch,
                          env={"A351_LANG": language}).stdout for language in ("en", "ja")}
    demand(f"the terminal is in Japanese {rows_of_english(said['ja'])}", "測定点" in said["ja"] and "Station" not in said["ja"] and
           not rows_of_english(said["ja"]))
    differing = {file.name for file in (scratch / "en").iterdir()
                 if file.is_file() and file.read_bytes() != (scratch / "ja" / file.name).read_bytes()}
    demand(f"only the report depends on the language, not JSON and CSV: {differing}", differing == {"report.html"})
    report = (scratch / "ja" / "report.html").read_text()
    demand("the report is in Japanese", 'lang="ja"' in report and "補正" in report and "Corrections" not in report)
    rows = english_phrases(scratch / "ja" / "report.html")
    demand(f"no sentence of it is in English: {rows}", not rows)

    run(BIN / "a351-sim", "survey", "--scenario", "indoor", "--seed", 1, "--out", "night", cwd=scratch)
    for language in ("en", "ja"):
        run(BIN / "a351-correct", "record", "night", "--out", f"night-{language}", cwd=scratch, env={"A351_LANG": language})
    rows = english_phrases(scratch / "night-ja" / "record.html")
    demand(f"no sentence of a long record is in English: {rows}", not rows)
    demand("the results of a long record are the same in both languages", all(
        (scratch / "night-en" / name).read_bytes() == (scratch / "night-ja" / name).read_bytes() for name in ("result.json", "record.csv")))
