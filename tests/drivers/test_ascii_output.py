import asyncio
from dataclasses import replace

import pytest

from gripperd.config.module_library import ModuleLibrary
from gripperd.drivers.analog import (
    AnalogRig,
    InputWiring,
    OutputWiring,
    SensorWiring,
    WatchdogSettings,
)
from gripperd.drivers.facts import WatchdogState
from gripperd.errors import (
    BadReply,
    InputError,
    ModuleMismatch,
    ReplyTimeout,
    WatchdogTripped,
)
from gripperd.protocol.live_zero import LoopScale
from gripperd.protocol.modules import ModuleDialect
from gripperd.signals import Quality

from .text_device import TextDevice, dcon_line, itv_line

MODULES = ModuleLibrary()
I_7024 = OutputWiring(
    module=MODULES.output("icpdas_i_7024"),
    unit=1,
    channel=0,
    dialect=ModuleDialect.DCON,
)
ADAM_4024 = OutputWiring(
    module=MODULES.output("adam_4024"),
    unit=1,
    channel=0,
    dialect=ModuleDialect.ADAM_ASCII,
)
KEPT = WatchdogSettings(timeout=2.0, safe_current=0.004)


class I7024:
    """One channel, its host watchdog, and nothing of anyone else's code."""

    def __init__(self) -> None:
        self.output, self.safe = "+04.000", "+04.000"
        self.watchdog = "000"
        self.tripped = False
        self.range = "31"

    def answer(self, line: str) -> str | None:
        match line[:4], line[4:]:
            case "#010", value:
                return self.drive(value)
            case "$016", "0":
                return f"!01{self.output}"
            case "$012", "":
                # 9600 Bd, engineering format, no checksum.
                return f"!01{self.range}0600"
            case "~010", "":
                return "!0104" if self.tripped else "!0100"
            case "~012", "":
                return f"!01{self.watchdog}"
            case "~013", armed:
                self.watchdog = armed
                return "!01"
            case "~014", "0":
                return f"!01{self.safe}"
            case _:
                return None

    def drive(self, value: str) -> str:
        if self.tripped:
            return "!"
        self.output = value
        return ">"


async def test_a_current_is_a_line_and_read_back_with_another() -> None:
    module = I7024()
    device = TextDevice(module.answer)
    async with dcon_line(device) as bus:
        rig = AnalogRig(bus, I_7024, None)
        await rig.read(0.0)
        del device.lines[:]
        await rig.write(0.0107)
        measured = await rig.read(0.1)
    assert device.lines == ["#010+10.700", "$0160"]
    assert measured.current.value == pytest.approx(0.0107)


async def test_a_host_watchdog_is_armed_kept_and_read_back() -> None:
    module = I7024()
    device = TextDevice(module.answer)
    async with dcon_line(device) as bus:
        rig = AnalogRig(bus, replace(I_7024, watchdog=KEPT), None)
        await rig.read(0.0)
        facts = rig.facts.output
        # 2 s are 20, in hexadecimal, tenths of a second.
        assert module.watchdog == "114"
        assert (facts.watchdog, facts.safe_current) == (WatchdogState.ARMED, 0.004)
        assert not [line for line in device.lines if line.startswith("#")]
        del device.lines[:]
        for now in (0.1, 0.4, 0.5, 0.6, 0.9, 1.0):
            await rig.read(now)
    assert device.lines.count("~**") == 2


async def test_a_host_watchdog_that_does_not_take_its_time_is_an_error() -> None:
    module = I7024()

    def forgetful(line: str) -> str | None:
        return "!01" if line.startswith("~013") else module.answer(line)

    async with dcon_line(TextDevice(forgetful)) as bus:
        rig = AnalogRig(bus, replace(I_7024, watchdog=KEPT), None)
        with pytest.raises(ModuleMismatch, match="was armed and does not say so"):
            await rig.read(0.0)


async def test_a_damaged_line_is_not_taken_for_a_watchdog_that_is_not_armed() -> None:
    module = I7024()

    def damaged(line: str) -> str | None:
        return "!02114" if line == "~012" else module.answer(line)

    async with dcon_line(TextDevice(damaged)) as bus:
        rig = AnalogRig(bus, replace(I_7024, watchdog=KEPT), None)
        with pytest.raises(BadReply, match="it does not begin with !01"):
            await rig.read(0.0)


async def test_a_read_back_that_no_output_can_give_is_not_believed() -> None:
    module = I7024()
    module.output = "+41.880"
    async with dcon_line(TextDevice(module.answer)) as bus:
        sample = await AnalogRig(bus, I_7024, None).read(0.0)
    assert sample.current.quality is Quality.BAD
    assert "reads back as 41.88 mA, which it cannot give" in sample.current.cause


async def test_another_safe_value_is_refused_and_not_driven() -> None:
    module = I7024()
    module.safe = "+12.000"
    device = TextDevice(module.answer)
    async with dcon_line(device) as bus:
        rig = AnalogRig(bus, replace(I_7024, watchdog=KEPT), None)
        with pytest.raises(ModuleMismatch, match="a safe value of 12 mA, 4 mA is"):
            await rig.read(0.0)
    assert not [line for line in device.lines if line[:2] in {"#0", "~03"}]
    assert module.watchdog == "000"


async def test_a_tripped_host_watchdog_is_noticed_and_left_alone() -> None:
    module = I7024()
    module.tripped = True
    device = TextDevice(module.answer)
    async with dcon_line(device) as bus:
        rig = AnalogRig(bus, replace(I_7024, watchdog=KEPT), None)
        for now in (0.0, 1.0):
            with pytest.raises(WatchdogTripped, match="send ~AA1"):
                await rig.read(now)
            with pytest.raises(WatchdogTripped):
                await rig.write(0.0107)
    assert set(device.lines) == {"~010"}


async def test_a_write_that_the_watchdog_swallows_is_an_error() -> None:
    module = I7024()
    async with dcon_line(TextDevice(module.answer)) as bus:
        rig = AnalogRig(bus, I_7024, None)
        await rig.read(0.0)
        module.tripped = True
        with pytest.raises(WatchdogTripped):
            await rig.write(0.0107)
        with pytest.raises(WatchdogTripped):
            await rig.read(1.0)
        module.tripped = False
        await rig.read(2.0)
        await rig.write(0.0107)
    assert module.output == "+10.700"


async def test_the_range_is_asked_for_before_anything_is_driven() -> None:
    module = I7024()
    device = TextDevice(module.answer)
    async with dcon_line(device) as bus:
        rig = AnalogRig(bus, I_7024, None)
        await rig.read(0.0)
        assert rig.facts.output.range_verified
        module.range = "30"
        other = AnalogRig(bus, I_7024, None)
        with pytest.raises(ModuleMismatch, match=r"code 0x30 \(0-20mA\), 0x31 \(4-"):
            await other.read(0.0)
        with pytest.raises(ModuleMismatch):
            await other.write(0.0107)
        assert not other.facts.output.range_verified
        await AnalogRig(bus, replace(I_7024, range_name="0-20mA"), None).read(0.0)
    assert not [line for line in device.lines if line.startswith("#")]


async def test_a_module_that_does_not_know_its_range_is_driven_unverified() -> None:
    module = I7024()

    def older(line: str) -> str | None:
        return "?01" if line == "$012" else module.answer(line)

    async with dcon_line(TextDevice(older)) as bus:
        rig = AnalogRig(bus, I_7024, None)
        await rig.read(0.0)
        assert not rig.facts.output.range_verified
        await rig.write(0.0107)
    assert module.output == "+10.700"


async def test_a_range_that_is_none_is_not_believed() -> None:
    module = I7024()
    module.range = "+4"
    async with dcon_line(TextDevice(module.answer)) as bus:
        with pytest.raises(BadReply, match="does not begin with a range code"):
            await AnalogRig(bus, I_7024, None).read(0.0)


async def test_a_brainboxes_tells_the_range_of_each_channel() -> None:
    # As printed on p. 73 of its manual: 0-10 V on channel 0, 4-20 mA on channel 3.
    replies = {"$0190": "!013200", "$0193": "!013100", "$0163": "!01+04.000"}
    device = TextDevice(lambda line: {"~010": "!0100", **replies}.get(line))
    module = MODULES.output("brainboxes_ed_560")
    wiring = replace(I_7024, module=module, channel=3)
    async with dcon_line(device) as bus:
        rig = AnalogRig(bus, wiring, None)
        await rig.read(0.0)
        assert rig.facts.output.range_verified
        with pytest.raises(ModuleMismatch, match="has range code 0x32"):
            await AnalogRig(bus, replace(wiring, channel=0), None).read(0.0)


async def test_sensors_of_another_range_are_bad_and_the_valve_is_driven() -> None:
    module = I7024()
    # ±20 mA on channel 2, 4-20 mA on channel 0.
    replies = {"$028C0": "!02C0R07", "$028C2": "!02C2R0D"}
    device = TextDevice(lambda line: replies.get(line) or module.answer(line))
    gauge = LoopScale(value_low=0.0, value_high=600e3)
    inputs = InputWiring(
        module=MODULES.input("adam_4017_plus"),
        unit=2,
        sensors={
            "pressure": SensorWiring(channel=0, scale=gauge),
            "grip": SensorWiring(channel=2, scale=gauge),
        },
        dialect=ModuleDialect.ADAM_ASCII,
    )
    async with dcon_line(device) as bus:
        rig = AnalogRig(bus, I_7024, inputs)
        measured = await rig.read(0.0)
        await rig.write(0.0107)
    assert measured.pressure.quality is Quality.BAD
    assert "channel 2 of adam_4017_plus, unit 2, has range code 0x0D" in (
        measured.grip.cause
    )
    assert module.output == "+10.700"
    assert "#02" not in device.lines


async def test_facts_that_were_confirmed_are_doubted_once_the_link_fails() -> None:
    module = I7024()
    device = TextDevice(module.answer)
    async with dcon_line(device) as bus:
        rig = AnalogRig(bus, replace(I_7024, watchdog=KEPT), None)
        await rig.read(0.0)
        assert rig.facts.output.when_silent == "every output goes to its safe value"
        device.answer = lambda line: None
        with pytest.raises(ReplyTimeout):
            await rig.read(0.1)
        facts = rig.facts.output
    assert (facts.watchdog, facts.range_verified) == (WatchdogState.ARMING, False)
    assert "keeps the last current" in facts.when_silent


async def test_an_adam_grants_a_current_by_repeating_it() -> None:
    replies = {"$016C0": "!01+04.000", "#01C0+10.700": "!01C0+10.700"}
    device = TextDevice(lambda line: replies.get(line))
    async with dcon_line(device) as bus:
        rig = AnalogRig(bus, ADAM_4024, None)
        assert (await rig.read(0.0)).current.value == pytest.approx(0.004)
        await rig.write(0.0107)
        replies["#01C0+10.700"] = "!01C0+10.000"
        with pytest.raises(BadReply, match=r"C0\+10\.000"):
            await rig.write(0.0107)


async def test_an_adam_watchdog_counts_in_four_decimal_digits() -> None:
    replies = {"$016C0": "!01+04.000", "$01X00020": "!01", "$01X1": "!010020"}
    device = TextDevice(lambda line: replies.get(line))
    asked = WatchdogSettings(timeout=2.0, safe_current=None)
    async with dcon_line(device) as bus:
        rig = AnalogRig(bus, replace(ADAM_4024, watchdog=asked), None)
        await rig.read(0.0)
        assert rig.facts.output.watchdog is WatchdogState.ARMED
    assert device.lines[:2] == ["$01X00020", "$01X1"]


async def test_all_sensors_come_in_one_line() -> None:
    loops = "+12.000+00.000+20.000+99?999" + 4 * "+00.000"
    replies = {"$0160": "!01+04.000", "~010": "!0100", "#02": f">{loops}"}
    replies |= {"$012": "!01310600"} | {f"$028C{n}": f"!02C{n}R07" for n in (0, 1, 3)}
    device = TextDevice(lambda line: replies.get(line))
    gauge = LoopScale(value_low=0.0, value_high=600e3)
    names = {"pressure": 0, "opening": 1, "grip": 3}
    inputs = InputWiring(
        module=MODULES.input("adam_4017_plus"),
        unit=2,
        sensors={
            name: SensorWiring(channel=channel, scale=gauge)
            for name, channel in names.items()
        },
        dialect=ModuleDialect.ADAM_ASCII,
    )
    async with dcon_line(device) as bus:
        measured = await AnalogRig(bus, I_7024, inputs).read(0.0)
    assert device.lines.count("#02") == 1
    assert measured.pressure.value == pytest.approx(300e3)
    assert "0.000 mA is below 3.6 mA" in measured.opening.cause
    assert measured.grip.quality is Quality.BAD
    assert "+99?999" in measured.grip.cause


async def test_a_regulator_takes_its_pressure_as_a_count() -> None:
    module = MODULES.output("smc_itv_rc")
    wiring = OutputWiring(module=module, unit=0, channel=0, dialect=ModuleDialect.ITV)
    replies = {"REQ": "0", "SET 428": "428"}
    device = TextDevice(lambda line: replies.get(line), end="\r\n")
    async with itv_line(device) as bus:
        rig = AnalogRig(bus, wiring, None)
        assert (await rig.read(0.0)).current.value == 0.004
        await rig.write(0.0107)
        replies["REQ"] = "428"
        measured = await rig.read(1.0)
        with pytest.raises(InputError, match=r"20\.5 mA is outside 4 to 20 mA"):
            await rig.write(0.0205)
    assert device.lines == ["REQ", "SET 428", "REQ"]
    # 428 of 1023 steps above 4 mA: within half a step of what was asked for.
    assert measured.current.value == pytest.approx(0.004 + 0.016 * 428 / 1023)


async def test_an_older_write_never_follows_a_stop() -> None:
    device = TextDevice(I7024().answer)
    async with dcon_line(device) as bus:
        rig = AnalogRig(bus, I_7024, None)
        await rig.read(0.0)
        # The line is busy; the older write waits, the stop passes it.
        reading = asyncio.create_task(rig.read(1.0))
        await asyncio.sleep(0)
        older = asyncio.create_task(rig.write(0.0107))
        await asyncio.sleep(0)
        stop = asyncio.create_task(rig.write(0.004, urgent=True))
        await asyncio.gather(reading, older, stop)
    written = [line for line in device.lines if line.startswith("#")]
    assert written == ["#010+04.000", "#010+04.000"]
