"""The drivers against devices that others wrote, started as `contents` says."""

import asyncio

import pytest

from gripperd.config.module_library import ModuleLibrary
from gripperd.drivers.analog import AnalogRig, InputWiring, OutputWiring, SensorWiring
from gripperd.drivers.bus import ModbusBus, open_bus
from gripperd.errors import DeviceRefused, LinkError, ReplyTimeout
from gripperd.protocol.live_zero import LoopScale
from gripperd.protocol.modbus import Read, Refusal, Request, Table, Write, WriteCoil

from .conftest import OVER_RTU, Foreign
from .contents import BITS, REGISTERS, coil, discrete, holding, input_
from .programs import PATIENCE

UNIT = 1


@pytest.mark.parametrize(("address", "count"), [(100, 1), (4900, 100), (300, 125)])
async def test_registers_are_read_where_they_are(
    bus: ModbusBus, address: int, count: int
) -> None:
    places = range(address, address + count)
    for table, value in ((Table.HOLDING, holding), (Table.INPUT, input_)):
        read = await bus.ask(Read(UNIT, table, address, count))
        assert read == tuple(value(place) for place in places)


@pytest.mark.parametrize(("address", "count"), [(7, 1), (101, 13), (0, BITS)])
async def test_bits_are_read_where_they_are(
    bus: ModbusBus, address: int, count: int
) -> None:
    places = range(address, address + count)
    for table, value in ((Table.COILS, coil), (Table.DISCRETE, discrete)):
        read = await bus.ask(Read(UNIT, table, address, count))
        assert read == tuple(value(place) for place in places)


@pytest.mark.parametrize(
    "write",
    [
        pytest.param(Write(UNIT, 2001, (10_700,)), id="function 6"),
        pytest.param(Write(UNIT, 2011, (0xFFFF,), multiple=True), id="function 16"),
        pytest.param(Write(UNIT, 2021, (0x412B, 0x3333)), id="a float"),
        pytest.param(Write(UNIT, 2101, tuple(range(123))), id="as many as fit"),
    ],
)
async def test_a_write_changes_its_registers_and_no_other(
    bus: ModbusBus, write: Write
) -> None:
    first, after = write.address - 1, write.address + len(write.values)
    assert await bus.ask(write) == write.values
    read = await bus.ask(Read(UNIT, Table.HOLDING, write.address, len(write.values)))
    assert read == write.values
    for place in (first, after):
        neighbour = Read(UNIT, Table.HOLDING, place)
        assert await bus.ask(neighbour) == (holding(place),)


async def test_a_coil_is_set_and_cleared(bus: ModbusBus) -> None:
    place = 1000
    for on in (True, False):
        await bus.ask(WriteCoil(UNIT, place, on))
        read = await bus.ask(Read(UNIT, Table.COILS, place - 1, 3))
        assert read == (coil(place - 1), on, coil(place + 1))


@pytest.mark.parametrize(
    "request_",
    [
        pytest.param(Read(UNIT, Table.HOLDING, REGISTERS), id="register"),
        pytest.param(Read(UNIT, Table.INPUT, REGISTERS - 1, 2), id="last but one"),
        pytest.param(Read(UNIT, Table.COILS, BITS), id="coil"),
        pytest.param(Write(UNIT, REGISTERS, (1,)), id="write"),
        pytest.param(Write(UNIT, REGISTERS, (1, 2)), id="write of two"),
    ],
)
async def test_a_refusal_is_understood_and_leaves_the_line_sound(
    bus: ModbusBus, request_: Request
) -> None:
    opened = bus.statistics.connections
    with pytest.raises(DeviceRefused) as refused:
        await bus.ask(request_)
    assert refused.value.exception_code == Refusal.ILLEGAL_ADDRESS
    assert await bus.ask(Read(UNIT, Table.HOLDING, 100)) == (holding(100),)
    assert bus.statistics.connections == opened


async def test_fifty_at_once_each_get_their_own_answer(bus: ModbusBus) -> None:
    asking = (bus.ask(Read(UNIT, Table.HOLDING, 100 + n)) for n in range(50))
    assert await asyncio.gather(*asking) == [(holding(100 + n),) for n in range(50)]


@pytest.mark.parametrize("foreign", OVER_RTU, indirect=True, scope="module")
async def test_nobody_answers_for_another_unit_of_a_serial_line(
    bus: ModbusBus,
) -> None:
    with pytest.raises(ReplyTimeout):
        await bus.ask(Read(UNIT + 1, Table.HOLDING, 100))
    assert await bus.ask(Read(UNIT, Table.HOLDING, 100)) == (holding(100),)


async def test_a_rig_is_set_up_read_and_driven(bus: ModbusBus) -> None:
    library = ModuleLibrary()
    output = library.output("waveshare_ao_8ch")
    inputs = library.input("waveshare_ai_8ch")
    scale = LoopScale(
        current_low=0.004, current_high=0.020, value_low=0.0, value_high=600e3
    )
    rig = AnalogRig(
        bus,
        OutputWiring(module=output, unit=UNIT, channel=0),
        InputWiring(
            module=inputs,
            unit=UNIT,
            sensors={"pressure": SensorWiring(channel=5, scale=scale)},
            set_range=True,
        ),
    )
    before = await rig.read(0.0)
    # The sixth input register holds 8005, which are µA.
    assert before.pressure.value == pytest.approx((8.005 - 4) / 16 * 600e3)
    assert before.current.value == pytest.approx(0.001)
    await rig.write(0.0107)
    assert await bus.ask(Read(UNIT, Table.HOLDING, 0)) == (10_700,)
    assert (await rig.read(1.0)).current.value == pytest.approx(0.0107)
    # Its range code had to be set: 2 is 0 to 20 mA.
    assert await bus.ask(Read(UNIT, Table.HOLDING, 0x1005)) == (2,)


async def test_a_device_that_dies_and_comes_back_is_found_again(
    foreign: Foreign,
) -> None:
    request = Read(UNIT, Table.HOLDING, 100)
    with foreign() as (address, started):
        async with open_bus(address) as bus, asyncio.timeout(PATIENCE):
            with started():
                await bus.up.wait()
                assert await bus.ask(request) == (holding(100),)
            with pytest.raises(LinkError):
                await bus.ask(request)
            with started():
                await bus.up.wait()
                assert await bus.ask(request) == (holding(100),)
