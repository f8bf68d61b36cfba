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
PATH={path}:{BIN}:$PATH COMP_WORDS=({quoted}) COMP_CWORD={len(words) - 1} COMP_LINE='{" ".join(words).replace(" : ", ":").replace(" :", ":").replace(": ", ":")}'
_a351 {words[0]} '{words[-1]}' '{words[-2]}'; printf '%s\\n' "${{COMPREPLY[@]}}"
"""
    return run("bash", "-c", script, cwd=path).stdout.strip("\n").split("\n")


with Scratch() as scratch:
    fake = scratch / "a351ctl"
    fake.write_text(f"""#!/bin/sh
[ "$1" = --url ] && echo "$2" >>asked && shift 2
case $1 in
sites) cat <<'END'
{SITES}END
;;
list) echo 20260301T041000Z; echo 20260301T041000Z;;
*) exec {BIN}/a351ctl "$@";;
esac
""")
    os.chmod(fake, stat.S_IRWXU)
    (scratch / "list.csv").write_text("site,gravity_mgal\nNo.0,1\nMt Tsukuba,\n")
    (scratch / "emd.csv").write_text("time,value\r\n1,2\r\n")
    (scratch / "data" / "archive" / "2026" / "XX" / "A351" / "BNZ.D").mkdir(parents=True)
    for words, expected in (
            (("a351ctl", "sto"), ["stop"]),
            (("a351ctl", "site", ""), ["add"]),
            (("a351ctl", "start", "N"), ["No.1"]),
            (("a351ctl", "start", "Mt"), ["Mt Tsukuba"]),
            (("a351ctl", "start", "Mt\\ T"), ["Mt Tsukuba"]),
            (("a351ctl", "rename", '"Mt T'), ["Mt Tsukuba"]),
            (("a351ctl", "start", "$"), ["$(id)"]),
            (("a351ctl", "start", "--operator", "km", "Mt"), ["Mt Tsukuba"]),
            (("a351ctl", "--url", "http", ":", "//h", ":", "8", "sto"), ["stop"]),
            (("a351ctl", "--url", "http", ":", "//h", ":", "8", "start", "N"), ["No.1"]),
            (("a351ctl", "site", "add", "x", "--lat"), ["--latitude"]),
            (("a351ctl", "rename", "2"), ["20260301T041000Z"]),
            (("a351ctl", "rename", "20260301T041000Z", "N"), ["No.1"]),
            (("a351ctl", "retime", "20260301T041000Z", "--fr"), ["--from"]),
            (("a351ctl", "note", "--stay", "2"), ["20260301T041000Z"]),
            (("a351-correct", "survey", "--mo"), ["--model"]),
            (("a351-correct", "survey", "--model", "net"), ["network"]),
            (("a351-correct", "survey", "--model", "=", "net"), ["network"]),
            (("a351-correct", "survey", "--model", "="), ["auto", "paper", "day", "t", "t-rate", "t-drift", "t-rate-drift",
                                                          "t-rate-drift-axes", "drift", "network"]),
            (("a351-correct", "survey", "--tide", "l"), ["longman"]),
            (("a351-correct", "survey", "--tide-system", ""), ["tide-free", "zero", "mean"]),
            (("a351-correct", "import", "--tide", ""), ["keep", "remove"]),
            (("a351-correct", "import", "--average", "me"), ["median", "mean"]),
            (("a351-correct", "table", "--sites", "list.csv", "--base", "Mt"), ["Mt Tsukuba"]),
            (("a351-correct", "table", "--sites", "=", "list.csv", "--datum", "N"), ["No.0"]),
            (("a351-correct", "emd", "--input", "emd.csv", "--column", ""), ["time", "value"]),
            (("a351-sim", "replay", "--speed", "m"), ["max"]),
            (("a351-correct", "tide", "--model", "di"), ["direct"]),
            (("a351-correct", "export", "data", "--channel", "B"), ["BNZ"]),
            (("a351-stream", "data", "ring.example", "--st"), ["--state"]),
            (("a351-sim", "survey", "--scenario", "t"), ["three-links", "tilt-series", "tilted", "transport-step", "tsukuba", "tumble"]),
            (("a351-sim", "device", "--profile", "A3"), ["A351", "A352AD10", "A370AD10"]),
            (("a351-correct", "retime", "data", "--profile", "A37"), ["A370AD10"])):
        offered = completed(scratch, *words)
        demand(f"{' '.join(words)} offers {expected}: {offered}", offered == expected)
    demand("sites are asked of the daemon at --url", (scratch / "asked").read_text() == "http://h:8\n")
