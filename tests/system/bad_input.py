"""Bad input: the program prints one line with file, line, key and allowed values, ends with status 2 and writes nothing."""

import shutil

from programs import BIN, TOP, Scratch, demand, run

GOLDEN = TOP / "tests" / "golden" / "tsukuba"
SITES = "site,longitude_deg,latitude_deg,altitude_m,gravity_mgal\nA,140,36,10,979900\nB,140,36,20,979950\n"
CONFIG = """[station]
latitude = 36.2
longitude = 140.1
elevation_m = 400.0
[sensor]
port = "sensor"
[storage]
root = "data"
[survey]
sites = "sites.csv"
"""


def listing(directory):
    return sorted(str(path.relative_to(directory)) for path in directory.rglob("*"))


def refuse(title, directory, parts, *command):
    before = listing(directory)
    result = run(*command, check=False, cwd=directory)
    line = result.stderr.strip()
    print(f"{title}: {line}")
    demand(f"{title}: status 2", result.returncode == 2)
    demand(f"{title}: one line on stderr", line != "" and "\n" not in line)
    for part in parts:
        demand(f"{title}: the line names {part!r}", part in line)
    demand(f"{title}: nothing written", listing(directory) == before)


def daemon_config(title, text, parts, sites=SITES):
    with Scratch() as scratch:
        (scratch / "a351d.toml").write_text(text)
        (scratch / "sites.csv").write_text(sites)
        refuse(title, scratch, parts, BIN / "a351d", "--config", "a351d.toml")


daemon_config("unknown key", CONFIG + "[page]\nlisten_to = 1\n",
              ["a351d.toml:12", "page.listen_to", "unknown key", "allowed"])
daemon_config("wrong type", CONFIG.replace("[storage]", "baud = \"fast\"\n[storage]"),
              ["a351d.toml:7", "sensor.baud", "fast", "allowed"])
daemon_config("impossible station code", CONFIG.replace("[sensor]", "station = \"TSUKUBA\"\n[sensor]"),
              ["a351d.toml:5", "station.station", "TSUKUBA", "allowed"])
daemon_config("rate and filter that do not fit",
              CONFIG.replace("port = \"sensor\"", "port = \"sensor\"\nfilter = \"k512_fc16\""),
              ["a351d.toml:7", "sensor.filter", "k512_fc16", "k512_fc9"])
daemon_config("token too short", CONFIG + "[page]\ntoken = \"guess\"\n",
              ["a351d.toml:12", "page.token", "16 or more"])
daemon_config("missing sites file", CONFIG.replace("sites.csv", "absent.csv"), ["absent.csv"])
daemon_config("sites without a column", CONFIG, ["sites.csv:1", "longitude_deg"], "site,latitude_deg\nA,1\n")
daemon_config("sites with NaN", CONFIG, ["sites.csv:2", "latitude_deg", "nan"],
              SITES.replace("140,36,10", "140,nan,10"))
daemon_config("a site twice", CONFIG, ["sites.csv:3", "site", "A"], SITES.replace("\nB,", "\nA,"))

with Scratch() as scratch:
    refuse("missing configuration", scratch, ["absent.toml"], BIN / "a351d", "--config", "absent.toml")
    refuse("unknown option", scratch, ["--nonsense"], BIN / "a351d", "--nonsense")
    for command in (["a351-sim", "plan", "--out", "plan"], ["a351-correct", "survey", "day.toml"],
                    ["a351ctl", "sites"]):
        refuse(f"unknown option of {command[0]}", scratch, ["--nonsense"], BIN / command[0],
               *command[1:], "--nonsense")
    refuse("unknown scenario", scratch, ["nowhere"], BIN / "a351-sim", "survey", "--scenario",
           "nowhere", "--out", "root")
    day = scratch / "day.toml"
    stay = "[[occupation]]\nsite = \"No.{}\"\ncentre_utc = \"2017-07-16T0{}:00:00Z\"\nambient_degc = 25\n"
    head = "base = \"tsukuba\"\nname = \"x\"\n"
    for title, text, parts in (
            ("no TOML", "base = tsukuba", ["day.toml:1"]),
            ("unknown base", "base = \"fuji\"\nname = \"x\"\n", ["day.toml:1", "fuji", "tsukuba"]),
            ("unknown key", head + "[oven]\nlid = true\n", ["day.toml:4", "oven.lid", "unknown"]),
            ("impossible value", head + "[sensor]\nwhite_mgal = -1.0\n", ["day.toml:4", "white_mgal", "-1"]),
            ("unknown site", head + stay.format(99, 1), ["day.toml:4", "site", "No.99"]),
            ("occupations out of order", head + stay.format(1, 2) + stay.format(2, 1),
             ["day.toml:9", "centre_utc", "rising"]),
            ("a start without a length", head + "[schedule]\nstart_utc = \"2017-07-16T00:00:00Z\"\n",
             ["day.toml:3", "duration_h"]),
            ("no room at the end", head + "[schedule]\nlead_out_min = 1\n", ["day.toml:4", "lead_out_min"]),
            ("no room between", head + "".join(f"[[occupation]]\nsite = \"No.1\"\nnumber = {n}\ncentre_utc = "
                                               f"\"2017-07-16T00:0{n}:00Z\"\nambient_degc = 25\n" for n in range(1, 7)),
             ["scenario x", "No.1", "further apart"])):
        day.write_text(text)
        for command in ("plan", "survey"):
            refuse(f"scenario for {command}: {title}", scratch, parts, BIN / "a351-sim", command, "--scenario",
                   "day.toml", "--out", "root")
    device = [BIN / "a351-sim", "device", "--link"]
    (scratch / "taken").write_text("somebody's")
    (scratch / "foreign").symlink_to("/nonexistent")
    refuse("link in no directory", scratch, ["absent/sensor", "allowed"], *device, "absent/sensor")
    refuse("link in place of a file", scratch, ["taken", "no link"], *device, "taken")
    refuse("link in place of a foreign link", scratch, ["foreign", "/nonexistent"], *device, "foreign")
    refuse("control socket in place of a file", scratch, ["taken", "no socket"], *device, "sensor",
           "--control", "taken")
    refuse("clock after the scenario", scratch, ["after the end of the scenario tsukuba", "allowed"], *device, "sensor",
           "--clock", "scaled:1@2030-01-01T00:00:00Z")
    (scratch / "loop").symlink_to("loop")
    long = "x" * 300
    refuse("empty link", scratch, ["empty path", "allowed"], *device, "")
    refuse("link of 300 characters", scratch, ["too long", "allowed"], *device, long)
    refuse("link below a symlink loop", scratch, ["loop/sensor", "no directory"], *device, "loop/sensor")
    refuse("link in place of a symlink loop", scratch, ["loop", "allowed"], *device, "loop")
    refuse("link where none can be made", scratch, ["/proc/sensor", "allowed"], *device, "/proc/sensor")
    for option in ("--truth", "--report", "--state"):
        for title, file in (("no directory", "absent/file"), ("a directory", "."), ("a symlink loop", "loop"),
                            ("a name of 300 characters", long), ("a directory without files", "/proc/file")):
            refuse(f"{option} in {title}", scratch, [file, "allowed"], *device, "sensor", option, file)
    for option in ("--control", "--oven-link"):
        for title, file in (("no directory", "absent/file"), ("a symlink loop", "loop/file"),
                            ("a name of 300 characters", long), ("a directory without files", "/proc/file")):
            refuse(f"{option} in {title}", scratch, [file, "allowed"], *device, "sensor", option, file,
                   "--truth", "truth.bin")
    refuse("truth in place of a foreign file", scratch, ["taken", "no truth file"], *device, "sensor", "--truth",
           "taken")
    demand("the foreign file is unchanged", (scratch / "taken").read_text() == "somebody's")
    refuse("missing fault script", scratch, ["absent.toml"], *device, "sensor", "--faults", "absent.toml")
    (scratch / "flash.toml").write_text("format = 1\n[registers]\nSIG_CTRL = 0x1FFFF\n")
    refuse("impossible flash memory", scratch, ["flash.toml:3", "registers.SIG_CTRL", "65535"], *device,
           "sensor", "--state", "flash.toml")
    (scratch / "faults.toml").write_text("[[fault]]\nkind = \"flip_bit\"\nat_s = 1\nbits = 17\n")
    refuse("impossible fault", scratch, ["faults.toml:4", "fault.bits = 17", "from 1 to 16"], *device,
           "sensor", "--faults", "faults.toml")
    (scratch / "faults.toml").write_text("[[fault]]\nkind = \"overrun\"\nat_s = 1\n")
    refuse("overrun at high speed", scratch, ["faults.toml:2", "overrun", "50"], *device, "sensor",
           "--faults", "faults.toml", "--speed", "100")
    for name in ("sites.csv", "observations.csv"):
        shutil.copy(GOLDEN / name, scratch / name)
    observations = (scratch / "observations.csv").read_text()
    table = [BIN / "a351-correct", "table", "--sites", "sites.csv", "--observations", "bad.csv",
             "--out", "result"]
    bad = scratch / "bad.csv"
    bad.write_text(observations.replace("No.12,1", "No.99,1"))
    refuse("observation of an unknown site", scratch, ["bad.csv:3", "site", "No.99", "allowed"], *table)
    bad.write_text(observations.replace("981614.788", "nan"))
    refuse("observation that is no number", scratch, ["bad.csv:3", "acceleration_mgal", "nan"], *table)
    bad.write_text(observations.replace("temperature_degc", "temperature"))
    refuse("observations without a column", scratch, ["bad.csv:1", "temperature_degc"], *table)
    (scratch / "data").mkdir()
    (scratch / "survey.toml").write_text("[survey]\nroot = \"data\"\nsites = \"sites.csv\"\nbase = \"No.99\"\n")
    refuse("unknown base", scratch, ["survey.toml:4", "survey.base", "No.99"], BIN / "a351-correct",
           "survey", "survey.toml", "--out", "result")
