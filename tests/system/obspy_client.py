"""Appends the records that ObsPy's SeedLink client receives to a file, until it is ended: obspy_client.py PORT FILE."""

import logging
import sys
import time

from obspy.clients.seedlink.seedlinkexception import SeedLinkException
from obspy.clients.seedlink.slclient import SLClient
from obspy.clients.seedlink.slpacket import SLPacket

logging.basicConfig(level=logging.INFO)
client = SLClient()
client.slconn.set_net_delay(1)
# It does not see the end of a connection, so it learns of a restart by silence only.  At factor 1 the first record takes 10 s.
client.slconn.set_net_timeout(30)
client.slconn.set_sl_address(f"127.0.0.1:{sys.argv[1]}")
client.multiselect = "XX_A351:?????"  # It gives up a station without a selector.
client.initialize()

with open(sys.argv[2], "ab", buffering=0) as out:
    def keep(_, packet):
        if isinstance(packet, SLPacket) and packet.get_type() not in (SLPacket.TYPE_SLINF, SLPacket.TYPE_SLINFT):
            out.write(packet.msrecord)
        return False

    while True:
        try:
            client.run(keep)
        except SeedLinkException as error:  # It does not wait for a server that is down.
            print(error, file=sys.stderr)
        time.sleep(0.5)
