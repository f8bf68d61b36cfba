"""Bad input: each program prints one line with file, line, key and allowed values, ends with 2 and writes nothing.

The unit tests of the readers have every mistake; here is one of each file, and each option of the emulator.
"""

import shutil

from programs import BIN, TOP, Scratch, daemon_config, demand, refused, run

GOLDEN = TOP / "tests" / "golden" / "tsukuba"
CONFIG = daemon_config(8351) + '[survey]\nsites = "sites.csv"\n'
SITES = "site,longitude_deg,latitude_deg,altitude_m,gravity_mgal\nA,140,36,10,979900\nB,140,36,20,979950\n"
SCENARIO = 'base = "tsukuba"\nname = "x"\n'
STAY = '[[occupation]]\nsite = "No.1"\nnumber = {0}\ncentre_utc = "2017-07-16T00:0{0}:00Z"\nambient_degc = 25\n'
LONG = "x" * 300
DAEMON = ("a351d", "--config", "a351d.toml")
DEVICE = ("a351-sim", "device", "--link")
TABLE = ("a351-correct", "table", "--sites", "golden.csv", "--observations", "bad.csv", "--out", "result")


def listing(directory):
    return sorted(str(path.relative_to(directory)) for path in directory.rglob("*"))


def refuse(title, parts, *command, **files):
    """Demands the refusal of a command in a folder with these files; a key is the name of a file up to the dot."""
    with Scratch() as scratch:
        shutil.copy(GOLDEN / "sites.csv", scratch / "golden.csv")
        (scratch / "taken").write_text("somebody's")
        (scratch / "foreign").symlink_to("/nonexistent")
        (scratch / "loop").symlink_to("loop")
        (scratch / "data").mkdir()
        for name, text in {"a351d": CONFIG, "sites": SITES, **files}.items():
            (scratch / (name + (".csv" if name in ("sites", "bad") else ".toml"))).write_text(text)
        before = listing(scratch)
        refused(parts, BIN / command[0], *command[1:], cwd=scratch)
        demand(f"{title}: nothing written", listing(scratch) == before
               and (scratch / "taken").read_text() == "somebody's")


refuse("a key of the configuration", ["a351d.toml:10", "page.listen_to", "unknown key", "allowed"], *DAEMON,
       a351d=CONFIG.replace("listen =", "listen_to ="))
refuse("a missing list of sites", ["absent.csv"], *DAEMON, a351d=CONFIG.replace("sites.csv", "absent.csv"))
refuse("sites with NaN", ["sites.csv:2", "latitude_deg", "nan"], *DAEMON, sites=SITES.replace("140,36,10",
                                                                                              "140,nan,10"))
refuse("a missing configuration", ["absent.toml"], "a351d", "--config", "absent.toml")
for command in (("a351d",), ("a351-sim", "plan", "--out", "plan"), ("a351-correct", "survey", "day.toml"),
                ("a351ctl", "sites"),
                ("a351-stream", "data", "127.0.0.1:1")):
    refuse(f"unknown option of {command[0]}", ["--nonsense"], *command, "--nonsense")
refuse("an unknown scenario", ["nowhere"], "a351-sim", "survey", "--scenario", "nowhere", "--out", "root")
for what, text, parts in (("key", SCENARIO + "[oven]\nlid = true\n", ["day.toml:4", "oven.lid", "unknown"]),
                          ("stay", SCENARIO + "".join(map(STAY.format, range(1, 7))),
                           ["scenario x", "No.1", "further apart"])):
    for command in ("plan", "survey"):
        refuse(f"a {what} of a scenario for {command}", parts, "a351-sim", command, "--scenario", "day.toml", "--out",
               "root", day=text)
with Scratch() as scratch:
    (scratch / "sites.csv").write_text(SITES)
    (scratch / "a351d.toml").write_text(CONFIG.replace("latitude = 36.2", "latitude = 8.5"))
    doubt = run(BIN / "a351d", "--config", "a351d.toml", "--check-config", cwd=scratch)
    demand(f"a doubtful position of the station is named: {doubt.stderr.strip()}",
           doubt.stdout == "ok\n" and "sites.csv: [station] is " in doubt.stderr and doubt.stderr.count("\n") == 1)
for link, parts in (("absent/sensor", ["absent/sensor", "allowed"]), ("taken", ["no link"]),
                    ("foreign", ["/nonexistent"]),
                    ("", ["empty path", "allowed"]), (LONG, ["too long", "allowed"]), ("loop/sensor", ["no directory"]),
                    ("loop", ["allowed"]), ("/proc/sensor", ["/proc/sensor", "allowed"])):
    refuse(f"the link {link[:20]}", parts, *DEVICE, link)
for option in ("--truth", "--report", "--state", "--control", "--oven-link"):
    for file in ("absent/file", LONG, "/proc/file", *((".", "loop") if option in ("--truth", "--report", "--state")
                                                      else ("loop/file",))):
        # No file is made before all paths were looked at.
        truth = ("--truth", "truth.bin") if option in ("--control", "--oven-link") else ()
        refuse(f"{option} {file[:20]}", [file, "allowed"], *DEVICE, "sensor", option, file, *truth)
for title, parts, *options in (
        ("control socket in place of a file", ["taken", "no socket"], "--control", "taken"),
        ("truth in place of a foreign file", ["taken", "no truth file"], "--truth", "taken"),
        ("clock after the scenario", ["after the end of the scenario tsukuba"], "--clock",
         "scaled:1@2030-01-01T00:00:00Z"),
        ("missing fault script", ["absent.toml"], "--faults", "absent.toml"),
        ("impossible fault", ["faults.toml:4", "fault.bits = 17", "from 1 to 16"], "--faults", "faults.toml"),
        ("impossible flash memory", ["flash.toml:3", "registers.SIG_CTRL", "65535"], "--state", "flash.toml")):
    refuse(title, parts, *DEVICE, "sensor", *options, faults='[[fault]]\nkind = "flip_bit"\nat_s = 1\nbits = 17\n',
           flash="format = 1\n[registers]\nSIG_CTRL = 0x1FFFF\n")
for title, parts, *recording in (("absent recording", ["absent.a351j: no such file", "allowed"], "absent.a351j"),
                                 ("table in place of a recording", ["golden.csv: begins with no record", "allowed"], "golden.csv"),
                                 ("speed 0 of a replay", ["--speed 0: not a speed", "allowed"],
                                  GOLDEN.parent / "logs/clean_start.a351j", "--speed", "0")):
    refuse(title, parts, "a351-sim", "replay", *recording, "--link", "sensor")
observations = (GOLDEN / "observations.csv").read_text()
refuse("observation of an unknown site", ["bad.csv:3", "site", "No.99", "allowed"], *TABLE,
       bad=observations.replace("No.12,1", "No.99,1"))
refuse("unknown base", ["survey.toml:4", "survey.base", "No.99"], "a351-correct", "survey", "survey.toml", "--out",
       "result",
       survey='[survey]\nroot = "data"\nsites = "golden.csv"\nbase = "No.99"\n')
