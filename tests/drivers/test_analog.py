from collections.abc import Awaitable, Callable
from dataclasses import replace

import pytest

from gripperd.bench.faults import BenchFaults
from gripperd.bench.rig import Rig
from gripperd.bench.sensors import Channel
from gripperd.bench.server import BenchServer
from gripperd.config.module_library import ModuleLibrary
from gripperd.drivers.analog import AnalogRig, InputWiring, OutputWiring, SensorWiring
from gripperd.drivers.bus import ModbusBus, TcpAddress, open_bus
from gripperd.errors import DeviceRefused, InputError, LinkLost
from gripperd.protocol.live_zero import LoopScale
from gripperd.protocol.mbap import ModbusTcp
from gripperd.protocol.modbus import Read, Refusal
from gripperd.signals import ABSENT, Quality

from .peer import Behaviour, Line, connected

Wired = Callable[[ModbusBus], AnalogRig]
Eventually = Callable[[Callable[[], bool]], Awaitable[None]]
MODULES = ModuleLibrary()
OUTPUT = OutputWiring(module=MODULES.output("waveshare_ao_8ch"), unit=1, channel=0)


TCP = ModbusTcp()


async def test_what_is_written_is_read_back_with_every_sensor(
    bench_address: TcpAddress, rig: Rig, wired: Wired
) -> None:
    async with open_bus(bench_address) as bus:
        await bus.up.wait()
        analog = wired(bus)
        await analog.write(0.0107)
        pressure, opening = rig.plant.pressure, rig.plant.opening
        measured = await analog.read(12.5)
    assert measured.time == 12.5
    assert measured.current.value == pytest.approx(0.0107)
    assert rig.plant.current == pytest.approx(0.0107)
    assert measured.pressure.value is not None
    assert measured.opening.value is not None
    # The jaws are closing meanwhile; five sigma of 0.05 %.
    assert pressure - 1500 < measured.pressure.value < rig.plant.pressure + 1500
    assert rig.plant.opening - 2.5e-4 < measured.opening.value < opening + 2.5e-4
    assert measured.grip.value == pytest.approx(0.0, abs=0.25)


async def test_a_cut_sensor_wire_is_a_bad_reading_not_a_zero(
    bench_address: TcpAddress, rig: Rig, wired: Wired
) -> None:
    rig.plant.faults = BenchFaults(broken=frozenset({Channel.GRIP}))
    async with open_bus(bench_address) as bus:
        await bus.up.wait()
        measured = await wired(bus).read(0.0)
    assert measured.grip.value is None
    assert measured.grip.quality is Quality.BAD
    assert "0.000 mA is below 3.6 mA" in measured.grip.cause
    assert measured.opening.quality is Quality.GOOD


async def test_without_sensors_there_is_the_current_alone(
    bench_address: TcpAddress,
) -> None:
    async with open_bus(bench_address) as bus:
        await bus.up.wait()
        measured = await AnalogRig(bus, OUTPUT, None).read(0.0)
        assert bus.statistics.requests == 1
    assert measured.current.value == 0.0
    assert measured.pressure == measured.opening == measured.grip == ABSENT


async def test_a_current_out_of_range_never_reaches_the_wire(
    bench_address: TcpAddress, wired: Wired
) -> None:
    async with open_bus(bench_address) as bus:
        await bus.up.wait()
        with pytest.raises(InputError, match=r"20\.1 mA is outside"):
            await wired(bus).write(0.0201)
        assert bus.statistics.requests == 0


async def test_another_channel_is_another_register(
    bench_address: TcpAddress, rig: Rig
) -> None:
    async with open_bus(bench_address) as bus:
        await bus.up.wait()
        spare = AnalogRig(bus, replace(OUTPUT, channel=7), None)
        await spare.write(0.0123)
        assert (await spare.read(0.0)).current.value == pytest.approx(0.0123)
    assert rig.plant.current == 0.0


async def test_the_last_channel_of_the_input_module_is_read(
    bench_address: TcpAddress,
) -> None:
    scale = LoopScale(
        current_low=0.004, current_high=0.020, value_low=0.0, value_high=1.0
    )
    sensors = {"grip": SensorWiring(channel=7, scale=scale)}
    inputs = InputWiring(
        module=MODULES.input("waveshare_ai_8ch"), unit=2, sensors=sensors
    )
    async with open_bus(bench_address) as bus:
        await bus.up.wait()
        measured = await AnalogRig(bus, OUTPUT, inputs).read(0.0)
    # Nothing is connected there.
    assert measured.grip.quality is Quality.BAD


async def test_a_module_that_is_not_there_is_an_error(
    bench_address: TcpAddress,
) -> None:
    async with open_bus(bench_address) as bus:
        await bus.up.wait()
        absent = AnalogRig(bus, replace(OUTPUT, unit=9), None)
        with pytest.raises(DeviceRefused, match="no response"):
            await absent.read(0.0)


async def test_a_lost_bench_is_an_error_not_an_old_value(
    bench: BenchServer,
    bench_address: TcpAddress,
    wired: Wired,
    eventually: Eventually,
) -> None:
    async with open_bus(bench_address) as bus:
        await bus.up.wait()
        analog = wired(bus)
        await analog.read(0.0)
        for client in tuple(bench.clients):
            client.abort()
        await eventually(lambda: not bus.up.is_set())
        with pytest.raises(LinkLost):
            await analog.read(1.0)


def refusing(unit: int, refusal: Refusal, times: int) -> Behaviour:
    """A module that is refused so often, and answers with zeros besides."""
    left = times

    def behave(line: Line, frame: bytes) -> None:
        nonlocal left
        request = TCP.decode_request(frame)
        assert not isinstance(request, Refusal)
        if request.unit == unit and left:
            left -= 1
            line.send(TCP.encode_refusal(frame, refusal))
            return
        # The range codes that are wanted are the only registers that are not zero.
        value = 2 if isinstance(request, Read) and request.address == 0x1000 else 0
        values = (value,) * request.count if isinstance(request, Read) else ()
        line.send(TCP.encode_reply(frame, request, values))

    return behave


@pytest.mark.parametrize("unit", [1, 2])
async def test_a_busy_module_is_read_once_more(unit: int, wired: Wired) -> None:
    async with connected(refusing(unit, Refusal.BUSY, times=1)) as (bus, peer):
        analog = wired(bus)
        measured = await analog.read(0.0)
        # The current, the range codes and the sensors, and one of them again.
        assert len(peer.requests) == 4
        await analog.read(1.0)
        assert len(peer.requests) == 6
    assert measured.current.quality is Quality.GOOD
    # It was read: 0 mA is a broken loop, not a refusal.
    assert "0.000 mA" in measured.grip.cause


async def test_a_busy_module_is_never_written_again(wired: Wired) -> None:
    async with connected(refusing(1, Refusal.BUSY, times=1)) as (bus, peer):
        with pytest.raises(DeviceRefused):
            await wired(bus).write(0.0107)
        assert len(peer.requests) == 1


async def test_an_input_module_that_refuses_leaves_the_valve_readable(
    wired: Wired,
) -> None:
    async with connected(refusing(2, Refusal.DEVICE_FAILURE, times=9)) as (bus, _):
        measured = await wired(bus).read(0.0)
    assert measured.current.value == 0.0
    for reading in (measured.pressure, measured.opening, measured.grip):
        assert reading.quality is Quality.BAD
        assert "device failure" in reading.cause
