"""Clients that others wrote against the simulated bench."""

import asyncio
import re
from collections import Counter
from collections.abc import AsyncIterator, Callable
from dataclasses import dataclass, replace
from pathlib import Path

import pytest

from gripperd.bench.modbus_speaker import RtuSpeaker
from gripperd.bench.modules import Modules
from gripperd.bench.rig import Rig
from gripperd.bench.serial_server import serve_serial
from gripperd.bench.server import serve_bench
from gripperd.config.module_library import ModuleLibrary

from .conftest import BAUD
from .programs import cable, needed

OUTPUT_UNIT, INPUT_UNIT, NO_UNIT = 1, 2, 9
PLACES = 99
"""Addresses that the random test client of libmodbus works on, from 0."""
EXAMPLE = Path("/usr/share/doc/libmodbus-dev/examples/random-test-client.c")
WHERE = 'modbus_new_tcp("127.0.0.1", 1502)'
DEBUG = "modbus_set_debug(ctx, TRUE);"
"""What is replaced in it: where it connects; unit and patience are added."""


@dataclass(frozen=True)
class Line:
    """How others are told where the bench is."""

    mbpoll: tuple[str, ...]
    place: str
    libmodbus: str
    """Expression in C that makes a context."""


@pytest.fixture
def modules(rig: Rig) -> Modules:
    """As many outputs as the random test client writes, each taking any number."""
    library = ModuleLibrary()
    module = library.output("waveshare_ao_8ch")
    wide = replace(
        module,
        channels=PLACES,
        ranges={"wide": replace(module.range(), count_high=65_535.0)},
    )
    inputs = library.input("waveshare_ai_8ch")
    return Modules(rig, (wide, OUTPUT_UNIT), (inputs, INPUT_UNIT))


@pytest.fixture(params=["tcp", "pty", "cable"])
async def line(
    request: pytest.FixtureRequest, modules: Modules, tmp_path: Path
) -> AsyncIterator[Line]:
    """The bench on Modbus TCP, or on RTU: at its own pty, or at an end of a cable."""
    if request.param == "tcp":
        async with serve_bench(modules, "127.0.0.1", 0) as bench:
            yield _tcp(*bench.address.split(":"))
    elif request.param == "pty":
        port = tmp_path / "line"
        async with serve_serial(RtuSpeaker(modules), port, pace=None):
            yield _rtu(port)
    else:
        request.getfixturevalue("socat")
        with cable(tmp_path) as (near, far):
            async with serve_serial(RtuSpeaker(modules), far, pace=None):
                yield _rtu(near)


def _tcp(host: str, port: str) -> Line:
    return Line(
        mbpoll=("-m", "tcp", "-p", port),
        place=host,
        libmodbus=f'modbus_new_tcp("{host}", {port})',
    )


def _rtu(port: Path) -> Line:
    return Line(
        mbpoll=("-m", "rtu", "-b", f"{BAUD}", "-P", "none"),
        place=str(port),
        libmodbus=f"modbus_new_rtu(\"{port}\", {BAUD}, 'N', 8, 1)",
    )


async def said(*command: str) -> tuple[int, str]:
    """Exit status of a program, and all that it said: results, then errors."""
    process = await asyncio.create_subprocess_exec(
        *command, stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.PIPE
    )
    output, errors = await process.communicate()
    return process.returncode or 0, f"{output.decode()}\n{errors.decode()}"


async def polled(
    line: Line, unit: int, table: str, *values: str, start: int = 0
) -> tuple[int, str]:
    """Let mbpoll read three registers, or write; 3: input, 4: holding, 0: coils."""
    where = ("-a", str(unit), "-0", "-r", str(start), "-t", table, "-o", "10")
    what = (line.place, *values) if values else ("-c", "3", line.place)
    return await said(needed("mbpoll"), *line.mbpoll, *where, "-1", "-q", *what)


def registers(text: str) -> list[int]:
    return [
        int(value) for value in re.findall(r"^\[\d+\]:\s+(\d+)", text, re.MULTILINE)
    ]


async def test_mbpoll_drives_the_valve_and_reads_it_back(line: Line, rig: Rig) -> None:
    status, text = await polled(line, OUTPUT_UNIT, "4", "35062")
    assert status == 0, text
    # 35062 of 65535 is 10.7 mA of 20.
    assert rig.plant.current == pytest.approx(0.0107, abs=1e-6)
    status, text = await polled(line, OUTPUT_UNIT, "4", "35062", "1", "65535")
    assert status == 0, text
    status, text = await polled(line, OUTPUT_UNIT, "4")
    assert (status, registers(text)) == (0, [35_062, 1, 65_535])


async def test_mbpoll_reads_the_sensors(line: Line) -> None:
    status, text = await polled(line, INPUT_UNIT, "3")
    assert status == 0, text
    # No pressure, jaws open at 85 mm of 100, no force.
    assert registers(text) == pytest.approx([4000, 17_600, 4000], abs=40)


@pytest.mark.parametrize(
    ("table", "values", "start", "refusal"),
    [
        pytest.param("0", (), 0, "Illegal function", id="coils"),
        pytest.param("4", (), PLACES, "Illegal data address", id="read"),
        pytest.param("4", ("1",), PLACES, "Illegal data address", id="write"),
    ],
)
async def test_mbpoll_is_told_why_it_is_refused(
    line: Line, table: str, values: tuple[str, ...], start: int, refusal: str
) -> None:
    status, text = await polled(line, OUTPUT_UNIT, table, *values, start=start)
    assert status == 1
    assert refusal in text


@pytest.fixture
def random_test_client(
    line: Line, libmodbus: Callable[[Path], Path], tmp_path: Path
) -> Path:
    """The random test client that libmodbus is tested with, told where the bench is."""
    if not EXAMPLE.exists():
        pytest.skip(f"no {EXAMPLE} (apt-get install libmodbus-dev)")
    text = EXAMPLE.read_text()
    assert WHERE in text
    assert DEBUG in text
    patient = "modbus_set_response_timeout(ctx, 5, 0);"
    chosen = f"modbus_set_slave(ctx, {OUTPUT_UNIT});"
    source = tmp_path / "client.c"
    text = text.replace(WHERE, line.libmodbus)
    source.write_text(text.replace(DEBUG, f"{patient} {chosen} {DEBUG}"))
    return libmodbus(source)


@pytest.mark.parametrize("line", ["tcp", "pty", "cable"], indirect=True)
async def test_libmodbus_believes_all_that_the_bench_can_do_and_is_refused_the_rest(
    random_test_client: Path,
) -> None:
    status, text = await said(str(random_test_client))
    assert status == 0
    # It writes and reads back random registers at every place, one and all that follow.
    # The bench has no coils, and no function that writes and reads at once.
    failures = Counter(re.findall(r"^ERROR (\w+) \(-1\)", text, re.MULTILINE))
    assert failures == {
        "modbus_write_bit": PLACES,
        "modbus_write_bits": PLACES,
        "modbus_read_and_write_registers": PLACES,
    }
    assert text.count("ERROR Illegal function") == 3 * PLACES
    assert f"Test: {3 * PLACES} FAILS" in text
