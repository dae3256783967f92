"""A relay in front of the bench that keeps a record of what control asks for."""

import socket
import threading
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress
from typing import NamedTuple

WRITES = frozenset({5, 6, 15, 16, 22, 23})
"""Function codes that change something (Modbus Application Protocol V1.1b3, 6)."""
HEADER, FUNCTION = 6, 7


class Asked(NamedTuple):
    """One request on the wire."""

    at: float
    """On the monotonic clock. [s]"""
    connection: int
    frame: bytes

    @property
    def writes(self) -> bool:
        return self.frame[FUNCTION] in WRITES


class Wiretap:
    """Relays every connection to a Modbus TCP server, and listens."""

    def __init__(self, host: str, port: int) -> None:
        self.asked: list[Asked] = []
        self._target = (host, port)
        self._listening = socket.create_server(("127.0.0.1", 0))
        self._lines: list[socket.socket] = []
        self.address = f"127.0.0.1:{self._listening.getsockname()[1]}"

    def written(self, since: float) -> list[Asked]:
        """Requests since a time that change something."""
        return [each for each in self.asked if each.writes and each.at >= since]

    def cut(self) -> None:
        """Close every connection."""
        for line in self._lines:
            with suppress(OSError):
                line.shutdown(socket.SHUT_RDWR)

    def close(self) -> None:
        self._listening.shutdown(socket.SHUT_RDWR)
        self._listening.close()
        self.cut()

    def listen(self) -> None:
        """Accept until closed."""
        with suppress(OSError):
            while True:
                client, _ = self._listening.accept()
                threading.Thread(target=self._relay, args=(client,)).start()

    def _relay(self, client: socket.socket) -> None:
        with suppress(OSError), closing(client):
            server = socket.create_connection(self._target)
            for line in (client, server):
                line.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                self._lines.append(line)
            number = len(self._lines) // 2
            back = threading.Thread(target=_pump, args=(server, client))
            back.start()
            with closing(server):
                self._listen_in(client, server, number)
            back.join()

    def _listen_in(
        self, client: socket.socket, server: socket.socket, number: int
    ) -> None:
        buffer = b""
        while octets := client.recv(4096):
            buffer += octets
            while len(buffer) >= HEADER and len(buffer) >= (size := _size(buffer)):
                self.asked.append(Asked(time.monotonic(), number, buffer[:size]))
                buffer = buffer[size:]
            server.sendall(octets)
        with suppress(OSError):
            server.shutdown(socket.SHUT_RDWR)


def _size(buffer: bytes) -> int:
    return HEADER + int.from_bytes(buffer[4:6], "big")


def _pump(source: socket.socket, sink: socket.socket) -> None:
    with suppress(OSError):
        while octets := source.recv(4096):
            sink.sendall(octets)
    with suppress(OSError):
        sink.shutdown(socket.SHUT_RDWR)


@contextmanager
def wiretap(host: str, port: int) -> Iterator[Wiretap]:
    """Relay while inside."""
    tap = Wiretap(host, port)
    thread = threading.Thread(target=tap.listen)
    thread.start()
    try:
        yield tap
    finally:
        tap.close()
        thread.join()
