"""Every shipped description is recognised on a device that has its registers."""

import pytest

from gripperd.config.module_library import ModuleLibrary
from gripperd.doctor.fit import identify
from gripperd.doctor.identity import Certainty
from gripperd.drivers.registers import Unit
from gripperd.protocol.modbus import Table
from tests.drivers.device import Device, holding, on_the_wire, placed

MODULES = tuple(ModuleLibrary().all())


async def identified(registers: dict[tuple[Table, int], int]) -> tuple[str, list[str]]:
    device = Device(registers)
    async with on_the_wire(device) as bus:
        identity = await identify(Unit(bus, 1), MODULES)
    assert device.writes == []
    return identity.certainty, [module.name for module in identity.modules]


WAGO = (
    holding(0, 0x3598, 0)
    | holding(0x200, 0x3598, 0)
    | holding(0x1000, 10)
    | holding(0x1006, 1)
)
RACKS = [
    # 10.7 mA on channel 0, 4 mA on the others, range codes for 4-20 mA.
    ("adam_6224", holding(0, 1715, 0, 0, 0) | holding(100, *[0] * 8)
     | holding(200, *[0x180] * 4) | holding(410, 0, 0, 0, 0)),
    ("wago_750_554", WAGO),
    ("brainboxes_ed_560", holding(0x20, 0x3333, 0x412B, *[0, 0x4080] * 3)
     | holding(0x60, *[0x31] * 4)),
    ("icpdas_i_7024", holding(0, 10_700, 4000, 4000, 4000) | holding(488, 20)
     | placed(Table.COILS, 268, 1)),
    ("moxa_e1240", placed(Table.INPUT, 0, *[27443] * 8) | holding(0x18, *[1] * 8)
     | placed(Table.INPUT, 0x3C, *[0] * 8)),
]  # fmt: skip


@pytest.mark.parametrize(("name", "registers"), RACKS, ids=[name for name, _ in RACKS])
async def test_a_module_is_taken_for_what_it_is(
    name: str, registers: dict[tuple[Table, int], int]
) -> None:
    certainty, names = await identified(registers)
    assert names == [name]
    assert certainty in {Certainty.LIKELY, Certainty.POSSIBLE}


async def test_modules_that_are_driven_alike_are_no_ambiguity() -> None:
    registers = (
        holding(0, *[27443] * 8) | holding(100, *[0] * 16) | holding(200, *[0x180] * 8)
    )
    certainty, names = await identified(registers)
    assert certainty == Certainty.LIKELY
    assert names == ["adam_6017", "adam_6217"]


async def test_a_name_register_goes_before_everything_else() -> None:
    certainty, names = await identified(holding(210, 0x4024))
    assert (certainty, names) == (Certainty.NAMED, ["adam_4024"])


async def test_registers_without_any_code_are_no_more_than_possible() -> None:
    certainty, names = await identified(holding(0, 10_700, *[4000] * 7))
    assert (certainty, names) == (Certainty.POSSIBLE, ["waveshare_ao_8ch"])


async def test_a_device_of_all_zeros_is_not_taken_for_one_module() -> None:
    zeros = {(table, place): 0 for table in Table for place in range(0x1100)}
    certainty, names = await identified(zeros)
    assert certainty == Certainty.AMBIGUOUS
    assert len(names) > 1


async def test_a_module_in_another_format_is_not_taken_for_one_in_this() -> None:
    hexadecimal = (
        holding(0, 10_700, 4000, 4000, 4000)
        | holding(488, 20)
        | placed(Table.COILS, 268, 0)
    )
    assert "icpdas_i_7024" not in (await identified(hexadecimal))[1]


async def test_broken_loops_do_not_hide_an_input_module() -> None:
    registers = placed(Table.INPUT, 0, *[0] * 8) | holding(0x1000, *[3] * 8)
    certainty, names = await identified(registers)
    assert (certainty, names) == (Certainty.LIKELY, ["waveshare_ai_8ch"])


async def test_a_value_that_no_range_has_speaks_against_a_description() -> None:
    # 30 mA in µA: no output of a Waveshare module.
    certainty, _ = await identified(holding(0, 30_000, *[4000] * 7))
    assert certainty == Certainty.UNKNOWN
