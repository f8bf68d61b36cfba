"""Compares the speed of the decomposition with other programs, if they are installed, and measures the gain of a second thread.

Other programs: R's Rlibeemd (the core of libeemd, the reference) and Python's PyEMD, compiled as installed.  All use the
same sizes, ten sifts, noise 0.1 and one thread; the best CPU time of several runs counts.  The gain of the second thread is
elapsed time, so it is valid on an idle machine only.
"""

import importlib.util
import json
import shutil
import subprocess
import time

from command_line import command_line
from simulated_units import TOOLS

# Samples, members, components with the residue.
SIZES = [(450, 80, 8), (5400, 160, 11), (65536, 100, 16)]

RLIBEEMD = """
library(Rlibeemd)
set.seed(1)
x <- sin(1:{n} / 7) + 0.3 * sin(1:{n} / 1.7) + 0.3 * rnorm({n})
best <- min(sapply(1:3, function(i) system.time(
  eemd(x, num_imfs = {m}, ensemble_size = {members}, noise_strength = 0.1,
       num_siftings = 10, S_number = 0, threads = 1))["user.self"]))
cat(best)
"""


def own_figures():
    command = [TOOLS / "micro_bench", "--benchmark_filter=^((ensemble|ensemble_threads|arithmetic)/|trend_)",
               "--benchmark_repetitions=5", "--benchmark_min_time=0.1", "--benchmark_format=json",
               "--benchmark_enable_random_interleaving=true"]
    report = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout)
    best = {}
    for run in report["benchmarks"]:
        if run["run_type"] == "iteration":
            name = run["run_name"].removesuffix("/real_time")
            figures = best.setdefault(name, {"cpu_ms": run["cpu_time"], "real_ms": run["real_time"]})
            figures["cpu_ms"] = min(figures["cpu_ms"], run["cpu_time"])
            figures["real_ms"] = min(figures["real_ms"], run["real_time"])
    return best


def rlibeemd_seconds(n, members, components):
    if shutil.which("Rscript") is None:
        return None
    script = RLIBEEMD.format(n=n, members=members, m=components)
    run = subprocess.run(["Rscript", "-e", script], capture_output=True, text=True)
    return float(run.stdout) if run.returncode == 0 else None


def pyemd_seconds(n, members, components):
    if importlib.util.find_spec("PyEMD") is None or n > 10000:  # It takes more than half a minute beyond.
        return None
    import numpy
    from PyEMD import EEMD
    signal = numpy.sin(numpy.arange(n) / 7) + 0.3 * numpy.random.default_rng(1).normal(size=n)
    eemd = EEMD(trials=members, noise_width=0.1, parallel=False)
    eemd.EMD.FIXE = 10
    start = time.process_time()
    eemd.eemd(signal, max_imf=components - 1)
    return time.process_time() - start


command_line(__doc__, "eemd_peers.py", has_promises=False).parse_args()
own = own_figures()
loop_ms = own["arithmetic/1"]["cpu_ms"]
print(f"{'one thread, 10 sifts':<24}{'ms':>10}{'/ arithmetic':>16}{'Rlibeemd':>14}{'PyEMD':>14}")
for n, members, components in SIZES:
    milliseconds = own[f"ensemble/{n}/{members}"]["cpu_ms"]
    line = f"{f'{n} x {members}':<24}{milliseconds:>10.1f}{milliseconds / loop_ms:>16.2f}"
    for peer in (rlibeemd_seconds, pyemd_seconds):
        seconds = peer(n, members, components)
        line += f"{'-':>14}" if seconds is None else f"{f'{1e3 * seconds / milliseconds:.1f} times':>14}"
    print(line)
print("promised at 5400 x 160: 7 times as fast as Rlibeemd")
alone, whole = own["trend_alone"]["cpu_ms"], own["trend_of_all_modes"]["cpu_ms"]
print(f"an occupation's trend, 450 x 80: alone {alone:.2f} ms, with all modes {whole:.2f} ms; {whole / alone:.2f} times")
gain = own["ensemble_threads/1"]["real_ms"] / own["ensemble_threads/2"]["real_ms"]
possible = own["arithmetic/1"]["real_ms"] / own["arithmetic/2"]["real_ms"]
print(f"second thread: {gain:.2f} times as fast, independent arithmetic {possible:.2f}; "
      f"ratio {gain / possible:.2f}, promised 0.95")
