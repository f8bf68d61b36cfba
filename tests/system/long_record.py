"""`record` on a simulated night: with the same bytes from root and day file; bad input is refused."""

import json

from programs import BIN, Scratch, demand, refused, run


def record(folder, *arguments):
    return run(BIN / "a351-correct", "record", *arguments, cwd=folder)


with Scratch() as scratch:
    run(BIN / "a351-sim", "survey", "--scenario", "indoor", "--seed", "1", "--out", scratch / "night")
    text = record(scratch, "night", "--out", "a").stdout
    record(scratch, next((scratch / "night" / "archive").rglob("*BNZ.D.*")), "--out", "b")
    result = json.loads((scratch / "a" / "result.json").read_text())
    statistics = result["statistics"]
    print(f"one segment of {result['segments'][0]['samples']} samples, "
          f"negative peak after {statistics['band_negative_delay_s']:.0f} s")
    demand("the night is one segment of 12 h without the filters' ends, and the tide is removed",
           [s["samples"] for s in result["segments"]] == [2151] and result["tide_removed"])
    demand(f"the acceleration follows the temperature with opposite sign after {statistics['band_negative_delay_s']:.0f} s, "
           "must be 220 to 300", 220 < statistics["band_negative_delay_s"] < 300 and "rate of change" in text)
    demand("the response at the period of the oven's cycle is determined", any(
        p["refused"] is None and 800 < p["period_s"] < 1000 for p in result["response_by_spectrum"]))
    noise = result["noise"]["data_sheet_mgal_per_sqrt_hz"]
    line = (scratch / "a" / "figures" / "noise-spectrum.dat").read_text().split("# data sheet")[1].split("\n\n")[0].split()
    demand(f"the spectrum has the noise of the profile's data sheet, {noise:.4f} mGal / sqrt(Hz): 0.2 micro-g",
           abs(noise - 0.2 * 0.980665) < 1e-12 and abs(float(line[-1]) - noise) < 1e-6)
    same = [(scratch / "a" / f).read_bytes() == (scratch / "b" / f).read_bytes()
            for f in ("record.csv", "response.csv", "result.json", "record.html", "figures/response.svg")]
    demand("a day file gives the same bytes as its data root", all(same))

    other = record(scratch, "night", "--mode", "6", "--out", "f").stdout
    periods = {json.loads((scratch / folder / "result.json").read_text())["temperature_mode"]["period_s"] for folder in "af"}
    demand("another mode is compared on demand, with its own period",
           "modes: temperature 6 of 10" in other and "acceleration 6 of 10" in other and min(periods) < 1000 < 3000 < max(periods))
    data = (scratch / "f" / "figures" / "correlation.dat").read_text()
    demand("the cross-correlation is drawn over an hour to either side, with limits",
           "\n-3600.0 " in data and "\n3600.0 " in data and "limits of 95 %" in data)
    modes = (scratch / "f" / "figures" / "decomposition.gp").read_text()
    demand("one figure has all modes of both series with their periods", modes.count("'mode 6: ") == 2 and modes.count(" s *'") == 2)

    record(scratch, "a/record.csv", "--out", "c")
    again = json.loads((scratch / "c" / "result.json").read_text())["statistics"]
    demand("record.csv as input gives the same statistics",
           all(abs(again[k] - v) <= 1e-3 * abs(v) + 1e-3 for k, v in statistics.items()))

    for arguments, words in (
            (("a/result.json",), "column time_utc is missing"),
            (("night", "--from", "yesterday"), "--from"),
            (("night", "--mode", "11"), "--mode = 11: out of range; allowed: 1 to 10"),
            (("night", "--cycle", "7"), "--cycle")):
        refused(words, BIN / "a351-correct", "record", *arguments, "--out", "e", cwd=scratch)
        demand("nothing is written", not (scratch / "e").exists())
