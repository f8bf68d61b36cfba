"""Client of the daemon's live stream on plain sockets (RFC 6455)."""

import base64
import os
import socket
import struct

TEXT, CLOSE, PING, PONG = 1, 8, 9, 10


def open_stream(port, receive_buffer=None):
    """Opens the stream and returns its socket.

    @raise ConnectionError  the daemon refused or closed the connection; the message holds its answer
    """
    connection = socket.socket()
    if receive_buffer:
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
    connection.settimeout(20)
    connection.connect(("127.0.0.1", port))
    key = base64.b64encode(os.urandom(16)).decode()
    connection.sendall(f"GET /live HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nOrigin: http://127.0.0.1:{port}\r\n"
                       f"Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                       f"Sec-WebSocket-Key: {key}\r\n\r\n".encode())
    head = b""
    while not head.endswith(b"\r\n\r\n"):
        byte = connection.recv(1)
        if not byte:
            raise ConnectionError(f"the daemon closed after {head!r}")
        head += byte
    if not head.startswith(b"HTTP/1.1 101 "):
        raise ConnectionError(head.split(b"\r\n")[0].decode())
    return connection


def messages(connection):
    """Yields kind and payload of each text and binary message up to the end of the stream; answers pings."""
    with connection.makefile("rb") as stream:
        while True:
            head = stream.read(2)
            if len(head) < 2:
                return
            size = head[1]
            if size == 126:
                size, = struct.unpack(">H", stream.read(2))
            elif size == 127:
                size, = struct.unpack(">Q", stream.read(8))
            payload = stream.read(size)
            kind = head[0] & 15
            if kind == CLOSE or len(payload) < size:
                return
            if kind == PING:
                connection.sendall(bytes([0x80 | PONG, 0x80 | size]) + bytes(4) + payload)
            else:
                yield kind, payload
