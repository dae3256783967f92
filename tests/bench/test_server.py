import asyncio
from collections.abc import Callable
from contextlib import suppress
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pyModbusTCP.client import ModbusClient

from gripperd.bench.modules import Modules
from gripperd.bench.rig import Rig
from gripperd.bench.server import BenchServer
from gripperd.drivers.bus import TcpAddress, open_bus
from gripperd.protocol.mbap import ModbusTcp
from gripperd.protocol.modbus import Write
from tests.interop.programs import needed

SOON = 60.0
"""Longest wait for something that must happen; no test takes this long. [s]"""


async def elsewhere(
    bench: BenchServer, talk: Callable[[ModbusClient], object], unit: int = 1
) -> object:
    """Let a client written by others talk to the bench, in a thread of its own."""
    host, _, port = bench.address.rpartition(":")

    def conversation() -> object:
        client = ModbusClient(host, int(port), unit, timeout=SOON, auto_open=True)
        try:
            return talk(client)
        finally:
            client.close()

    return await asyncio.to_thread(conversation)


async def mbpoll(bench: BenchServer, value: int | None = None) -> tuple[int, str]:
    """Let libmodbus read two holding registers, or write the first of them."""
    host, _, port = bench.address.rpartition(":")
    options = ["-m", "tcp", "-p", port, "-a", "1", "-0", "-r", "0", "-t", "4", "-1"]
    what = [host, str(value)] if value is not None else ["-c", "2", host]
    process = await asyncio.create_subprocess_exec(
        needed("mbpoll"),
        *options,
        *what,
        stdout=asyncio.subprocess.PIPE,
        stderr=asyncio.subprocess.STDOUT,
    )
    output, _ = await process.communicate()
    return process.returncode or 0, output.decode()


async def test_a_client_of_others_reads_what_gripperd_wrote(
    bench: BenchServer, bench_address: TcpAddress
) -> None:
    async with open_bus(bench_address) as bus:
        await bus.up.wait()
        await bus.ask(Write(1, 0, (10_700,)))
    read = await elsewhere(bench, lambda client: client.read_holding_registers(0, 8))
    assert read == [10_700, 0, 0, 0, 0, 0, 0, 0]


async def test_a_client_of_others_drives_the_valve(
    bench: BenchServer, rig: Rig
) -> None:
    def talk(client: ModbusClient) -> object:
        return (
            client.write_single_register(0, 10_700),
            client.write_multiple_registers(1, [1, 2, 3]),
            client.read_holding_registers(0, 4),
        )

    assert await elsewhere(bench, talk) == (True, True, [10_700, 1, 2, 3])
    assert rig.plant.current == pytest.approx(0.0107)


async def test_a_client_of_others_sees_the_sensors(bench: BenchServer) -> None:
    read = await elsewhere(
        bench, lambda client: client.read_input_registers(0, 3), unit=2
    )
    assert read == pytest.approx([4000, 17_600, 4000], abs=40)


@pytest.mark.parametrize(
    ("unit", "pdu", "code"),
    [
        pytest.param(1, bytes([1, 0, 0, 0, 1]), 1, id="function"),
        pytest.param(1, bytes([3, 0, 8, 0, 1]), 2, id="address"),
        pytest.param(1, bytes([6, 0, 0, 0x4E, 0x21]), 3, id="20001"),
        pytest.param(1, bytes([3, 0, 0, 0, 126]), 3, id="count"),
        pytest.param(9, bytes([3, 0, 0, 0, 1]), 11, id="unit"),
    ],
)
async def test_a_client_of_others_is_refused_with_the_right_exception(
    bench: BenchServer, rig: Rig, unit: int, pdu: bytes, code: int
) -> None:
    def talk(client: ModbusClient) -> object:
        return client.custom_request(pdu), client.last_except

    assert await elsewhere(bench, talk, unit) == (None, code)
    assert rig.plant.current == 0.0


async def test_mbpoll_writes_and_reads(bench: BenchServer, rig: Rig) -> None:
    status, output = await mbpoll(bench, 10_700)
    assert (status, "Written 1 references." in output) == (0, True), output
    status, output = await mbpoll(bench)
    assert (status, "[0]: \t10700" in output) == (0, True), output
    assert rig.plant.current == pytest.approx(0.0107)


async def test_mbpoll_is_refused_what_the_module_cannot_drive(
    bench: BenchServer, rig: Rig
) -> None:
    status, output = await mbpoll(bench, 20_001)
    assert (status, "Illegal data value" in output) == (1, True), output
    assert rig.plant.current == 0.0


async def test_clients_are_served_side_by_side(
    bench: BenchServer, bench_address: TcpAddress
) -> None:
    async with open_bus(bench_address) as first, open_bus(bench_address) as second:
        await first.up.wait()
        await second.up.wait()
        for value in range(50):
            await first.ask(Write(1, 1, (value,)))
            await second.ask(Write(1, 2, (value,)))
    read = await elsewhere(bench, lambda client: client.read_holding_registers(1, 2))
    assert read == [49, 49]


async def test_requests_may_come_in_any_pieces(bench: BenchServer) -> None:
    host, _, port = bench.address.rpartition(":")
    reader, writer = await asyncio.open_connection(host, int(port))
    one, two = (Write(1, 0, (value,)) for value in (5000, 6000))
    line = ModbusTcp()
    stream = line.encode(one, 1) + line.encode(two, 2)
    for cuts in ((0, 24), (0, 3, 8, 20, 24)):
        for start, end in pairwise(cuts):
            writer.write(stream[start:end])
            await writer.drain()
            await asyncio.sleep(0.002)
        async with asyncio.timeout(SOON):
            replies = await reader.readexactly(24)
        assert line.decode(one, 1, replies[:12]) == (5000,)
        assert line.decode(two, 2, replies[12:]) == (6000,)
    writer.close()
    await writer.wait_closed()


async def test_who_speaks_no_modbus_is_hung_up_on_alone(
    bench: BenchServer, bench_address: TcpAddress
) -> None:
    reader, writer = await asyncio.open_connection(
        bench_address.host, bench_address.port
    )
    async with open_bus(bench_address) as bus:
        await bus.up.wait()
        writer.write(b"GET / HTTP/1.1\r\n\r\n")
        with suppress(ConnectionResetError):
            async with asyncio.timeout(SOON):
                assert await reader.read() == b""
        assert await bus.ask(Write(1, 0, (4000,))) == (4000,)
        assert bus.statistics.connections == 1
    writer.close()


def test_the_rig_lives_in_the_time_it_is_given(modules: Modules) -> None:
    now = 100.0
    bench = BenchServer(modules, lambda: now)
    bench.answer(ModbusTcp().encode(Write(1, 0, (10_700,)), 1))
    now = 102.0
    bench.catch_up()
    plant = modules.rig.plant
    assert plant.time == pytest.approx(2.0)
    # 10.7 mA is 209.4 kPa, reached after two seconds.
    assert plant.pressure == pytest.approx(209_375, rel=1e-3)


plausible = st.one_of(st.sampled_from([0, 1, 2, 3, 4, 6, 16]), st.integers(0, 255))
bodies = st.lists(plausible, min_size=2, max_size=30).map(bytes)


def test_no_request_breaks_the_bench(modules: Modules) -> None:
    bench = BenchServer(modules, lambda: 0.0)

    @given(bodies)
    def ask(body: bytes) -> None:
        frame = b"\0\1\0\0" + len(body).to_bytes(2) + body
        reply = bench.answer(frame)
        assert reply[:2] == frame[:2]
        assert reply[6] == frame[6]
        assert reply[7] & 0x7F == frame[7] & 0x7F

    ask()
