"""What the doctor says of an output module, on devices with literal registers."""

import pytest

from gripperd.config.module_library import ModuleLibrary
from gripperd.doctor.finding import Result, Verdict
from gripperd.doctor.register_output_check import RegisterOutputCheck
from gripperd.doctor.text_output_check import PhraseOutputCheck
from gripperd.drivers.wiring import OutputWiring, WatchdogSettings
from gripperd.protocol.modbus import Table
from gripperd.protocol.modules import ModuleDialect
from tests.drivers.device import Device, holding, on_the_wire
from tests.drivers.text_device import TextDevice, dcon_line

Registers = dict[tuple[Table, int], int]

ADAM: Registers = (
    holding(0, 1715, 0, 0, 0)
    | holding(100, *[0] * 8)
    | holding(200, *[0x180] * 4)
    | holding(410, 2191, 0, 0, 0)
)
"""4-20 mA, 10.7 mA on channel 0; its safe value is 2191/4095 of 16 mA above 4 mA."""
WAGO: Registers = (
    holding(0, 0x3598, 0)
    | holding(0x200, 0x3598, 0)
    | holding(0x1000, 20)
    | holding(0x1006, 1)
)


async def results(
    module: str, registers: Registers, watchdog: WatchdogSettings | None = None
) -> dict[str, Result]:
    wiring = OutputWiring(
        module=ModuleLibrary().output(module), unit=1, channel=0, watchdog=watchdog
    )
    device = Device(registers)
    assert wiring.module.modbus is not None
    async with on_the_wire(device) as bus:
        check = RegisterOutputCheck(bus, wiring, wiring.module.modbus)
        found = {name: await step() for name, step in check.steps.items()}
    assert device.writes == []
    return found


async def test_a_sound_module_passes() -> None:
    found = await results("adam_6224", ADAM)
    assert len(found) == 5
    assert {each.verdict for each in found.values()} == {Verdict.OK}
    assert found["set-point read-back"].said == "10.701 mA"
    assert found["safe value"].said == "12.561 mA"


@pytest.mark.parametrize(
    ("registers", "check", "said"),
    [
        (holding(200, 0x182), "output range", "0x0182 (0-20mA)"),
        (holding(100, 1 << 3), "output status", "the loop is open"),
        (holding(101, 1 << 2), "watchdog", "tripped"),
    ],
)
async def test_what_stands_against_a_module_is_found(
    registers: Registers, check: str, said: str
) -> None:
    found = (await results("adam_6224", ADAM | registers))[check]
    assert found.verdict is Verdict.FAILED
    assert said in found.said
    assert found.remedy


async def test_a_watchdog_is_armed_tripped_or_not_armed() -> None:
    armed = (await results("wago_750_554", WAGO))["watchdog"]
    assert (armed.verdict, armed.said) == (Verdict.OK, "armed, 2 s")
    tripped = (await results("wago_750_554", WAGO | holding(0x1006, 2)))["watchdog"]
    assert tripped.verdict is Verdict.FAILED
    assert "write 1 to holding register 4103 (0x1007)" in tripped.remedy
    idle = (await results("wago_750_554", WAGO | holding(0x1006, 0)))["watchdog"]
    assert idle.verdict is Verdict.WARNING
    assert "keeps the last current" in idle.said


async def test_a_watchdog_that_the_daemon_will_arm_is_no_warning() -> None:
    asked = WatchdogSettings(timeout=2.0, safe_current=None)
    found = await results("wago_750_554", WAGO | holding(0x1006, 0), asked)
    assert found["watchdog"].verdict is Verdict.OK
    assert "the daemon arms it with 2 s" in found["watchdog"].said


async def test_a_safe_value_that_differs_is_a_warning() -> None:
    asked = WatchdogSettings(timeout=None, safe_current=4e-3)
    found = (await results("adam_6224", ADAM, asked))["safe value"]
    assert found.verdict is Verdict.WARNING
    assert "12.561 mA, the settings want 4 mA" in found.said


async def test_a_module_that_speaks_lines_is_asked_and_not_told() -> None:
    answers = {
        "$0160": "!01+10.700",
        "$012": "!01300600",
        "~010": "!0104",
        "~0140": "!01+04.000",
    }
    device = TextDevice(answers.get)
    module = ModuleLibrary().output("icpdas_i_7024")
    wiring = OutputWiring(module=module, unit=1, channel=0, dialect=ModuleDialect.DCON)
    async with dcon_line(device) as bus:
        check = PhraseOutputCheck(bus, wiring, module.phrases[ModuleDialect.DCON])
        found = {name: await step() for name, step in check.steps.items()}
    assert found["set-point read-back"].said == "10.700 mA"
    assert found["output range"].verdict is Verdict.FAILED
    assert "0x30 (0-20mA), 0x31 (4-20mA) is wanted" in found["output range"].said
    assert found["watchdog"].verdict is Verdict.FAILED
    assert "~AA1" in found["watchdog"].remedy
    assert found["safe value"].said == "4.000 mA"
    assert set(device.lines) == answers.keys()
