"""Compiles the programs of this folder as one: legal with A351_LEGAL defined (the control), each one wrong without it.

    compile_fail.py COMPILER [OPTIONS...]

Without A351_LEGAL the compiler must report an error between #else and #endif of each file.
"""

import os
import pathlib
import re
import subprocess
import sys

FOLDER = pathlib.Path(__file__).resolve().parent


def errors(*options):
    """Returns the lines with errors of each file, and what the compiler said."""
    together = "".join(f'#include "{file}"\n' for file in sorted(FOLDER.glob("*.cpp")))
    said = subprocess.run([*sys.argv[1:], "-fsyntax-only", "-x", "c++", *options, "-"], input=together,
                          stderr=subprocess.PIPE, text=True, env={**os.environ, "LC_ALL": "C"}).stderr
    lines = {}
    for name, line in re.findall(r"(\w+)\.cpp:(\d+):\d+: error:", said):
        lines.setdefault(name, []).append(int(line))
    return lines, said


def is_wrong(file, lines):
    text = file.read_text().splitlines()
    return any(text.index("#else") < line - 1 < text.index("#endif") for line in lines)


legal, said = errors("-DA351_LEGAL")
if " error: " in said:
    sys.exit(f"The control does not compile:\n{said}")
wrong, said = errors()
programs = sorted(FOLDER.glob("*.cpp"))
compiled = [file.stem for file in programs if not is_wrong(file, wrong.get(file.stem, []))]
print(f"{len(programs)} wrong programs; compiled: {compiled or 'none'}")
if compiled or not programs:
    sys.exit(said)
