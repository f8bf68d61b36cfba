"""ringserver serves an archive while a daemon writes it; slarchive must fetch it byte for byte.

Both are searched in PATH or named by A351_RINGSERVER and A351_SLARCHIVE.  slarchive 3.2 ends at a record whose first blockette is not 1000.
"""

import signal
import subprocess
import time

from emulated_session import Session, wait_for
from programs import IS_SANITIZED, Scratch, contents, demand, one_site, unused_port
from seedlink import is_listening, program

# Starts ten minutes before midnight and ends at least ten minutes after it: two day files of each channel.
SCENARIO = one_site("quiet", "2017-07-15T23:50:00Z", 10)
SPEED = 40 if IS_SANITIZED else 100
FRAMES = 20 * 60 * 50

ringserver, slarchive = program("ringserver"), program("slarchive")

with Scratch() as scratch:
    archive, fetched, port = scratch / "data" / "archive", scratch / "fetched", unused_port()
    archive.mkdir(parents=True)
    # ringserver serves from memory, to this host alone.  Only names of day files end in a digit; temporary files do not match.
    (scratch / "ring.conf").write_text(
        f"VolatileRing 1\nRingSize 64M\nListenPort {port} SeedLink IPv4\nAcceptIP 127.0.0.1\n"
        f"MSeedScan {archive} StateFile=scan.state Match=[0-9]$\n")
    server = subprocess.Popen([ringserver, "ring.conf"], cwd=scratch, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL)
    wait_for("ringserver listens", lambda: is_listening(port))
    # A client gets only data that come after its connection, so it connects before the first record.
    log = open(scratch / "slarchive.log", "w")
    client = subprocess.Popen([slarchive, "-v", "-SDS", "fetched", "-nd", "1", "-S", "XX_A351",
                               f"127.0.0.1:{port}"], cwd=scratch, stdout=log, stderr=log)
    wait_for("slarchive is connected", lambda: "accepted" in (scratch / "slarchive.log").read_text())
    (scratch / "midnight.toml").write_text(SCENARIO)
    session = Session(scratch, speed=SPEED, scenario="midnight.toml")
    try:
        session.wait_for_frames(FRAMES)
        while_growing = sum(len(data) for data in contents(fetched, "*.D.*").values())
        session.end()
        written = contents(archive, "*.D.*")
        wait_for("all written data are fetched", lambda: contents(fetched, "*.D.*").keys() == written.keys() and all(
            len(data) >= len(written[name]) for name, data in contents(fetched, "*.D.*").items()))
        for name, data in written.items():
            (archive / f"{name}.tmp").write_bytes(data[:512])
            (archive / f"{name}.512.torn").write_bytes(data[512:1024])
        time.sleep(2.0)  # Time in which data might arrive twice.
        demand("ringserver and slarchive are still running", server.poll() is None and client.poll() is None)
    finally:
        for process in (client, server):
            process.send_signal(signal.SIGTERM)
            process.wait(timeout=30)
    came, size = contents(fetched, "*.D.*"), sum(len(data) for data in written.values())
    print(f"{len(written)} day files, {size} bytes; {while_growing} bytes were fetched while the files grew")
    channels, days = {name.split(".")[-4] for name in written}, {name.rsplit(".", 1)[1] for name in written}
    demand(f"channels {', '.join(sorted(channels))} on days {', '.join(sorted(days))}",
           len(channels) >= 4 and len(days) == 2 and len(written) >= 8)
    demand("data were fetched while the archive grew", while_growing > 0)
    demand("exactly the day files are fetched, byte for byte", came == written)
