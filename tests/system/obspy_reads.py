"""The archive and the station metadata open in ObsPy as they are."""

import sys

from programs import BIN, SKIPPED, Scratch, demand, run

try:
    import obspy
    from obspy.clients.filesystem.sds import Client
except ImportError:
    print("skipped: ObsPy is not installed")
    sys.exit(SKIPPED)

with Scratch() as scratch:
    root = scratch / "day"
    run(BIN / "a351-sim", "survey", "--scenario", "ideal", "--seed", 3, "--out", root)
    client = Client(str(root / "archive"))
    start = obspy.UTCDateTime("2017-07-15T23:40:00Z")
    stream = client.get_waveforms("XX", "A351", "00", "BN*", start, start + 600)
    print(obspy.__version__, stream)
    demand("three axes come as one trace each", len(stream) == 3)
    demand("ten minutes hold 30 000 samples within one",
           all(abs(trace.stats.npts - 30000) <= 1 for trace in stream))
    inventory = obspy.read_inventory(str(root / "metadata" / "station.xml"))
    stream.attach_response(inventory)
    stream.remove_sensitivity()
    norm = sum(float(trace.data.mean()) ** 2 for trace in stream) ** 0.5
    demand(f"the norm of the means is gravity ({norm:.5f} m/s2)", 9.79 < norm < 9.83)
