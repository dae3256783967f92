"""What shipped descriptions tell a person, as the bench takes it."""

import pytest

from gripperd.bench.sentences import OPEN, lasts, remedy, sign
from gripperd.protocol.modbus import Table
from gripperd.protocol.modules import OutputModule
from gripperd.protocol.watchdog import Setting

from .line import DESCRIBED


@pytest.mark.parametrize(
    ("name", "clears"),
    [
        ("wago_750_554", Setting(Table.HOLDING, 0x1007, 1)),
        ("icpdas_i_7024", Setting(Table.COILS, 269, 1)),
    ],
)
def test_the_bench_clears_a_trip_as_a_person_is_told_to(
    name: str, clears: Setting
) -> None:
    module = DESCRIBED[name]
    assert isinstance(module, OutputModule)
    assert module.modbus is not None
    assert module.modbus.watchdog is not None
    assert remedy(module.modbus.watchdog.clear) == clears
    assert lasts(module.modbus.watchdog.acts) is (name == "icpdas_i_7024")


def test_a_remedy_without_a_register_is_none() -> None:
    assert remedy("switch the module off and on") is None


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("adam_6224", 1 << 3),
        ("adam_6017", 1 << 3),
        ("moxa_e1240", 1),
        ("wago_750_455", 0x0003),
    ],
)
def test_an_open_loop_is_found_among_what_a_status_can_say(
    name: str, said: int
) -> None:
    registers = DESCRIBED[name].modbus
    assert registers is not None
    assert registers.status is not None
    assert sign(registers.status, OPEN) == said
