import pytest

from gripperd.config.module_library import ModuleLibrary
from gripperd.drivers.analog import AnalogRig, InputWiring, OutputWiring, SensorWiring
from gripperd.drivers.bus import ModbusBus
from gripperd.protocol.live_zero import LoopScale
from gripperd.protocol.modbus import Read, Table
from gripperd.signals import Measurement, Quality

from .device import Device, holding, on_the_wire, placed

MODULES = ModuleLibrary()
GAUGE = LoopScale(value_low=0.0, value_high=600e3)
Registers = dict[tuple[Table, int], int]

MIDDLE = 0x8000
"""12 mA on 4-20 mA over 16 bits, half a count too high."""


def wired(module: str, first: int = 0, second: int = 2) -> InputWiring:
    return InputWiring(
        module=MODULES.input(module),
        unit=2,
        sensors={
            "pressure": SensorWiring(channel=first, scale=GAUGE),
            "grip": SensorWiring(channel=second, scale=GAUGE),
        },
    )


def rig(bus: ModbusBus, inputs: InputWiring) -> AnalogRig:
    module = MODULES.output("moxa_e1241")
    # Far from the registers of the inputs.
    return AnalogRig(bus, OutputWiring(module=module, unit=1, channel=20), inputs)


VALVE = holding(40, 0x4080, 0)


async def measured(registers: Registers, inputs: InputWiring) -> Measurement:
    async with on_the_wire(Device(VALVE | registers)) as bus:
        return await rig(bus, inputs).read(0.0)


def adam_6217(**changed: Registers) -> Registers:
    plain = holding(0, MIDDLE, 0, MIDDLE) | holding(100, *[0] * 6)
    registers = plain | holding(200, 0x180, 0x180, 0x180)
    for change in changed.values():
        registers |= change
    return registers


def e1240(*status: int) -> Registers:
    values = placed(Table.INPUT, 0, MIDDLE, 0, MIDDLE)
    return values | holding(0x18, 1, 1, 1) | placed(Table.INPUT, 0x3C, *status)


@pytest.mark.parametrize(
    ("module", "registers"),
    [
        ("adam_6217", adam_6217()),
        ("adam_6017", adam_6217()),
        ("moxa_e1240", e1240(0, 0, 0)),
        ("adam_4017_plus", holding(0, MIDDLE, 0, MIDDLE) | holding(200, 7, 7, 7)),
        (
            "icpdas_m_7017",
            placed(Table.INPUT, 0, 12_000, 0, 12_000)
            | placed(Table.COILS, 268, 1)
            | placed(Table.DISCRETE, 128, 0, 1, 0),
        ),
        ("wago_750_455", placed(Table.INPUT, 0, 0x3FF8, 3, 0x3FF8)),
    ],
)
async def test_half_of_the_loop_is_half_of_the_span(
    module: str, registers: Registers
) -> None:
    sample = await measured(registers, wired(module))
    for reading in (sample.pressure, sample.grip):
        assert reading.quality is Quality.GOOD
        assert reading.value == pytest.approx(300e3, abs=100.0)


@pytest.mark.parametrize(
    ("module", "registers", "cause"),
    [
        ("adam_6217", adam_6217(status=holding(104, 1 << 3)), "open circuit"),
        ("adam_6217", adam_6217(status=holding(104, 1 << 1)), "over the range"),
        ("adam_6017", adam_6217(status=holding(104, 1 << 2)), "under the range"),
        ("adam_6017", adam_6217(status=holding(104, 1 << 7)), "converter has failed"),
        ("moxa_e1240", e1240(0, 0, 1), "burn-out"),
        ("moxa_e1240", e1240(0, 0, 2), "over the range"),
        ("moxa_e1240", e1240(0, 0, 3), "under the range"),
        (
            "icpdas_m_7017",
            placed(Table.INPUT, 0, 12_000, 0, 12_000)
            | placed(Table.COILS, 268, 1)
            | placed(Table.DISCRETE, 128, 0, 0, 1),
            "over or under the range",
        ),
        ("wago_750_455", placed(Table.INPUT, 0, 0x3FF8, 0, 0x0003), "broken wire"),
        ("wago_750_455", placed(Table.INPUT, 0, 0x3FF8, 0, 0x7FFB), "over the range"),
        ("wago_750_455", placed(Table.INPUT, 0, 0x3FF8, 0, 0x7FFF), "over the range"),
        ("wago_750_455", placed(Table.INPUT, 0, 0x3FF8, 0, 0x4001), "reports an error"),
        (
            "adam_4017_plus",
            holding(0, MIDDLE, 0, 0xFFFF) | holding(200, 7, 7, 7),
            "20.000 mA or more, the most that it can say",
        ),
    ],
)
async def test_what_the_module_says_against_a_channel_is_a_bad_reading(
    module: str, registers: Registers, cause: str
) -> None:
    sample = await measured(registers, wired(module))
    assert sample.pressure.quality is Quality.GOOD
    assert sample.grip.value is None
    assert sample.grip.quality is Quality.BAD
    assert cause in sample.grip.cause
    assert f"{module} says of channel 2" in sample.grip.cause


async def test_a_module_that_cannot_tell_a_cut_wire_is_warned_of() -> None:
    for module, warned in (("adam_4017_plus", True), ("adam_6217", False)):
        async with on_the_wire(Device(VALVE)) as bus:
            warnings = "; ".join(rig(bus, wired(module)).warnings)
        assert ("in 4-20mA a cut wire reads as 4 mA" in warnings) is warned


async def test_all_sensors_are_read_in_one_request() -> None:
    device = Device(VALVE | adam_6217() | holding(3, 0, 0, MIDDLE))
    device.registers |= holding(106, *[0] * 6) | holding(203, 0x180, 0x180, 0x180)
    async with on_the_wire(device) as bus:
        analog = rig(bus, wired("adam_6217", 2, 5))
        await analog.read(0.0)
        del device.requests[:]
        await analog.read(1.0)
    assert [each for each in device.requests if each.unit == 2] == [
        Read(2, Table.HOLDING, 2, 4),
        Read(2, Table.HOLDING, 104, 8),
    ]


async def test_a_wrong_range_makes_the_sensors_bad_and_leaves_the_valve_driven() -> (
    None
):
    device = Device(VALVE | adam_6217(codes=holding(202, 0x182)))
    async with on_the_wire(device) as bus:
        analog = rig(bus, wired("adam_6217"))
        sample = await analog.read(0.0)
        await analog.write(0.0107)
        device.registers |= holding(202, 0x180)
        mended = await analog.read(1.0)
    for sensor in (sample.pressure, sample.grip):
        assert (sensor.value, sensor.quality) == (None, Quality.BAD)
        assert "channel 2 of adam_6217, unit 2, has range code 0x0182" in sensor.cause
    assert mended.current.value == pytest.approx(0.0107)
    assert mended.grip.quality is Quality.GOOD


async def test_channels_that_nobody_uses_may_have_any_range() -> None:
    registers = adam_6217(codes=holding(201, 0x182))
    sample = await measured(registers, wired("adam_6217"))
    assert sample.grip.quality is Quality.GOOD


async def test_the_facts_say_whether_the_module_has_confirmed_its_range() -> None:
    async with on_the_wire(Device(VALVE | adam_6217())) as bus:
        analog = rig(bus, wired("adam_6217"))
        assert analog.facts.input is not None
        assert not analog.facts.input.range_verified
        await analog.read(0.0)
        assert analog.facts.input.range_verified
