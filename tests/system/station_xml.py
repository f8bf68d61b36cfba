"""Station metadata with one and more epochs, with and without an oven: valid StationXML, and correct values in ObsPy."""

import pathlib

from programs import BIN, TOOLS, Scratch, demand, run, skip
from with_obspy import require_obspy

require_obspy()
import numpy  # noqa: E402
import obspy  # noqa: E402
import obspy.io.stationxml  # noqa: E402
from lxml import etree  # noqa: E402

SCHEMA = pathlib.Path(obspy.io.stationxml.__file__).parent / "data" / "fdsn-station-1.2.xsd"
if not SCHEMA.exists():
    skip(f"ObsPy {obspy.__version__} has no {SCHEMA.name}")

FIRST, SECOND, THIRD = (obspy.UTCDateTime(2026, 3, day, 18) for day in (1, 2, 3))


def physical(inventory, channel, counts, at):
    """Returns value and unit that ObsPy computes from the metadata for a trace of constant counts."""
    trace = obspy.Trace(numpy.full(100, counts, dtype=numpy.int32),
                        {"network": "XX", "station": "A351", "location": "00", "channel": channel, "starttime": at,
                         "sampling_rate": 1.0 if channel.startswith("L") else 50.0})
    trace.remove_sensitivity(inventory)
    return float(trace.data[0]), inventory.get_response(trace.id, at).instrument_sensitivity.input_units


with Scratch() as scratch:
    run(TOOLS / "station-epochs", scratch)
    run(BIN / "a351-sim", "survey", "--scenario", "ideal", "--seed", 3, "--out", scratch / "day")
    schema = etree.XMLSchema(etree.parse(str(SCHEMA)))
    for file in ("one.xml", "two.xml", "oven.xml", "day/metadata/station.xml"):
        schema.validate(etree.parse(str(scratch / file)))
        for trouble in schema.error_log:
            print(trouble)
        demand(f"{file} is valid against {SCHEMA.name}", not schema.error_log)

    inventory = obspy.read_inventory(str(scratch / "oven.xml"))
    serials = []
    for at in (FIRST, SECOND, THIRD):
        channels = inventory.select(channel="BNZ", time=at)[0][0].channels
        demand(f"{at.date}: one epoch of BNZ", len(channels) == 1)
        serials.append(channels[0].sensor.serial_number)
        drift = channels[0].clock_drift_in_seconds_per_sample
        print(f"{at.date}: sensor {serials[-1]}, clock drift {drift} s per sample")
        value, unit = physical(inventory, "BNZ", 2**24, at)
        demand(f"{at.date}: one g is {value:.15g} {unit}", abs(value - 9.80665) <= 1e-9 and unit == "m/s**2")
        value, unit = physical(inventory, "LK1", 42_537, at)
        demand(f"{at.date}: LK1 gives {value} {unit}", abs(value - 42.537) <= 0.001 and unit == "degC")
    demand("each epoch has the serial number of its sensor", serials == ["00000042", "00000043", "00000043"])
    for channel, counts, expected in (("LK2", 42_500, (42.5, "degC")), ("LK3", 42_500, (42.5, "degC")),
                                      ("LYH", 6_170, (61.7, "%")), ("LCE", 250, (250e-6, "s")), ("LCQ", 80, (80.0, "%"))):
        value, unit = physical(inventory, channel, counts, THIRD)
        demand(f"{channel} gives {value} {unit}", abs(value / expected[0] - 1) < 1e-6 and unit == expected[1])
    demand("the oven's channels exist only from its epoch on", not inventory.select(channel="LK2", time=SECOND))
