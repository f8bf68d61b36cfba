"""ObsPy (with_obspy.py) reads the archive and the station metadata without conversion."""

from programs import BIN, Scratch, demand, run
from with_obspy import require_obspy

require_obspy()
import obspy  # noqa: E402
from obspy.clients.filesystem.sds import Client  # noqa: E402

with Scratch() as scratch:
    root = scratch / "day"
    run(BIN / "a351-sim", "survey", "--scenario", "ideal", "--seed", 3, "--out", root)
    client = Client(str(root / "archive"))
    start = obspy.UTCDateTime("2017-07-15T23:40:00Z")
    stream = client.get_waveforms("XX", "A351", "00", "BN*", start, start + 600)
    print(obspy.__version__, stream)
    demand("the three axes are one trace each", len(stream) == 3)
    demand("ten minutes have 30 000 samples, within one sample",
           all(abs(trace.stats.npts - 30000) <= 1 for trace in stream))
    inventory = obspy.read_inventory(str(root / "metadata" / "station.xml"))
    stream.remove_sensitivity(inventory)
    norm = sum(float(trace.data.mean()) ** 2 for trace in stream) ** 0.5
    demand(f"the norm of the means is gravity ({norm:.5f} m/s2)", 9.79 < norm < 9.83)

    slow = client.get_waveforms("XX", "A351", "00", "L*", start, start + 600)
    print(slow)
    demand("clock error, timing quality and temperature are one trace each at 1 Hz",
           sorted(trace.stats.channel for trace in slow) == ["LCE", "LCQ", "LK1"]
           and all(trace.stats.sampling_rate == 1.0 for trace in slow))
    demand("their samples are at whole seconds, one each second",
           all(trace.stats.starttime.microsecond == 0 and abs(trace.stats.npts - 600) <= 1 for trace in slow))
    temperature = slow.select(channel="LK1")[0]
    raw = client.get_waveforms("XX", "A351", "00", "BK1", temperature.stats.starttime, start + 600)[0]
    temperature.remove_sensitivity(inventory)
    # Conversion from counts to degC: M-A352AD10 data sheet, 7.6.  Records start at whole microseconds, so a sample at the edge
    # of a second may appear outside it.  The second's 50 samples begin either half a period before or half a period after it.
    error = max(min(abs(34.987 - 0.0037918 * float(raw.slice(at + edge, at + edge + 0.99).data.mean()) - temperature.data[i])
                    for edge in (-0.01, 0.01))
                for i in range(1, 590, 10) for at in [temperature.stats.starttime + i])
    demand(f"LK1 is the mean of BK1 within half a count ({error * 1e3:.3f} mdegC)", error <= 0.000501)
