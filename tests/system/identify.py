"""a351d --identify: the right sensor, another product, a GPS receiver, a dead line, and ports that cannot be opened.

tests/unit/identify has all other sensors.
"""

import datetime
import fcntl
import os
import pty
import subprocess
import threading
import tty

from emulated_session import wait_for
from programs import BIN, Scratch, daemon_config, demand, together

DONE, FAILED, LOCKED, DIFFERS = 0, 1, 3, 4
START = "2017-06-01T09:00:05Z"  # of the scenario `indoor`
GPS = b"$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47\r\n"


def folder(scratch, name):
    """Makes a folder with a configuration, whose port is `sensor`."""
    made = scratch / name
    made.mkdir()
    (made / "a351d.toml").write_text(daemon_config(8351))
    return made


def identify(where, clock=(), **options):
    """Returns exit status, standard output and the line on standard error."""
    done = subprocess.run([BIN / "a351d", "--config", "a351d.toml", "--identify", *clock], cwd=where, capture_output=True,
                          text=True, **options)
    print(f"--- {where.name}: {done.returncode}\n{done.stdout}{done.stderr}", end="")
    return done.returncode, done.stdout, done.stderr


def with_emulator(where, *emulator):
    """Identifies an emulated sensor at five times real time.

    A pause of the host of 0.2 s then changes the rate by 0.1 %, and the limit is 0.5 %.
    """
    now = datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%S.%fZ")
    clock = ("--clock", f"scaled:5@{START},{now}")
    sensor = subprocess.Popen([BIN / "a351-sim", "device", "--link", "sensor", "--scenario", "indoor", *clock, *emulator], cwd=where)
    try:
        wait_for("the emulator's terminal exists", (where / "sensor").exists)
        return identify(where, clock)
    finally:
        sensor.terminate()
        sensor.wait()


def different(text):
    return [line.split(":")[0].split()[1] for line in text.splitlines() if line.startswith("differs")]


def check_right(scratch):
    status, text, _ = with_emulator(folder(scratch, "right"))
    demand("a sensor that agrees with its configuration ends with 0", status == DONE and not different(text))
    demand("all but the serial number is confirmed", text.count("\nconfirmed ") == 14 and text.count("\ncannot be seen ") == 1)
    sent = next((scratch / "right").glob("identify-00000001-*.txt")).read_text()
    demand("the file has report, registers and bytes", text.split("\n", 1)[1].rsplit("profile A351 fits")[0] in sent
           and "\nW1:6A PROD_ID1 0x3341\n" in sent and len(sent) - sent.index("[bytes]") > 2 * 24 * 2400)


def check_product(scratch):
    where = folder(scratch, "product")
    status, text, _ = with_emulator(where, "--profile", "A352AD10")
    demand("only the product of an A352 differs from the profile A351", status == DIFFERS and different(text) == ["product"])
    demand("its profile is named", 'set sensor.profile = "A352AD10"' in text)


def with_line(where, text=None):
    """Identifies what is on a line that repeats a text.  @return also the number of bytes that the line received"""
    ours, theirs = pty.openpty()
    tty.setraw(theirs)
    (where / "sensor").symlink_to(os.ttyname(theirs))
    received, over = [], threading.Event()

    def talk():
        os.set_blocking(ours, False)
        while not over.wait(0.2):
            if text:
                os.write(ours, text)
            try:
                received.append(os.read(ours, 4096))
            except BlockingIOError:
                pass

    line = threading.Thread(target=talk)
    line.start()
    try:
        return (*identify(where), sum(map(len, received)))
    finally:
        over.set()
        line.join()


def check_other_lines(scratch):
    status, _, error, received = with_line(folder(scratch, "gps"), GPS)
    demand("a GPS receiver is named, and gets no byte", status == FAILED and "GPS receiver" in error and received == 0)
    demand("its text is shown", GPS.decode().strip() in error)
    status, _, error, received = with_line(folder(scratch, "dead"))
    demand("a dead line is asked, and the remedy is named", status == FAILED and received > 0 and "check the sensor's plug" in error)
    demand("neither leaves a file", not list(scratch.glob("gps/identify*")) + list(scratch.glob("dead/identify*")))


def check_refused_ports(scratch):
    where = folder(scratch, "refused")
    ours, theirs = pty.openpty()
    (where / "sensor").symlink_to(os.ttyname(theirs))
    os.fchmod(theirs, 0)
    scratch.chmod(0o755)
    user = {"user": 65534, "group": 65534, "extra_groups": []} if os.geteuid() == 0 else {}
    status, _, error = identify(where, **user)
    demand("without permission the group is named", status == FAILED and "group dialout" in error and error.count("\n") == 1)
    os.fchmod(theirs, 0o600)
    fcntl.flock(theirs, fcntl.LOCK_EX)
    status, _, error = identify(where)
    demand("a port in use ends with 3", status == LOCKED and "in use by another process" in error)
    os.close(ours)


with Scratch() as scratch:
    together(lambda: check_right(scratch), lambda: check_product(scratch), lambda: check_other_lines(scratch),
             lambda: check_refused_ports(scratch))
