"""RMS of Error_1 of the published method over the 16 steady occupations of simulated days."""

from programs import BIN, IS_LONG, IS_SANITIZED, Scratch, demand, rms, rows, run

# Seeds 1-20 with A351_LONG=1, else 1-2, and seed 1 only under sanitizers.
seeds = range(1, 21) if IS_LONG else range(1, 2 if IS_SANITIZED else 3)

with Scratch() as scratch:
    values = []
    for seed in seeds:
        root = scratch / f"day-{seed}"
        run(BIN / "a351-sim", "survey", "--scenario", "tsukuba", "--seed", seed, "--out", root)
        run(BIN / "a351-correct", "survey", root / "survey.toml", "--model", "paper", "--flags", "use", "--out",
            root / "result")
        errors = [float(row["reference_mgal"]) - float(row["corrected1_mgal"])
                  for row in rows(root / "result" / "occupations.csv") if row["used"] == "1"]
        demand(f"seed {seed}: 16 steady occupations", len(errors) == 16)
        values.append(rms(errors))
        print(f"seed {seed}: RMS of Error_1 {values[-1]:.3f} mGal (in sample)")
        run("rm", "-rf", root)
    mean = sum(values) / len(values)
    demand(f"mean RMS over {len(values)} seeds {mean:.3f} mGal, must be 1.5 to 3.0", 1.5 <= mean <= 3.0)
