"""a351-correct decimate: memory does not grow with the record, from a file or a pipe; the values are SciPy's."""

import math
import re
import subprocess

from programs import BIN, IS_LONG, IS_SANITIZED, Scratch, demand, rows, run

HOUR = 180_000  # samples at 50 Hz
BLOCK = [980665.0 + 100.0 * math.sin(i / 7.0) + 10.0 * math.sin(0.002 * i) for i in range(50_000)]
BLOCK_TEXT = "".join(f"{value!r}\n" for value in BLOCK).encode()


def decimate_pipe(count, output):
    """Peak memory in KiB and rows written, for at least `count` samples through a pipe."""
    command = [BIN / "a351-correct", "decimate", "--input", "/dev/stdin", "--column", "a", "--factor", "10",
               "--stages", "2", "--output", output]
    program = subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE)
    program.stdin.write(b"a\n")
    blocks = -(-count // len(BLOCK))
    for _ in range(blocks):
        program.stdin.write(BLOCK_TEXT)
    _, said = program.communicate()
    demand("it ends well", program.returncode == 0)
    print(said.decode().strip())
    memory = int(re.search(rb"peak memory (\d+) KiB", said).group(1))
    return memory, len(rows(output)), -(-blocks * len(BLOCK) // 100)


with Scratch() as scratch:
    short, _, _ = decimate_pipe(HOUR, scratch / "short.csv")
    hours = 168 if IS_LONG else 10
    memory, written, expected = decimate_pipe(hours * HOUR, scratch / "long.csv")
    demand(f"{hours} h give {expected} values", written == expected)
    demand(f"{hours} h take within 1 MiB of what one takes", IS_SANITIZED or memory <= short + 1024)

    (scratch / "block.csv").write_bytes(b"a\n" + BLOCK_TEXT)
    arguments = ["decimate", "--input", scratch / "block.csv", "--column", "a", "--factor", "10"]
    printed = run(BIN / "a351-correct", *arguments).stdout
    run(BIN / "a351-correct", *arguments, "--output", scratch / "block10.csv")
    demand("standard output has the bytes of --output", (scratch / "block10.csv").read_text() == printed)

    try:
        import numpy
        from scipy import signal
    except ImportError:
        print("not compared with SciPy: python3-scipy is not installed")
    else:
        # Nine zeros more before its filter delay it by 50 samples: output k + 5 is centred on row 10 k.
        taps = numpy.concatenate([numpy.zeros(9), signal.firwin(83, 0.1, window="hamming")])
        peer = signal.upfirdn(taps, numpy.array(BLOCK) - 980665.0, 1, 10)
        table = rows(scratch / "block10.csv")
        worst = max(abs(float(row["value"]) - 980665.0 - peer[int(row["index"]) + 5])
                    for row in table if row["valid"] == "1")
        count = sum(row["valid"] == "1" for row in table)
        print(f"{count} values, farthest from SciPy's upfirdn: {worst:.2e} of a swing of 100")
        demand("they are SciPy's to rounding (2e-15 of 980665)", worst < 2e-9 and count == 4991)
