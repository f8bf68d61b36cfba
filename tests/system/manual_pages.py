"""The manual pages name every option of --help and no other; a351d.toml(5) every key the parser accepts."""

import re

from programs import BIN, TOP, Scratch, demand, run

PAGES = {
    "a351d": ("daemon/a351d.1", []),
    "a351ctl": ("daemon/ctl/a351ctl.1",
                ["status", "watch", "start", "stop", "setup", "discard", "rename", "note", "target", "sites", "list"]),
    "a351-sim": ("sim/a351-sim.1", ["device", "replay", "survey", "plan"]),
    "a351-correct": ("corrector/a351-correct.1",
                     ["survey", "table", "calibrate", "decimate", "emd", "export", "record", "retime", "smooth", "tide"]),
}

for program, (page, commands) in PAGES.items():
    helps = [run(BIN / program, *command, "--help").stdout for command in [[]] + [[c] for c in commands]]
    offered = set(re.findall(r"(?<![\w-])--[a-z][a-z0-9-]*", "\n".join(
        line for text in helps for line in text.splitlines() if line.lstrip().startswith("-"))))
    page_text = (TOP / page).read_text().replace("\\-", "-")
    lines = [line for line in page_text.splitlines() if line.startswith((".TP", ".B", ".BI", ".BR"))]
    described = set(re.findall(r"(?<![\w-])--[a-z][a-z0-9-]*", "\n".join(lines)))
    demand(f"{program}: {page} describes {sorted(offered - described) or 'all options'}",
           offered <= described)
    demand(f"{program}: {page} invents {sorted(described - offered) or 'no option'}", described <= offered)
    for command in commands:
        demand(f"{program}: {page} names {command}", re.search(rf"\b{command}\b", page_text) is not None)
    demand(f"{program} --version", run(BIN / program, "--version").stdout.startswith(program + " "))

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
    demand(f"[{table}]: the page describes {sorted(accepted)}", accepted <= described)
    demand(f"[{table}]: the page invents no key", all(key in accepted for key in described))
