"""A Modbus device in a process of its own, quick enough not to be what is measured.

libmodbus where there is a compiler and its header (``apt install libmodbus-dev``), else
the codec of this package on a blocking descriptor.
"""

import os
import socket
import sys
import tempfile
import tty
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from gripperd.protocol.mbap import ModbusTcp
from gripperd.protocol.modbus import Read, Refusal
from gripperd.protocol.rtu import ModbusRtu
from tests.interop import programs

SOURCE = Path(programs.__file__).with_name("libmodbus_server.c")
BAUD = 115_200


def _command(folder: Path) -> list[str]:
    program = programs.compiled(SOURCE, folder)
    own = [sys.executable, "-m", "tests.benchmarks.device"]
    return own if program is None else [str(program)]


@contextmanager
def tcp_device() -> Iterator[tuple[str, int]]:
    """Address of a device on Modbus TCP, while inside."""
    port = programs.free_port()
    with (
        tempfile.TemporaryDirectory() as folder,
        programs.running(*_command(Path(folder)), "tcp", str(port)),
    ):
        yield "127.0.0.1", port


@contextmanager
def rtu_device() -> Iterator[str]:
    """Path of a pty with a device on Modbus RTU behind it, while inside."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        with (
            programs.cable(folder) as (near, far),
            programs.running(*_command(folder), "rtu", str(far), str(BAUD)),
        ):
            yield str(near)


def _serve(descriptor: int, dialect: ModbusTcp | ModbusRtu) -> None:
    buffer = bytearray()
    while octets := os.read(descriptor, 4096):
        buffer += octets
        while length := dialect.request_length(buffer):
            frame = bytes(buffer[:length])
            del buffer[:length]
            request = dialect.decode_request(frame)
            assert request is not None
            assert not isinstance(request, Refusal)
            zeros = (0,) * request.count if isinstance(request, Read) else ()
            os.write(descriptor, dialect.encode_reply(frame, request, zeros))


def main(kind: str, place: str) -> None:
    if kind == "rtu":
        descriptor = os.open(place, os.O_RDWR | os.O_NOCTTY)
        tty.setraw(descriptor)
        print("ready", flush=True)
        _serve(descriptor, ModbusRtu())
    with socket.create_server(("127.0.0.1", int(place))) as listener:
        print("ready", flush=True)
        while True:
            connection, _ = listener.accept()
            connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            with connection:
                _serve(connection.fileno(), ModbusTcp())


if __name__ == "__main__":
    main(*sys.argv[1:3])
