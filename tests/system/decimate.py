"""`decimate`: memory must not grow with the record, from a file or a pipe, and the values must be SciPy's."""

import math
import re
import subprocess

from programs import BIN, IS_LONG, IS_SANITIZED, Scratch, demand, rows, run

HOUR = 180_000  # Samples at 50 Hz.
BLOCK = [980665.0 + 100.0 * math.sin(i / 7.0) + 10.0 * math.sin(0.002 * i) for i in range(50_000)]
BLOCK_TEXT = "".join(f"{value!r}\n" for value in BLOCK).encode()


def decimate_pipe(count, output):
    """Decimates at least `count` samples from a pipe; returns peak memory in KiB, and written and expected rows."""
    command = [BIN / "a351-correct", "decimate", "--input", "/dev/stdin", "--column", "a", "--factor", "10",
               "--stages", "2", "--output", output]
    program = subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE)
    program.stdin.write(b"a\n")
    blocks = -(-count // len(BLOCK))
    for _ in range(blocks):
        program.stdin.write(BLOCK_TEXT)
    _, said = program.communicate()
    demand("the program ends with status 0", program.returncode == 0)
    print(said.decode().strip())
    memory = int(re.search(rb"peak memory (\d+) KiB", said).group(1))
    return memory, len(rows(output)), -(-blocks * len(BLOCK) // 100)


with Scratch() as scratch:
    short, _, _ = decimate_pipe(HOUR, scratch / "short.csv")
    hours = 168 if IS_LONG else 10
    memory, written, expected = decimate_pipe(hours * HOUR, scratch / "long.csv")
    demand(f"{hours} h give {written} values, expected {expected}", written == expected)
    demand(f"{hours} h need {memory - short:+d} KiB more memory than one hour, limit 1024",
           IS_SANITIZED or memory <= short + 1024)

    (scratch / "block.csv").write_bytes(b"a\n" + BLOCK_TEXT)
    arguments = ["decimate", "--input", scratch / "block.csv", "--column", "a", "--factor", "10"]
    printed = run(BIN / "a351-correct", *arguments).stdout
    run(BIN / "a351-correct", *arguments, "--output", scratch / "block10.csv")
    demand("standard output has the same bytes as --output", (scratch / "block10.csv").read_text() == printed)

    try:
        import numpy
        from scipy import signal
    except ImportError:
        print("not compared with SciPy: python3-scipy is not installed")
    else:
        # Nine zeros before the filter delay it by 50 samples in total, so that output k + 5 is centred on row 10 k.
        taps = numpy.concatenate([numpy.zeros(9), signal.firwin(83, 0.1, window="hamming")])
        peer = signal.upfirdn(taps, numpy.array(BLOCK) - 980665.0, 1, 10)
        table = rows(scratch / "block10.csv")
        worst = max(abs(float(row["value"]) - 980665.0 - peer[int(row["index"]) + 5])
                    for row in table if row["valid"] == "1")
        count = sum(row["valid"] == "1" for row in table)
        print(f"{count} values, largest difference from SciPy's upfirdn {worst:.2e}; the signal's amplitude is 100")
        demand(f"the values differ from SciPy's by at most {worst:.1e}, limit 2e-9 (2e-15 of 980665)",
               worst < 2e-9 and count == 4991)
