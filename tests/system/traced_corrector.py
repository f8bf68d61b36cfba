"""The corrector that the daemon starts, with a trace: for each run its output, and the sizes of all files of the root before and after.

Files of a root only grow, so any state that the root had during a run can be made again later: a copy, cut to the sizes of that instant.
"""

import pathlib
import shutil
import struct
import subprocess

from programs import BIN

PREAMBLE, CHUNK_HEAD = 12, 13  # Bytes: protocol/journal/journal-format.md.
PROGRAM = """#!/bin/sh
# The daemon calls: a351-correct survey ROOT ...
run={trace}/$(date +%s%N)
sizes() {{ (cd "$1" && find . -type f -printf '%s %P\\n'); }}
mkdir "$run"
sizes "$2" > "$run/before"
{corrector} "$@" > "$run/output"
status=$?
sizes "$2" > "$run/after"
cat "$run/output"
exit $status
"""


def sizes(file):
    return {name: int(size) for size, name in (line.split(" ", 1) for line in file.read_text().splitlines())}


def chunk_ends(data, begin):
    """Returns the ends of the chunks of a journal segment that are behind a size."""
    at, ends = PREAMBLE, []
    while at + CHUNK_HEAD <= len(data):
        at += CHUNK_HEAD + struct.unpack_from("<I", data, at)[0]
        if begin < at <= len(data):
            ends.append(at)
    return ends


class TracedCorrector:
    def __init__(self, scratch):
        """Puts the daemon and the corrector with its trace into a folder of their own."""
        self.scratch, self.trace = scratch, scratch / "trace"
        self.trace.mkdir()
        (scratch / "bin").mkdir()
        self.daemon = pathlib.Path(shutil.copy(BIN / "a351d", scratch / "bin"))
        (scratch / "bin" / "a351-correct").write_text(PROGRAM.format(trace=self.trace, corrector=BIN / "a351-correct"))
        (scratch / "bin" / "a351-correct").chmod(0o755)

    def states(self, before, after):
        """Yields a copy of the root in each state between two, the oldest first: archive and logs as before or after, with the
        journal cut at each of its chunks between."""
        copy = self.scratch / "copy"
        for others in (before, after):
            shutil.rmtree(copy, ignore_errors=True)
            grown = []
            for name in sorted(after):
                is_journal = name.startswith("journal/")
                data = (self.scratch / "data" / name).read_bytes()[:(after if is_journal else others).get(name, 0)]
                least = before.get(name, 0) if is_journal else len(data)
                if least > 0 or name in others:
                    (copy / name).parent.mkdir(parents=True, exist_ok=True)
                    (copy / name).write_bytes(data[:least])
                if least < len(data):
                    grown.append((copy / name, data, chunk_ends(data, least)))
            yield copy
            for file, data, ends in grown:
                for end in ends:
                    file.write_bytes(data[:end])
                    yield copy

    def compare(self, document):
        """Runs the corrector on copies of the root, one for each state that it had during the run that printed the document.

        @return number of copies until one gave the same bytes, or None if none did
        """
        run = next(one for one in sorted(self.trace.iterdir(), reverse=True)
                   if (one / "after").exists() and (one / "output").read_bytes() == document)
        for count, copy in enumerate(self.states(sizes(run / "before"), sizes(run / "after")), 1):
            answer = subprocess.run([BIN / "a351-correct", "survey", copy, "--sites", self.scratch / "sites.csv", "--json"],
                                    capture_output=True, check=False)
            if answer.stdout == document:
                return count
        return None
