"""The commands of the README's request to owners make files from which everything can be computed again.

They run as written, except that they last for seconds and that the sensor is emulated on fast time.
"""

import datetime
import os
import re
import subprocess

from emulated_session import wait_for
from programs import BIN, ONE_SITE, TOP, Scratch, daemon_config, demand, run, unused_port

SPEED, SECONDS = 60, 10
START = "2017-06-01T09:00:00Z"
SCENARIO = f"""base = "ideal"
name = "short"
[schedule]
start_utc = "{START}"
duration_h = 24.0
""" + ONE_SITE


def requested():
    """Returns the commands of the request, in order."""
    section = (TOP / "README.md").read_text().split("## A request to owners of an M-A351")[1].split("\n## ")[0]
    return section.split("```")[1].strip().splitlines()


with Scratch() as scratch:
    (scratch / "short.toml").write_text(SCENARIO)
    (scratch / "station.toml").write_text(daemon_config(unused_port()))
    now = datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%S.%fZ")
    clock = f"scaled:{SPEED}@{START},{now}"
    sensor = subprocess.Popen([BIN / "a351-sim", "device", "--link", "sensor", "--scenario", "short.toml", "--clock", clock],
                              cwd=scratch)
    try:
        wait_for("the emulated sensor", (scratch / "sensor").is_symlink)
        environment = {**os.environ, "PATH": f"{BIN}:{os.environ['PATH']}"}
        commands = requested()
        demand(f"the README asks for two records with {len(commands)} commands", len(commands) == 2)
        for command in commands:
            short = re.sub(r"^timeout 1[hd] a351d", f"timeout {SECONDS} a351d --clock {clock}", command)
            demand(f"`{command}` lasts an hour or a day", short != command)
            result = subprocess.run(["bash", "-c", short], cwd=scratch, env=environment, capture_output=True, text=True)
            demand(f"`{command}` ends with {result.returncode} {result.stderr[-300:] if result.returncode else ''}",
                   result.returncode == 0)
    finally:
        sensor.terminate()
        sensor.wait(timeout=30)
    frames = []
    for name in ("hour", "day"):
        folder = scratch / name
        folder.mkdir()
        run("tar", "-xf", scratch / f"m-a351-{name}.tar", "-C", folder)
        files = sorted(path.relative_to(folder) for path in folder.rglob("*") if path.is_file())
        print(f"{name}: {(scratch / f'm-a351-{name}.tar').stat().st_size} bytes: {', '.join(map(str, files))}")
        demand(f"{name}: no configuration is in the file", not any("station.toml" in str(path) for path in files))
        made = run(BIN / "a351-correct", "retime", folder / "data", "--out", folder / "again").stdout
        frames.append(int(re.search(r"(\d+) frames", made).group(1)))
        demand(f"{name}: an archive and the metadata are made again from {frames[-1]} frames",
               any((folder / "again" / "archive").rglob("*.D.*")) and (folder / "again" / "metadata" / "station.xml").exists())
    demand("the second file continues the first", 0 < frames[0] < frames[1])
