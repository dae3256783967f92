import asyncio
import shutil
import sys
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import TypeAlias

import pytest

from gripperd.drivers.bus import ModbusBus, RtuAddress, TcpAddress, open_bus
from gripperd.protocol.modbus import Read, Table

from .programs import PATIENCE, cable, compiled, free_port, needed, running

HERE = Path(__file__).parent
NODE = HERE / "node"
BAUD = 115_200
OVER_TCP = ("libmodbus_server-tcp", "pymodbustcp-tcp", "modbus_serial-tcp")
OVER_RTU = ("libmodbus_server-rtu", "modbus_serial-rtu")
"""Fixtures that give a program, each with a line that it can serve."""

Device: TypeAlias = tuple[
    TcpAddress | RtuAddress, Callable[[], AbstractContextManager[None]]
]
"""Where a device is found once it is started, and what starts it."""
Foreign: TypeAlias = Callable[[], AbstractContextManager[Device]]
"""Makes a place for a device that nobody here wrote."""


@pytest.fixture(scope="session")
def anyio_backend() -> object:
    """The loop of the daemon, kept as long as a bus is open."""
    return "asyncio", {"use_uvloop": True}


@pytest.fixture(scope="session")
def libmodbus(tmp_path_factory: pytest.TempPathFactory) -> Callable[[Path], Path]:
    """Compiles a program on libmodbus."""

    def compile_(source: Path) -> Path:
        program = compiled(source, tmp_path_factory.mktemp("libmodbus"))
        if program is None:
            pytest.skip("no libmodbus (apt-get install gcc libc6-dev libmodbus-dev)")
        return program

    return compile_


@pytest.fixture(scope="session")
def modbus_serial() -> tuple[str, ...]:
    """Command that starts a device on modbus-serial."""
    node = shutil.which("node")
    if node is None or not (NODE / "node_modules").is_dir():
        pytest.skip("no modbus-serial (npm ci --prefix tests/interop/node)")
    return node, str(NODE / "server.js")


@pytest.fixture(scope="session")
def pymodbustcp() -> tuple[str, ...]:
    """Command that starts a device on pyModbusTCP."""
    return sys.executable, "-m", "tests.interop.pymodbustcp_server"


@pytest.fixture(scope="session")
def libmodbus_server(libmodbus: Callable[[Path], Path]) -> tuple[str, ...]:
    """Command that starts a device on libmodbus."""
    return (str(libmodbus(HERE / "libmodbus_server.c")),)


@pytest.fixture(scope="session")
def socat() -> None:
    needed("socat")


@pytest.fixture(scope="module", params=[*OVER_TCP, *OVER_RTU])
def foreign(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Foreign:
    """Devices that nobody here wrote, on either kind of line."""
    program, line = request.param.split("-")
    command = request.getfixturevalue(program)

    @contextmanager
    def over_tcp() -> Iterator[Device]:
        port = free_port()
        address = TcpAddress(host="127.0.0.1", port=port, timeout=PATIENCE)
        yield address, lambda: running(*command, "tcp", str(port))

    @contextmanager
    def over_rtu() -> Iterator[Device]:
        with cable(tmp_path_factory.mktemp("cable")) as (near, far):
            # The time-out is also how long a port is listened to before it is used.
            address = RtuAddress(port=str(near), baud=BAUD, timeout=3.0)
            yield address, lambda: running(*command, "rtu", str(far), str(BAUD))

    if line == "tcp":
        return over_tcp
    request.getfixturevalue("socat")
    return over_rtu


@pytest.fixture(scope="module")
async def bus(foreign: Foreign) -> AsyncIterator[ModbusBus]:
    """An open bus to one of them."""
    with foreign() as (address, started), started():
        async with open_bus(address) as bus:
            async with asyncio.timeout(PATIENCE):
                await bus.up.wait()
            # A serial line takes no write before a read has shown that nothing echoes.
            await bus.ask(Read(1, Table.HOLDING, 0))
            yield bus
