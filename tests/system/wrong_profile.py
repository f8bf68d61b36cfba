"""A sensor that does not fit the daemon's profile is a fault in status, exit status and log; one that fits is none.

The emulator has a profile file of its own: axes of half the scale, and a temperature of 1/1024 degC.  The daemon uses A351.
"""

import time

from emulated_session import Session, wait_for
from programs import TOP, Scratch, demand

SPEED = 20
FRAMES = 1500  # Half a minute of samples: kConfirm_s of daemon/believable, and the delay of the sample times.
WORDS = ("the acceleration reads 0.50 g, but a box at rest has 1 g", "degC, but the sensor can have only -40 to +90 degC")
REMEDY = "check sensor.profile: stop the recorder and run a351d --config FILE --identify"


def write_profile(file):
    text = (TOP / "config" / "profiles" / "A351.toml").read_text()
    for right, wrong in (("fraction_bits = 24", "fraction_bits = 23"), ("slope_degc = -0.0037918", "slope_degc = 0.0009765625"),
                         ("offset_degc = 34.987", "offset_degc = 0.0")):
        demand(f"the profile has {right} once", text.count(right) == 1)
        text = text.replace(right, wrong)
    file.write_text(text)


for emulated, is_wrong in (("A351", False), ("other.toml", True)):
    with Scratch() as scratch:
        write_profile(scratch / "other.toml")
        session = Session(scratch, speed=SPEED, emulator=("--profile", emulated))
        session.wait_for_frames(FRAMES)

        def found():
            reasons = session.status()["reasons"]
            return [[reason for reason in reasons if words in reason] for words in WORDS]

        if is_wrong:
            wait_for(f"both troubles: {session.status()['reasons']}", lambda: all(found()))
            status = session.status()
            demand(f"each with its remedy: {found()}", all(one[0].endswith(REMEDY) for one in found()))
            demand(f"the level is fault: {status['level']}", status["level"] == "fault")
            screen = session.try_ctl("status")
            demand(f"a351ctl status ends with 2 and shows it: {screen.returncode}", screen.returncode == 2 and WORDS[0] in screen.stdout)
            wait_for("the log names both", lambda: all(words in (scratch / "a351d.log").read_text() for words in WORDS))
        else:
            time.sleep(1)
            demand(f"a sensor that fits has neither: {found()}", not any(found()))
        session.end()
