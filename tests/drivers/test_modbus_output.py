from dataclasses import replace

import pytest

from gripperd.config.module_library import ModuleLibrary
from gripperd.drivers.analog import AnalogRig, OutputWiring, WatchdogSettings
from gripperd.drivers.bus import ModbusBus
from gripperd.drivers.facts import WatchdogState
from gripperd.errors import InputError, ModuleMismatch, WatchdogTripped
from gripperd.protocol.modbus import Read, Table, Write, WriteCoil
from gripperd.signals import Quality

from .device import Device, holding, on_the_wire, placed

MODULES = ModuleLibrary()
KEPT = WatchdogSettings(timeout=2.0, safe_current=None)


def wired(module: str, channel: int = 0) -> OutputWiring:
    return OutputWiring(module=MODULES.output(module), unit=1, channel=channel)


def rig(bus: ModbusBus, output: OutputWiring) -> AnalogRig:
    return AnalogRig(bus, output, None)


def adam_6224(*codes: int) -> Device:
    """Four channels, all at 0 counts, nothing wrong."""
    registers = holding(0, 0, 0, 0, 0) | holding(100, *[0] * 8)
    return Device(
        registers | holding(200, *codes or [0x180] * 4) | holding(410, *[0] * 4)
    )


def wago() -> Device:
    watchdog = holding(0x1000, 100) | holding(0x1006, 0) | holding(0x100A, 0)
    return Device(holding(0x200, 0, 0) | watchdog)


@pytest.mark.parametrize(
    ("module", "registers", "write"),
    [
        ("brainboxes_ed_560", holding(0x60, 0x31), (0x20, (0x3333, 0x412B))),
        ("moxa_e1241", {}, (0, (0x412B, 0x3333))),
    ],
)
async def test_a_float_is_written_in_one_request(
    module: str,
    registers: dict[tuple[Table, int], int],
    write: tuple[int, tuple[int, int]],
) -> None:
    device = Device(registers | holding(write[0], 0, 0))
    async with on_the_wire(device) as bus:
        analog = rig(bus, wired(module))
        await analog.read(0.0)
        await analog.write(0.0107)
        measured = await analog.read(1.0)
    assert device.writes == [Write(1, *write)]
    assert measured.current.value == pytest.approx(0.0107, rel=1e-7)


async def test_a_float_that_is_no_number_is_a_bad_current() -> None:
    device = Device(holding(0, 0x7FC0, 0))
    async with on_the_wire(device) as bus:
        measured = await rig(bus, wired("moxa_e1241")).read(0.0)
    assert measured.current.quality is Quality.BAD


async def test_another_channel_is_another_pair_of_registers() -> None:
    device = Device(holding(0, *[0] * 8))
    async with on_the_wire(device) as bus:
        await rig(bus, wired("moxa_e1241", 3)).write(0.004)
    assert device.writes == [Write(1, 6, (0x4080, 0))]


async def test_an_output_image_is_read_back_where_it_stands() -> None:
    device = wago()
    device.registers |= holding(0x200, 0x3598)
    async with on_the_wire(device) as bus:
        measured = await rig(bus, wired("wago_750_554")).read(0.0)
    # 1715 steps of 16 mA / 4095 above 4 mA.
    assert measured.current.value == pytest.approx(0.004 + 0.016 * 1715 / 4095)


async def test_a_range_that_is_not_the_wanted_one_is_refused_and_left_alone() -> None:
    device = adam_6224(0x180, 0x182, 0x180, 0x180)
    async with on_the_wire(device) as bus:
        analog = rig(bus, wired("adam_6224", 1))
        with pytest.raises(ModuleMismatch) as refused:
            await analog.read(0.0)
        # What was found stands against driving the output, too.
        with pytest.raises(ModuleMismatch):
            await analog.write(0.0107)
        assert not device.writes
        device.registers |= holding(201, 0x180)
        assert (await analog.read(1.0)).current.value == 0.004
        await analog.write(0.0107)
    assert device.writes == [Write(1, 1, (1715,))]
    assert str(refused.value) == (
        "channel 1 of adam_6224, unit 1, has range code 0x0182 (0-20mA), 0x0180"
        " (4-20mA) is wanted: set holding register 201 = 384, or say"
        " `set_range: true` to have it done"
    )


async def test_a_range_is_set_when_told_to() -> None:
    device = adam_6224(0x143, 0x180, 0x180, 0x180)
    async with on_the_wire(device) as bus:
        analog = rig(bus, replace(wired("adam_6224"), set_range=True))
        await analog.read(0.0)
        assert analog.facts.output.range_verified
    assert device.writes == [Write(1, 200, (0x180,))]


async def test_a_range_that_cannot_be_set_is_noticed() -> None:
    device = adam_6224(0x182, 0x180, 0x180, 0x180)
    device.frozen = {(Table.HOLDING, 200)}
    async with on_the_wire(device) as bus:
        with pytest.raises(ModuleMismatch, match="was written and does not hold"):
            await rig(bus, replace(wired("adam_6224"), set_range=True)).read(0.0)


async def test_the_other_range_is_another_scale() -> None:
    device = adam_6224(*[0x182] * 4)
    async with on_the_wire(device) as bus:
        wiring = replace(wired("adam_6224"), range_name="0-20mA")
        analog = rig(bus, wiring)
        await analog.read(0.0)
        await analog.write(0.0107)
    assert device.writes == [Write(1, 0, (2191,))]


async def test_counts_of_another_format_are_never_written() -> None:
    device = Device(holding(0, 0) | holding(0x60, 0x31) | holding(0x80, 1))
    async with on_the_wire(device) as bus:
        analog = rig(bus, wired("brainboxes_ed_560_int"))
        with pytest.raises(ModuleMismatch, match="holding register 128 is 1, 0 is"):
            await analog.read(0.0)
        with pytest.raises(ModuleMismatch):
            await analog.write(0.0107)
    assert not device.writes


async def test_an_open_loop_is_a_bad_current_with_its_cause() -> None:
    device = adam_6224()
    device.registers |= holding(102, 0b1000)
    async with on_the_wire(device) as bus:
        first = await rig(bus, wired("adam_6224", 0)).read(0.0)
        second = await rig(bus, wired("adam_6224", 1)).read(0.0)
    assert first.current.quality is Quality.GOOD
    assert second.current.quality is Quality.BAD
    assert "no output current, the loop is open" in second.current.cause


@pytest.mark.parametrize("count", [65_535, 4500])
async def test_a_read_back_that_no_output_can_give_is_not_believed(count: int) -> None:
    # 4095 counts are 20 mA; 65535 would be 260 mA.
    device = adam_6224()
    device.registers |= holding(0, count)
    async with on_the_wire(device) as bus:
        sample = await rig(bus, wired("adam_6224", 0)).read(0.0)
    assert (sample.current.value, sample.current.quality) == (None, Quality.BAD)
    assert "which it cannot give" in sample.current.cause


async def test_a_read_back_that_is_no_number_is_not_believed() -> None:
    async with on_the_wire(Device(holding(0, 0x7FC0, 0))) as bus:
        sample = await rig(bus, wired("moxa_e1241", 0)).read(0.0)
    assert (sample.current.value, sample.current.quality) == (None, Quality.BAD)


async def test_an_output_at_its_safe_value_is_never_driven_again_by_itself() -> None:
    device = adam_6224()
    async with on_the_wire(device) as bus:
        analog = rig(bus, wired("adam_6224"))
        await analog.read(0.0)
        device.registers |= holding(101, 0b100)
        for now in (1.0, 2.0):
            with pytest.raises(WatchdogTripped, match="is at its safe value"):
                await analog.read(now)
            with pytest.raises(WatchdogTripped):
                await analog.write(0.0107, urgent=True)
        assert not device.writes
        device.registers |= holding(101, 0)
        await analog.read(3.0)
        await analog.write(0.0107)
    assert device.writes == [Write(1, 0, (1715,))]


async def test_a_safe_value_is_written_once_and_read_back() -> None:
    device = adam_6224()
    asked = WatchdogSettings(timeout=None, safe_current=0.0107)
    async with on_the_wire(device) as bus:
        for _ in range(2):
            await rig(bus, replace(wired("adam_6224"), watchdog=asked)).read(0.0)
    assert device.writes == [Write(1, 410, (1715,))]


async def test_a_safe_value_that_is_not_kept_is_noticed() -> None:
    device = adam_6224()
    device.frozen = {(Table.HOLDING, 410)}
    asked = WatchdogSettings(timeout=None, safe_current=0.0107)
    async with on_the_wire(device) as bus:
        with pytest.raises(ModuleMismatch, match=r"10\.7 mA as its safe value and has"):
            await rig(bus, replace(wired("adam_6224"), watchdog=asked)).read(0.0)


async def test_a_watchdog_is_armed_only_when_asked_for() -> None:
    device = wago()
    async with on_the_wire(device) as bus:
        analog = rig(bus, wired("wago_750_554"))
        await analog.read(0.0)
        assert analog.facts.output.watchdog is WatchdogState.UNARMED
        assert any("keeps the last current" in said for said in analog.warnings)
    assert not device.writes


async def test_a_watchdog_is_armed_before_anything_is_driven() -> None:
    device = wago()
    device.causing = {(Table.HOLDING, 0x100A): holding(0x1006, 1)}
    async with on_the_wire(device) as bus:
        analog = rig(bus, replace(wired("wago_750_554"), watchdog=KEPT))
        assert analog.facts.output.watchdog is WatchdogState.ARMING
        await analog.read(0.0)
        facts = analog.facts.output
    # 2 s in steps of 0.1 s; then the alternative watchdog.
    assert device.writes == [Write(1, 0x1000, (20,)), Write(1, 0x100A, (1,))]
    assert (facts.watchdog, facts.watchdog_timeout) == (WatchdogState.ARMED, 2.0)
    assert facts.safe_current == 0.004
    assert not any("keeps the last current" in said for said in analog.warnings)


async def test_a_watchdog_that_runs_as_it_should_is_left_alone() -> None:
    device = wago()
    device.registers |= holding(0x1000, 20) | holding(0x1006, 1)
    async with on_the_wire(device) as bus:
        analog = rig(bus, replace(wired("wago_750_554"), watchdog=KEPT))
        await analog.read(0.0)
        assert analog.facts.output.watchdog is WatchdogState.ARMED
    assert not device.writes


async def test_a_watchdog_that_does_not_run_is_an_error() -> None:
    async with on_the_wire(wago()) as bus:
        analog = rig(bus, replace(wired("wago_750_554"), watchdog=KEPT))
        with pytest.raises(ModuleMismatch, match="was armed and does not say so"):
            await analog.read(0.0)


async def test_a_trip_is_noticed_within_a_quarter_of_the_time_out() -> None:
    device = wago()
    device.registers |= holding(0x1006, 1)
    async with on_the_wire(device) as bus:
        analog = rig(bus, replace(wired("wago_750_554"), watchdog=KEPT))
        await analog.read(0.0)
        device.registers |= holding(0x1006, 2)
        await analog.read(0.4)
        before = len(device.writes)
        with pytest.raises(WatchdogTripped, match="write 1 to holding register 4103"):
            await analog.read(0.5)
        # Neither the watchdog nor the output is touched until a person has cleared it.
        with pytest.raises(WatchdogTripped):
            await analog.read(0.6)
        assert len(device.writes) == before


async def test_a_watchdog_in_coils_is_armed_with_coils() -> None:
    device = Device(
        holding(0, 4000)
        | holding(488, 0)
        | placed(Table.COILS, 260, 0)
        | placed(Table.COILS, 268, 1, 0)
    )
    async with on_the_wire(device) as bus:
        analog = rig(bus, replace(wired("icpdas_i_7024"), watchdog=KEPT))
        await analog.read(0.0)
    assert device.writes == [Write(1, 488, (20,)), WriteCoil(1, 260, on=True)]


async def test_what_stands_against_a_module_is_looked_for_again_after_a_loss() -> None:
    device = adam_6224()
    async with on_the_wire(device) as bus:
        analog = rig(bus, wired("adam_6224"))
        await analog.read(0.0)
        seen = device.requests.count(Read(1, Table.HOLDING, 200))
        await analog.read(1.0)
        assert device.requests.count(Read(1, Table.HOLDING, 200)) == seen == 1
        # The module answers nothing sound, as if it were switched off.
        del device.registers[Table.HOLDING, 0]
        with pytest.raises(OSError, match="illegal address"):
            await analog.read(2.0)
        device.registers |= holding(0, 0) | holding(200, 0x182)
        with pytest.raises(ModuleMismatch):
            await analog.read(3.0)


async def test_a_current_below_the_range_never_reaches_the_wire() -> None:
    device = adam_6224()
    async with on_the_wire(device) as bus:
        with pytest.raises(InputError, match="3 mA is outside 4 to 20 mA"):
            await rig(bus, wired("adam_6224")).write(0.003)
    assert not device.requests
