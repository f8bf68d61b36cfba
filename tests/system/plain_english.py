"""Texts that people read are in plain international English: words and openings of the old dialect do not come back.

Read for words: --help of every program, manual pages, pages in Markdown, the page in the browser, and every string of the
programs' sources.  Read for openings: help texts and comments, which begin with a noun phrase or a verb.
"""

import re

from programs import BIN, TOP, demand, run

# Word or phrase, and the plain word to use instead.  `stands for` is allowed.
WORDS = {
    r"anew": "again",
    r"(?:stands|stood)(?! for\b)": "is",
    r"told": "reported, shown, given",
    r"tells": "shows, reports, says",
    r"go(?:es)? on|went on|going on": "continues",
    r"pass(?:ed|es) over": "skipped",
    r"mend(?:ed|s)?": "repaired",
    r"(?:held|holds?) up": "delayed",
    r"for who": "for callers that",
    r"behind it": "after it",
    r"heard": "received",
    r"so (?:often|long)(?! as\b)(?=[,.;]|$)": "how often, how long, in full",
}
DIALECT = re.compile(r"(?<![\w-])(?:" + "|".join(WORDS) + r")(?![\w-])", re.IGNORECASE)
OPENING = re.compile(r"(?:Of|What|Whether|Such|So|By|That|Who|Told)\b(?! (?:that|is)\b)")

SOURCES = [folder + "/**/*.[ch]pp" for folder in ("protocol", "daemon", "sim", "corrector")]
PAGES = ["**/*.[157]", "README.md", "CONTRIBUTING.md", "CHANGELOG.md", "protocol/**/*.md", "daemon/**/*.md",
         "sim/**/*.md", "corrector/**/*.md", "daemon/page/**/*.html", "daemon/page/**/*.js", "sim/demo", "sim/relive", "config/*.toml", "config/install-packages"]
TOKEN = re.compile(r"""//[^\n]*|/\*.*?\*/|R"(\w*)\((.*?)\)\1"|"((?:[^"\\\n]|\\.)*)"|'(?:[^'\\\n]|\\.)+'""", re.DOTALL)


def files(patterns):
    found = sorted({path for pattern in patterns for path in TOP.glob(pattern)
                    if path.is_file() and path.relative_to(TOP).parts[0] != "build"})
    demand(f"{len(found)} files are read", len(found) > 20)
    return found


def line_of(text, at):
    return text.count("\n", 0, at) + 1


def strings_and_comments(text):
    """Yields line and text of every string, neighbours joined, and of every comment's first line, with its kind."""
    joined, start, end, comment_line = "", 0, -1, -1
    for token in TOKEN.finditer(text):
        line = line_of(text, token.start())
        if token[0].startswith("//"):
            if comment_line != line - 1:
                yield line, "comment", token[0].lstrip("/!<@ ")
            comment_line = line
            continue
        content = token[2] if token[2] is not None else token[3]
        if content is None:
            continue
        if joined and text[end:token.start()].strip() == "":
            joined += content
        else:
            if joined:
                yield line_of(text, start), "string", joined
            joined, start = content, token.start()
        end = token.end()
    if joined:
        yield line_of(text, start), "string", joined


def dialect_of(text):
    return [match[0] for match in DIALECT.finditer(text)]


found, texts = [], 0
for path in files(SOURCES):
    for line, kind, text in strings_and_comments(path.read_text()):
        texts += 1
        if kind == "string":
            found += [f"{path.relative_to(TOP)}:{line}: {word}" for word in dialect_of(text.replace("\\n", " "))]
        elif opening := OPENING.match(text):
            found.append(f"{path.relative_to(TOP)}:{line}: a comment begins with {opening[0]}")
for path in files(PAGES):
    for number, line in enumerate(path.read_text().splitlines(), 1):
        texts += 1
        found += [f"{path.relative_to(TOP)}:{number}: {word}" for word in dialect_of(line)]
for program in ("a351d", "a351ctl", "a351-stream", "a351-sim", "a351-correct"):
    overview = run(BIN / program, "--help").stdout
    commands = re.findall(r"^  ([a-z]+) ", overview.split("Subcommands:\n")[1], re.M) if "Subcommands:\n" in overview else []
    for command in [[], *([one] for one in commands)]:
        said = run(BIN / program, *command, "--help").stdout
        name = " ".join([program, *command, "--help"])
        texts += len(said.splitlines())
        found += [f"{name}: {word}" for word in dialect_of(said)]
        found += [f"{name}: {text} begins with {opening[0]}" for text in re.findall(r"^ .*?  +([A-Z].*)$", said, re.M)
                  if (opening := OPENING.match(text))]
        found += [f"{name}: the argument of {option} is TEXT; name its kind" for option in re.findall(r"^ +(.*) TEXT\b", said, re.M)]
for trouble in found:
    print(trouble)
demand(f"{texts} texts, {len(found)} that are not plain; instead: "
       + ", ".join(sorted(set(WORDS.values()))), not found)
