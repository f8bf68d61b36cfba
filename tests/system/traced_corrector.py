"""The corrector that the daemon starts, with a trace: for each run its output, and the sizes of all files of the root before and after.

Files of a root only grow, so any state that the root had during a run can be made again later: a copy, cut to the sizes of that instant.
"""

import bisect
import json
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


def as_of(answer):
    """Returns the instant that an answer describes, RFC 3339."""
    return json.loads(answer)["as_of_utc"]


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
        """Returns the states of the root between two, the oldest first, as sizes of its files: the journal cut at each of its chunks
        between, archive and logs as before; then the same with archive and logs as after."""
        all_states = []
        for others in (before, after):
            state = {name: before.get(name, 0) if name.startswith("journal/") else others.get(name, 0) for name in after}
            all_states.append(state)
            for name in sorted(name for name in after if name.startswith("journal/")):
                data = (self.scratch / "data" / name).read_bytes()[:after[name]]
                for end in chunk_ends(data, before.get(name, 0)):
                    state = {**state, name: end}
                    all_states.append(state)
        return all_states

    def answer(self, state):
        """Returns what the corrector prints for a copy of the root in that state."""
        copy = self.scratch / "copy"
        shutil.rmtree(copy, ignore_errors=True)
        for name, size in state.items():
            if size > 0:
                (copy / name).parent.mkdir(parents=True, exist_ok=True)
                (copy / name).write_bytes((self.scratch / "data" / name).read_bytes()[:size])
        return subprocess.run([BIN / "a351-correct", "survey", copy, "--sites", self.scratch / "sites.csv", "--json"],
                              capture_output=True, check=False).stdout

    def compare(self, document):
        """Searches for the state of the root that the corrector saw in the run that printed the document.

        The journal grows from state to state, and with it the instant that the answer describes.  So the first state of that instant
        is found by bisection, and all states of the same instant are tried: with the archive as before, then as after.

        @return number of the state that gave the same bytes, or None if none did
        """
        run = next(one for one in sorted(self.trace.iterdir(), reverse=True)
                   if (one / "after").exists() and (one / "output").read_bytes() == document)
        states = self.states(sizes(run / "before"), sizes(run / "after"))
        half = len(states) // 2
        for begin, end in ((0, half), (half, len(states))):
            first = bisect.bisect_left(states, as_of(document), begin, end, key=lambda state: as_of(self.answer(state)))
            for number in range(first, end):
                answer = self.answer(states[number])
                if answer == document:
                    return number
                if as_of(answer) > as_of(document):
                    break
        return None
