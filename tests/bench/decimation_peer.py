"""Compares the time of decimation by ten with that of SciPy's upfirdn and the same filter, alternately on one core.

Promised: at most half of its time.
"""

import json
import subprocess
import sys
import time

from command_line import command_line, end_with
from simulated_units import TOOLS

command_line(__doc__, "decimation_peer.py").parse_args()
try:
    import numpy
    from scipy import __version__ as scipy_version
    from scipy import signal
except ImportError:
    print("skipped: SciPy (python3-scipy) is not installed")
    sys.exit(0)

SAMPLES = 1_000_000
ROUNDS = 5
BENCH = TOOLS / "micro_bench"


def ours_ns():
    """Returns our CPU time per input sample in ns."""
    result = subprocess.run([BENCH, f"--benchmark_filter=decimate_series/{SAMPLES}$", "--benchmark_format=json"],
                            check=True, capture_output=True, text=True)
    return 1e6 * json.loads(result.stdout)["benchmarks"][0]["cpu_time"] / SAMPLES


def peer_ns(samples, taps):
    best = float("inf")
    for _ in range(10):
        before = time.process_time()
        signal.upfirdn(taps, samples, up=1, down=10)
        best = min(best, time.process_time() - before)
    return 1e9 * best / SAMPLES


samples = numpy.sin(numpy.arange(SAMPLES) / 7.0)
taps = signal.firwin(83, 0.1, window="hamming")
pairs = [(ours_ns(), peer_ns(samples, taps)) for _ in range(ROUNDS)]
for ours, peer in pairs:
    print(f"a351 {ours:.2f} ns, SciPy {scipy_version} upfirdn {peer:.2f} ns per sample: {peer / ours:.2f} times")
ours, peer = (min(figures) for figures in zip(*pairs))
print(f"least of each: {ours:.2f} and {peer:.2f} ns: {peer / ours:.2f} times   promised >= 2")
end_with([] if peer >= 2 * ours else ["half of the time of SciPy"])
