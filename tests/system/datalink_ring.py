"""A ring of packets that speaks DataLink 1.0, written from EarthScope's document of the protocol, with bad days on request."""

import socket
import threading
import time


def fdsn_name(name):
    """Returns the name that ringserver 4 gives the stream NET_STA_LOC_CHAN/MSEED."""
    plain, kind = name.split("/")
    network, station, location, channel = plain.split("_")
    return f"FDSN:{network}_{station}_{location}_{'_'.join(channel)}/{kind}"


class Gone(Exception):
    """The connection ended."""


class Ring:
    """A server on a port of this host.  Its packets survive stop() and start(), as those of a ring on disk.

    `moods` are the behaviours of the next connections, in order; later ones are good:
      good        answers everything
      mute        accepts, and never answers
      deaf        takes some records, and stops answering without reading any more
      forgetful   takes some records, and closes before the acknowledgements
      refuse      answers the first record with an error, and closes
      flood       sends bytes without end instead of an answer
      babble      sends an acknowledgement that is too large
    """

    def __init__(self, port):
        self.port, self.packets, self.next_id = port, [], 1
        self.moods, self.connections, self.seen = [], 0, []
        self.lock, self.listener, self.clients = threading.Lock(), None, []
        self.faults = []  # Breaches of the protocol by the client.

    def start(self):
        self.listener = socket.create_server(("127.0.0.1", self.port))
        threading.Thread(target=self._accept, args=(self.listener,), daemon=True).start()

    def stop(self):
        """Ends like a server that was stopped: all connections are closed."""
        listener, self.listener = self.listener, None
        listener.shutdown(socket.SHUT_RDWR)
        listener.close()
        with self.lock:
            clients, self.clients = self.clients, []
        for client in clients:
            try:
                client.shutdown(socket.SHUT_RDWR)
            except OSError:
                pass

    def drop(self, is_dropped):
        """Drops packets, as a ring does that became too small for them."""
        with self.lock:
            self.packets = [packet for packet in self.packets if not is_dropped(packet)]

    def data_of(self, stream):
        with self.lock:
            return b"".join(data for _, name, _, _, data in self.packets if name == stream)

    def streams(self):
        with self.lock:
            return sorted({packet[1] for packet in self.packets})

    def _accept(self, listener):
        while True:
            try:
                client, _ = listener.accept()
            except OSError:
                return
            with self.lock:
                mood = self.moods.pop(0) if self.moods else "good"
                self.connections += 1
                self.seen.append(mood)
                self.clients.append(client)
            threading.Thread(target=self._serve, args=(client, mood), daemon=True).start()

    def _serve(self, client, mood):
        try:
            with client:
                self._talk(client, mood)
        except (Gone, OSError):
            pass

    def _talk(self, client, mood):
        if mood == "mute":
            receive(client, 1 << 30)
        writes = 0
        while True:
            preheader = receive(client, 3)
            if preheader[:2] != b"DL":
                self.faults.append(f"preheader {preheader}")
                raise Gone
            words = receive(client, preheader[2]).decode("ascii").split(" ")
            if words[0] == "ID":
                send(client, "ID DataLink 2026.001 :: DLPROTO:1.0 PACKETSIZE:512 WRITE")
            elif words[0] == "MATCH":
                receive(client, int(words[1]))
                send(client, "OK 0 0")
            elif words[:2] == ["INFO", "STREAMS"]:
                if mood == "flood":
                    while True:
                        client.sendall(b"flood" * 10000)
                if mood == "babble":
                    send(client, f"INFO STREAMS {1 << 40}")
                    continue
                send(client, "INFO STREAMS {}", self._info())
            elif words == ["POSITION", "SET", "EARLIEST"]:
                with self.lock:
                    send(client, f"OK {self.packets[0][0] if self.packets else 0} 0")
            elif words[0] == "READ":
                self._read(client, int(words[1]))
            elif words[0] == "WRITE" and len(words) == 6 and words[4] == "A":
                data = receive(client, int(words[5]))
                writes += 1
                if mood == "refuse":
                    send(client, "ERROR 0 {}", b"Write permission not granted")
                    return
                identity = self._store(words, data)
                if mood == "forgetful" and writes >= 5:
                    return
                if mood == "deaf" and writes >= 5:
                    time.sleep(40)
                    return
                if mood != "forgetful":
                    send(client, f"OK {identity} 0")
            else:
                self.faults.append(f"command {words}")
                send(client, "ERROR 0 {}", b"unknown command")

    def _store(self, words, data):
        with self.lock:
            identity, self.next_id = self.next_id, self.next_id + 1
            self.packets.append((identity, fdsn_name(words[1]), int(words[2]), int(words[3]), data))
        return identity

    def _info(self):
        latest = {}
        with self.lock:
            for identity, name, *_ in self.packets:
                latest[name] = identity
        streams = "".join(f'<Stream Name="{name}" LatestPacketID="{identity}"/>' for name, identity in latest.items())
        return f'<DataLink Version="1.0"><StreamList TotalStreams="{len(latest)}">{streams}</StreamList></DataLink>'.encode()

    def _read(self, client, identity):
        with self.lock:
            found = [packet for packet in self.packets if packet[0] == identity]
        if not found:
            send(client, "ERROR 0 {}", b"Packet not found in ring")
            return
        _, name, start, end, data = found[0]
        send(client, f"PACKET {name} {identity} 0 {start} {end} {{}}", data)


def receive(client, size):
    data = b""
    while len(data) < size:
        more = client.recv(min(size - len(data), 65536))
        if not more:
            raise Gone
        data += more
    return data


def send(client, header, data=b""):
    line = header.format(len(data)).encode()
    client.sendall(b"DL" + bytes([len(line)]) + line + data)
