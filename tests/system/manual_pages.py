"""The manual pages list exactly the options of --help; the pages of a351-correct do so for each subcommand.

The pages of the configuration and of the survey file list exactly the keys that the parser accepts.
"""

import re

from programs import BIN, TOP, Scratch, demand, run

PAGES = {
    "a351d": ("daemon/a351d.1", []),
    "a351ctl": ("daemon/ctl/a351ctl.1",
                ["status", "watch", "start", "stop", "setup", "discard", "restore", "resume", "not-moved", "rename", "retime", "note", "target",
                 "sites", "list"]),
    "a351-sim": ("sim/a351-sim.1", ["device", "replay", "survey", "plan"]),
}
OPTION = r"(?<![\w-])--[a-z][a-z0-9-]*"


def offered_options(help_text):
    return set(re.findall(OPTION, "\n".join(line for line in help_text.splitlines() if line.lstrip().startswith("-"))))


def demand_options(name, page, described, offered):
    demand(f"{name}: options missing in {page}: {sorted(offered - described) or 'none'}", offered <= described)
    demand(f"{name}: options of {page} that do not exist: {sorted(described - offered) or 'none'}", described <= offered)


def section_of(page_text, title):
    return page_text.split(f"\n.SH {title}\n")[1].split("\n.SH ")[0]


for program, (page, commands) in PAGES.items():
    helps = [run(BIN / program, *command, "--help").stdout for command in [[]] + [[c] for c in commands]]
    page_text = (TOP / page).read_text().replace("\\-", "-")
    lines = [line for line in page_text.splitlines() if line.startswith((".TP", ".B", ".BI", ".BR"))]
    demand_options(program, page, set(re.findall(OPTION, "\n".join(lines))), offered_options("\n".join(helps)))
    for command in commands:
        demand(f"{program}: {page} names {command}", re.search(rf"\b{command}\b", page_text) is not None)
    demand(f"{program} --version", run(BIN / program, "--version").stdout.startswith(program + " "))

help_text = run(BIN / "a351-correct", "--help").stdout
commands = re.findall(r"^  ([a-z]+) ", help_text.split("\nSubcommands:\n")[1], re.M)
folder = TOP / "corrector" / "command"
overview = folder.parent / "a351-correct.1"
helps = {overview: ("a351-correct", help_text)} | {
    folder / f"a351-correct-{command}.1": (f"a351-correct {command}", run(BIN / "a351-correct", command, "--help").stdout)
    for command in commands}
for page, (name, help_text) in helps.items():
    page_text = page.read_text().replace("\\-", "-")
    entries = "\n".join(re.findall(r"^\.TP\n(.*)$", section_of(page_text, "OPTIONS"), re.M))
    demand_options(name, page.name, set(re.findall(OPTION, entries)), offered_options(help_text))
    shown = set(re.findall(OPTION, section_of(page_text, "SYNOPSIS")))
    demand(f"options in its synopsis, all of which exist: {sorted(shown) or 'none'}", shown <= offered_options(help_text))
for command in commands:
    demand(f"{overview.name} names {command} and its page", f".BR a351-correct-{command} (1)\n.BR {command} :\n" in
           overview.read_text().replace("\\-", "-"))
demand("every page belongs to a subcommand", set(folder.glob("*.1")) == set(helps) - {overview})
installed = re.search(r"foreach\(command IN ITEMS ([a-z ]+)\)\n +install\(FILES \S+/a351-correct-\$\{command\}\.1\s",
                      (TOP / "config" / "CMakeLists.txt").read_text())
demand("every page is installed", installed and sorted(installed[1].split()) == sorted(commands))
demand("a351-correct --version", run(BIN / "a351-correct", "--version").stdout.startswith("a351-correct "))

page_text = (folder / "a351-survey.toml.5").read_text()
for table in ("survey", "prior"):
    listed = page_text.split(f"\n[{table}]")[1].split("\n.fi")[0].split("\n[")[0]
    described = set(re.findall(r"^([a-z0-9_]+) = ", listed, re.M))
    with Scratch() as scratch:
        (scratch / "day.toml").write_text(f"[{table}]\nzzz = 1\n")
        message = run(BIN / "a351-correct", "survey", scratch / "day.toml", check=False).stderr
    accepted = set(message.split("allowed: ")[1].strip().split(", ")) - {"zzz"}
    demand(f"[{table}] of the survey file: keys missing on the page: {sorted(accepted - described) or 'none'}; keys that do "
           f"not exist: {sorted(described - accepted) or 'none'}", accepted == described)

page_text = (TOP / "daemon" / "a351d.toml.5").read_text()
position = "[station]\nlatitude = 36.2\nlongitude = 140.1\nelevation_m = 400.0\n"
for table in ("station", "sensor", "oven", "storage", "page", "survey", "verdict"):
    with Scratch() as scratch:
        text = position + "[sensor]\nport = \"p\"\n[storage]\nroot = \"d\"\n"
        header = f"[{table}]\n"
        text = text.replace(header, header + "zzz = 1\n") if header in text else text + header + "zzz = 1\n"
        (scratch / "c.toml").write_text(text)
        message = run(BIN / "a351d", "--config", scratch / "c.toml", "--check-config", check=False).stderr
    accepted = set(message.split("allowed: ")[1].strip().split(", ")) - {"zzz"}
    section = page_text.split(f".SS [{table}]")[1].split(".SS")[0].split(".SH")[0]
    described = {key for line in re.findall(r"^\.B (.*)$", section, re.M) for key in line.split(", ")}
    demand(f"[{table}]: keys missing on the page: {sorted(accepted - described) or 'none'}", accepted <= described)
    demand(f"[{table}]: every key on the page exists", all(key in accepted for key in described))
