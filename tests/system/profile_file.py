"""Emulator and daemon use a profile from a file, and show what such a sensor measures.

The profile is that of the A352AD10, but each count of its temperature is 65536 times as fine.  Read with a shipped profile,
the same bytes would be a temperature of half a million degrees.
"""

from emulated_session import Session
from programs import BIN, TOP, Scratch, contents, demand, refused, run

SLOPE_DEGC = -0.0037918
OVEN_DEGC = 42.5


def write_profile(file):
    text = (TOP / "config" / "profiles" / "A352AD10.toml").read_text()
    file.write_text(text.replace(f"slope_degc = {SLOPE_DEGC}", f"slope_degc = {SLOPE_DEGC / 65536!r}"))


with Scratch() as scratch:
    write_profile(scratch / "fine.toml")
    (scratch / "wrong.toml").write_text((scratch / "fine.toml").read_text().replace("hz = 500,", "hz = 600,"))
    wrong = (f"{scratch / 'wrong.toml'}:31: output_rate.choices.hz = 600: ", "; allowed: ")
    refused(wrong, BIN / "a351-sim", "device", "--link", scratch / "s", "--profile", scratch / "wrong.toml")

    session = Session(scratch, emulator=("--profile", "fine.toml"), config='profile = "fine.toml"\n')
    session.wait_for_frames(500)
    shown = session.status()["sample"]["temperature_degc"]
    demand(f"the daemon shows the temperature of the oven: {shown} degC", abs(shown - OVEN_DEGC) < 1.0)
    session.end()
    response = (scratch / "data" / "metadata" / "station.xml").read_text()
    demand("the metadata have the slope of the file", f">{SLOPE_DEGC / 65536!r}<" in response)

    # A wrong profile is repaired: StationXML and archive are those that the daemon would have written.
    retime = (BIN / "a351-correct", "retime", "data", "--out")
    refused(wrong, *retime, "no", "--profile", scratch / "wrong.toml", cwd=scratch)
    run(*retime, "named", "--profile", "fine.toml", cwd=scratch)
    refused("no sensor sends such values", *retime, "coarse", "--profile", "A352AD10", cwd=scratch)
    demand("retime writes nothing with a profile that cannot be true", not (scratch / "coarse").exists())
    (scratch / "shifted.toml").write_text((scratch / "fine.toml").read_text().replace("offset_degc = 34.987", "offset_degc = 33.987"))
    run(*retime, "shifted", "--profile", "shifted.toml", cwd=scratch)
    response = (scratch / "shifted" / "metadata" / "station.xml").read_text()
    demand("the metadata have the offset of the other profile", ">33.987<" in response)

    # Without the file of the profile the journal still says how to read its bytes.
    (scratch / "fine.toml").unlink()
    run(*retime, "again", cwd=scratch)
    archives = [contents(scratch / root / "archive") for root in ("data", "again")]
    demand(f"re-timing finds the profile in the journal: {archives[1].keys()}", archives[1] and archives[1].keys() == archives[0].keys())
    differing = [name for name, content in contents(scratch / "again").items() if contents(scratch / "named").get(name) != content]
    demand(f"the profile of the record named makes no difference: {differing}", not differing)
    demand("another profile does", contents(scratch / "again") != contents(scratch / "shifted"))
