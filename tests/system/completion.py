"""bash completes subcommands, options, their values, and names of sites with blanks."""

import os
import stat

from programs import BIN, TOP, Scratch, demand, run

SITES = """site        longitude_deg  latitude_deg
No.1        140.000000     36.000000
Mt Tsukuba  140.100000     36.200000
$(id)       140.100000     36.200000
"""


def completed(path, *words):
    """Returns what bash offers for the last of the words, with `path` before the programs."""
    quoted = " ".join(f"'{word}'" for word in words)
    script = f"""source {TOP}/config/completion/a351
PATH={path}:{BIN}:$PATH COMP_WORDS=({quoted}) COMP_CWORD={len(words) - 1}
_a351 {words[0]} '{words[-1]}' '{words[-2]}'; printf '%s\\n' "${{COMPREPLY[@]}}"
"""
    return run("bash", "-c", script, cwd=path).stdout.strip("\n").split("\n")


with Scratch() as scratch:
    fake = scratch / "a351ctl"
    fake.write_text(f"#!/bin/sh\n[ $1 = sites ] && cat <<'END' || exec {BIN}/a351ctl \"$@\"\n{SITES}END\n")
    os.chmod(fake, stat.S_IRWXU)
    (scratch / "data" / "archive" / "2026" / "XX" / "A351" / "BNZ.D").mkdir(parents=True)
    for words, expected in (
            (("a351ctl", "sto"), ["stop"]),
            (("a351ctl", "site", ""), ["add"]),
            (("a351ctl", "start", "N"), ["No.1"]),
            (("a351ctl", "start", "Mt"), ["Mt Tsukuba"]),
            (("a351ctl", "start", "Mt\\ T"), ["Mt Tsukuba"]),
            (("a351ctl", "rename", '"Mt T'), ["Mt Tsukuba"]),
            (("a351ctl", "start", "$"), ["$(id)"]),
            (("a351-correct", "survey", "--mo"), ["--model"]),
            (("a351-correct", "survey", "--model", "net"), ["network"]),
            (("a351-correct", "survey", "--tide", "l"), ["longman"]),
            (("a351-correct", "tide", "--model", "di"), ["direct"]),
            (("a351-correct", "export", "data", "--channel", "B"), ["BNZ"]),
            (("a351-sim", "survey", "--scenario", "t"), ["tilt-series", "tilted", "tsukuba"]),
            (("a351-sim", "device", "--profile", "A35"), ["A351", "A352AD10"])):
        offered = completed(scratch, *words)
        demand(f"{' '.join(words)} offers {expected}: {offered}", offered == expected)
