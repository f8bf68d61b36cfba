"""The manual pages list exactly the options of --help; the pages of a351-correct and a351-sim do so for each subcommand.

The pages of the configuration, the survey file, the scenario and the file of faults list exactly the keys that the parser
accepts; the page of the HTTP interface names every path.
"""

import re
import tomllib

from programs import BIN, TOP, Scratch, demand, run

PAGES = {
    "a351d": ("daemon/a351d.1", []),
    "a351ctl": ("daemon/ctl/a351ctl.1",
                ["status", "start", "stop", "setup", "discard", "restore", "resume", "not-moved", "checked", "rename", "retime", "note",
                 "sites", "site add", "list", "survey", "bundle"]),
    "a351-stream": ("daemon/stream/a351-stream.1", []),
}
OPTION = r"(?<![\w-])--[a-z][a-z0-9-]*"
INSTALLED = (TOP / "config" / "CMakeLists.txt").read_text()


def offered_options(help_text):
    return set(re.findall(OPTION, "\n".join(line for line in help_text.splitlines() if line.lstrip().startswith("-"))))


def demand_words(name, help_text):
    """CLI11 2.4 (Debian 13) ends a program whose positional argument is not one word; 2.1 (Debian 12) does not."""
    named = re.findall(r"^  (\S.*?)(?:  |$)", help_text.partition("\nPositionals:\n")[2].split("\n\n")[0], re.M)
    others = [one for one in named if re.fullmatch(r"[A-Z]+( DIR| :PATH\(existing\))?( \.\.\.)?( REQUIRED)?", one) is None]
    demand(f"positional arguments of {name} are words: {', '.join(named) or 'none'}", not others and (named or name != "rename"))


def demand_same(what, page, described, accepted):
    demand(f"{what}: missing in {page}: {sorted(accepted - described) or 'none'}; there, but do not exist: "
           f"{sorted(described - accepted) or 'none'}", accepted == described)


def text_of(page):
    return page.read_text().replace("\\-", "-")


def section_of(page_text, title):
    return page_text.split(f"\n{title}\n")[1].split("\n.SH ")[0].split("\n.SS ")[0]


def entries_of(section):
    """Returns the keys of the entries, each the line after .TP: `.B key` or `.BR key1 ", " key2`."""
    heads = re.findall(r'^\.TP\n\.[BI]+R? (.*)$', section, re.M)
    return {word for head in heads for word in re.findall(r"[a-z][a-z0-9_]*", re.sub('"[^"]*"', " ", head))}


def pages_of_subcommands(program, folder, commands_folder):
    """Checks the overview of a program and the page of each of its subcommands."""
    help_text = run(BIN / program, "--help").stdout
    commands = re.findall(r"^  ([a-z]+) ", help_text.split("\nSubcommands:\n")[1], re.M)
    overview = folder / f"{program}.1"
    helps = {overview: (program, help_text)} | {
        commands_folder / f"{program}-{command}.1": (f"{program} {command}", run(BIN / program, command, "--help").stdout)
        for command in commands}
    for page, (name, said) in helps.items():
        entries = "\n".join(re.findall(r"^\.TP\n(.*)$", section_of(text_of(page), ".SH OPTIONS"), re.M))
        demand_same(f"options of {name}", page.name, set(re.findall(OPTION, entries)), offered_options(said))
        demand_words(name, said)
        shown = set(re.findall(OPTION, section_of(text_of(page), ".SH SYNOPSIS")))
        demand(f"options in its synopsis, all of which exist: {sorted(shown) or 'none'}", shown <= offered_options(said))
    for command in commands:
        demand(f"{overview.name} names {command} and its page",
               f".BR {program}-{command} (1)\n.BR {command} :\n" in text_of(overview))
    demand("every page belongs to a subcommand", set(commands_folder.glob("*.1")) == set(helps) - {overview})
    listed = re.search(rf"foreach\(command IN ITEMS ([a-z ]+)\)\n +install\(FILES \S+/{program}-\$\{{command\}}\.1\s", INSTALLED)
    demand("every page is installed", listed and sorted(listed[1].split()) == sorted(commands))
    demand(f"{program} --version", run(BIN / program, "--version").stdout.startswith(program + " "))


def accepted_keys(command, *texts):
    """Returns all keys that the refusals of `zzz` allow.  A refusal lists the keys that were looked for."""
    keys = set()
    for text in texts:
        with Scratch() as scratch:
            (scratch / "file.toml").write_text(text)
            message = run(*command, cwd=scratch, check=False).stderr
        keys |= set(message.split("allowed: ")[1].strip().split(", ")) - {"zzz"}
    return keys


for program, (page, commands) in PAGES.items():
    helps = [run(BIN / program, *command, "--help").stdout for command in [[]] + [c.split() for c in commands]]
    for name, said in zip([program] + commands, helps):
        demand_words(name, said)
    page_text = text_of(TOP / page)
    lines = [line for line in page_text.splitlines() if line.startswith((".TP", ".B", ".BI", ".BR"))]
    demand_same(f"options of {program}", page, set(re.findall(OPTION, "\n".join(lines))), offered_options("\n".join(helps)))
    for command in commands:
        demand(f"{program}: {page} names {command}", re.search(rf"\b{command}\b", page_text) is not None)
    demand(f"{program} --version", run(BIN / program, "--version").stdout.startswith(program + " "))
pages_of_subcommands("a351-correct", TOP / "corrector", TOP / "corrector" / "command")
pages_of_subcommands("a351-sim", TOP / "sim", TOP / "sim" / "command")
for page in TOP.glob("*/**/*.[57]"):
    demand(f"{page.name} is installed", page.name in INSTALLED)

page = TOP / "daemon" / "page" / "a351d-http.7"
served = set(re.findall(r'"(/(?:api/[a-z_/]+|metrics|live))"', "".join((page.parent / name).read_text() for name in ("api.cpp", "server.cpp"))))
named = set()
for head in re.findall(r"^\.B[IR]? (?:.*?)(/[a-z].*)$", text_of(page), re.M):
    start, _, changes = head.partition(" ")
    path = re.match(r"[a-z_/]+", start)[0]
    named |= {path + change for change in changes.split("|")} if path.endswith("/") else {path}
demand_same("paths of the interface", page.name, named, served)
built = (BIN.parent / "daemon" / "page" / page.name).read_text()
demand(f"the list of fields is in the built page: {built.count('.TP')} entries, {page.read_text().count('.TP')} in its source",
       ".B timing.uncertainty_ms\n" in built and "FIELDS" not in built)
demand("its entries name the row of a field", " Row timing. Metric a351_timing_uncertainty_seconds.\n" in built)

page = TOP / "corrector" / "command" / "a351-survey.toml.5"
for table in ("survey", "prior"):
    listed = page.read_text().split(f"\n[{table}]")[1].split("\n.fi")[0].split("\n[")[0]
    demand_same(f"keys of [{table}]", page.name, set(re.findall(r"^([a-z0-9_]+) = ", listed, re.M)),
                accepted_keys([BIN / "a351-correct", "survey", "file.toml"], f"[{table}]\nzzz = 1\n"))

EXAMPLE = (TOP / "config" / "a351d.toml").read_text()
RECOMMENDED = {"survey.occupation_min": 10, "survey.set_ups": 1}  # The defaults of keys for which the example has a better value.


def demand_limits(key, default, entry, config):
    """Demands that the entry of a number has the default of the example and the range that a refusal names."""
    if not isinstance(default, (int, float)) or isinstance(default, bool):
        return
    table, name = key.split(".")
    with Scratch() as scratch:
        lines = [line for line in config.replace("zzz = 1\n", "").splitlines() if not line.startswith(name + " ")]
        lines.insert(lines.index(f"[{table}]") + 1, f"{name} = 1000000")
        (scratch / "file.toml").write_text("\n".join(lines) + "\n")
        message = run(BIN / "a351d", "--config", "file.toml", "--check-config", cwd=scratch, check=False).stderr
    allowed = re.findall(r"-?[\d.]+", message.split("allowed: ")[1])
    is_required = "Required." in entry
    demand(f"{key}: its entry has {', '.join(allowed)} and {'no default' if is_required else f'the default {default:g}'}",
           all(re.search(rf"(?<![\w.-]){limit}(?!\w|\.\d)", entry) for limit in allowed) and (is_required or re.search(rf"default (?:is )?{default:g}\b|\b{default:g} \(default\)", entry)))


page_text = (TOP / "daemon" / "a351d.toml.5").read_text()
position = "[station]\nlatitude = 36.2\nlongitude = 140.1\nelevation_m = 400.0\n"
for table in ("station", "sensor", "oven", "storage", "page", "survey", "verdict"):
    text = position + "[sensor]\nport = \"p\"\n[storage]\nroot = \"d\"\n"
    header = f"[{table}]\n"
    text = text.replace(header, header + "zzz = 1\n") if header in text else text + header + "zzz = 1\n"
    accepted = accepted_keys([BIN / "a351d", "--config", "file.toml", "--check-config"], text)
    section = re.split(r"^\.S[SH]", page_text.split(f".SS [{table}]")[1], flags=re.M)[0]
    described = dict(re.findall(r"^\.TP\n\.B (\S+)\n((?:(?!\.TP|\.PP).*\n)*)", section, re.M))
    demand_same(f"keys of [{table}]", "a351d.toml.5", set(described), accepted)
    for key, value in tomllib.loads(EXAMPLE).get(table, {}).items():
        demand_limits(f"{table}.{key}", RECOMMENDED.get(f"{table}.{key}", value), described[key].replace("\\-", "-"), text)

page = TOP / "sim" / "command" / "a351-faults.toml.5"
plan_faults = [BIN / "a351-sim", "device", "--link", "sensor", "--oven-link", "oven", "--faults", "file.toml"]
kinds = dict(re.findall(r"^([a-z_]+)\t(?:T\{\n)?(.*)(?:\nT\})?\t", section_of(text_of(page), ".SH KINDS"), re.M))
del kinds["kind"]  # The heading.
demand_same("kinds of faults", page.name, set(kinds), accepted_keys(plan_faults, '[[fault]]\nkind = "zzz"\nat_s = 1\n'))
serial = 'serial_number = "12345678"\n'
instants = {"at_s": "1", "at_utc": '"2017-07-16T00:00:00Z"', "at_frame": "1"}
for kind, keys in kinds.items():
    more = {"other_unit": serial, "change_settings": "output_rate_hz = 100\n"}.get(kind, "")
    texts = [f'[[fault]]\nkind = "{kind}"\n{more}{key} = {instant}\nzzz = 1\n' for key, instant in instants.items()]
    demand_same(f"keys of {kind}", page.name, set(keys.split(", ")) - {""} | {"kind", *instants}, accepted_keys(plan_faults, *texts))
entries = entries_of(section_of(text_of(page), ".SH FAULTS AT AN INSTANT"))
demand_same("keys of [[fault]]", page.name, entries, {"kind", *instants} | {key for keys in kinds.values() for key in keys.split(", ")} - {""})
random = {key.removesuffix("_per_h") for key in accepted_keys(plan_faults, "[random]\nzzz = 1\n")} - {"seed"}
demand("random faults are of all kinds but the three that the page names",
       set(kinds) - random == {"other_unit", "change_settings", "overrun"})

page = TOP / "sim" / "command" / "a351-scenario.toml.5"
plan = [BIN / "a351-sim", "plan", "--scenario", "file.toml", "--out", "plan"]
base = 'base = "tsukuba"\nname = "x"\n'
site = '[[site]]\nname = "s"\nlongitude_deg = 1\nlatitude_deg = 1\naltitude_m = 1\ngravity_mgal = 980000\n'
tables = {
    "[[site]]": [site],
    "[[occupation]]": ['[[occupation]]\nsite = "No.1"\ncentre_utc = "2017-07-16T00:00:00Z"\n'],
    "[[ambient]]": ["[[ambient]]\nat_h = 1\ndegc = 1\n", '[[ambient]]\nat_utc = "2017-07-16T00:00:00Z"\ndegc = 1\n'],
    "[[lid_open]]": ['[[lid_open]]\nsite = "No.1"\noutside_degc = 1\n',
                     '[[lid_open]]\nfrom_utc = "2017-07-16T00:00:00Z"\nto_utc = "2017-07-16T01:00:00Z"\noutside_degc = 1\n'],
    "[schedule]": ["[schedule]\n", '[schedule]\nstart_utc = "2017-07-16T00:00:00Z"\nduration_h = 1\n'],
}
for table, texts in tables.items():
    described = entries_of(section_of(text_of(page), f".SS {table}"))
    demand_same(f"keys of {table}", page.name, described, accepted_keys(plan, *[base + text + "zzz = 1\n" for text in texts]))
others = section_of(text_of(page), ".SS Other tables")
entries = dict(re.findall(r"^\.TP\n\.B \[([a-z_]+)\]\n((?:(?!\.TP).*\n?)*)", others, re.M))
top_level = {"name", "base", *(table.strip("[]") for table in tables)}
demand_same("tables", page.name, top_level | set(entries), accepted_keys(plan, base + "zzz = 1\n"))
for table, text in entries.items():
    named = {word for line in re.findall(r"^\.B[RI]? (.*)$", text, re.M) for word in re.findall(r"\b[a-z]+_[a-z_]+\b", line)}
    # A table that the base lacks must have all its keys; else a missing one is refused before zzz.
    of = base.replace("tsukuba", "double-oven") if table == "outer_oven" else base
    needed = "seed = 1\nplacement_share = 0.5\n" if table == "box" else ""
    accepted = accepted_keys(plan, f"{of}[{table}]\n{needed}zzz = 1\n")
    demand(f"[{table}]: every key that {page.name} names exists: {sorted(named) or 'none'}", named <= accepted)
    if table == "line":
        demand_same("keys of [line]", page.name, named, accepted)


def demand_names(option, command, files):
    """Demands that the files name each value that a refusal of the option allows."""
    said = run(*command, check=False).stderr
    names = re.findall(r"[\w-]+", re.split(r"not in \{|allowed: ", said)[-1].split("; see")[0].replace(", or a file", ""))
    for file in files:
        missing = [name for name in names if not re.search(rf"(?<![\w-]){re.escape(name)}(?![\w-])", re.sub(r"\\f[BIRP]", "", text_of(TOP / file)))]
        demand(f"{file}: names of {option} that it lacks, of {len(names)}: {missing or 'none'}", names and not missing)


demand_names("--model", [BIN / "a351-correct", "table", "--sites", "x", "--observations", "y", "--model", "zzz"],
             ["corrector/command/a351-correct-survey.1", "corrector/command/a351-correct-table.1", "corrector/methods.md", "config/survey.toml"])
demand_names("--scenario", [BIN / "a351-sim", "survey", "--scenario", "zzz", "--out", "x"], ["sim/command/a351-scenario.toml.5"])
demand_names("--profile", [BIN / "a351-sim", "device", "--profile", "zzz", "--link", "x"],
             ["daemon/a351d.toml.5", "config/a351d.toml", "corrector/command/a351-correct-retime.1",
              *(f"sim/command/a351-sim-{command}.1" for command in ("device", "replay", "survey"))])
