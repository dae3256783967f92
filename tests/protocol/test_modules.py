from math import inf, nan

import pytest

from gripperd.config.module_library import ModuleLibrary
from gripperd.errors import InputError
from gripperd.protocol.modules import Status

MODULES = ModuleLibrary()


# Worked out by hand, or printed in the manuals: 10.7 mA is 6.7 mA above the live zero,
# 0.41875 of 16 mA; 0x412B3333 is 10.7 in IEEE 754 binary32.
@pytest.mark.parametrize(
    ("module", "range_", "address", "words"),
    [
        ("waveshare_ao_8ch", "0-20mA", 0x0000, (10_700,)),
        ("adam_6224", "4-20mA", 0, (1715,)),
        ("adam_6224", "0-20mA", 0, (2191,)),
        ("adam_6024", "4-20mA", 10, (1715,)),
        ("adam_6024", "0-20mA", 10, (2191,)),
        ("adam_4024", "4-20mA", 0, (1715,)),
        ("icpdas_i_7024", "4-20mA", 0, (10_700,)),
        ("brainboxes_ed_560", "4-20mA", 0x20, (0x3333, 0x412B)),
        ("brainboxes_ed_560_int", "4-20mA", 0x00, (6860,)),
        ("brainboxes_ed_560_engineering", "4-20mA", 0x00, (10_700,)),
        ("moxa_e1241", "4-20mA", 0, (0x412B, 0x3333)),
        ("wago_750_554", "4-20mA", 0x0000, (13_720,)),
    ],
)
def test_10_7_ma_is_these_words_at_this_register(
    module: str, range_: str, address: int, words: tuple[int, ...]
) -> None:
    found = MODULES.output(module)
    assert found.modbus is not None
    chosen = found.range(range_)
    assert found.modbus.values.of(0) == address
    assert found.modbus.encoding.encode(chosen.count(0.0107)) == words
    # And back, to within half a step of the coarsest.
    read = chosen.current(found.modbus.encoding.decode(words))
    assert read == pytest.approx(0.0107, abs=4e-6)


@pytest.mark.parametrize(
    ("module", "table", "address", "words"),
    [
        ("waveshare_ai_8ch", "INPUT", 0x0000, (10_700,)),
        ("adam_4017_plus", "HOLDING", 0, (27_443,)),
        ("adam_6017", "HOLDING", 0, (27_443,)),
        ("adam_6217", "HOLDING", 0, (27_443,)),
        ("icpdas_m_7017", "INPUT", 0, (10_700,)),
        ("moxa_e1240", "INPUT", 0, (27_443,)),
        ("wago_750_455", "INPUT", 0, (0x3598,)),
    ],
)
def test_an_input_reads_10_7_ma_from_these_words(
    module: str, table: str, address: int, words: tuple[int, ...]
) -> None:
    found = MODULES.input(module)
    assert found.modbus is not None
    assert found.modbus.values.table.name == table
    assert found.modbus.values.of(0) == address
    read = found.range().current(found.modbus.encoding.decode(words))
    assert read == pytest.approx(0.0107, abs=2e-6)


@pytest.mark.parametrize(
    ("module", "channel", "address"),
    [
        ("waveshare_ao_8ch", 7, 7),
        ("adam_6024", 1, 11),
        ("brainboxes_ed_560", 3, 0x26),
        ("moxa_e1241", 3, 6),
    ],
)
def test_the_last_channel_has_the_last_register(
    module: str, channel: int, address: int
) -> None:
    found = MODULES.output(module)
    assert found.channels == channel + 1
    assert found.modbus is not None
    assert found.modbus.values.of(channel) == address


@pytest.mark.parametrize(
    ("module", "range_", "code"),
    [
        ("adam_6224", "4-20mA", 0x0180),
        ("adam_6224", "0-20mA", 0x0182),
        ("adam_4024", "4-20mA", 0x31),
        ("adam_4024", "0-20mA", 0x30),
        ("brainboxes_ed_560", "4-20mA", 0x31),
    ],
)
def test_the_range_codes_are_those_of_the_manual(
    module: str, range_: str, code: int
) -> None:
    assert MODULES.output(module).range(range_).code == code


def test_a_wago_output_leaves_its_low_three_bits_alone() -> None:
    module = MODULES.output("wago_750_554")
    assert module.modbus is not None
    for microamperes in range(4000, 20_001, 7):
        count = module.range().count(microamperes * 1e-6)
        (word,) = module.modbus.encoding.encode(count)
        assert word & 0b111 == 0
        assert word <= 0x7FF8


@pytest.mark.parametrize("current", [-1e-6, 0.0200001, 10.7, inf, nan])
def test_a_current_the_module_cannot_drive_is_refused_not_clamped(
    current: float,
) -> None:
    module = MODULES.output("waveshare_ao_8ch")
    with pytest.raises(InputError, match="waveshare_ao_8ch") as refused:
        module.range().check(current, module.name)
    assert refused.value.key == "current_mA"


def test_the_refusal_names_value_and_limit_in_milliamperes() -> None:
    module = MODULES.output("adam_6224")
    with pytest.raises(InputError, match=r"3\.9 mA is outside 4 to 20 mA"):
        module.range().check(0.0039, module.name)


@pytest.mark.parametrize("current", [0.004, 0.0199999999999, 0.020])
def test_the_ends_of_a_range_belong_to_it(current: float) -> None:
    module = MODULES.output("adam_6224")
    assert module.range().check(current, module.name) == pytest.approx(current)


# What the notes on the hardware leave open, or know from memory alone.
@pytest.mark.parametrize(
    "module",
    ["icpdas_m_7017"],
)
def test_what_nobody_has_verified_says_so(module: str) -> None:
    assert any("nobody has verified" in said for said in MODULES.input(module).doubts)


@pytest.mark.parametrize(
    ("module", "word"),
    [
        ("adam_4024", "counts over Modbus"),
        ("icpdas_i_7024", "488"),
        ("wago_750_554", "0x0200"),
        ("moxa_e1241", "watchdog"),
        ("adam_6224", "time-out of its watchdog"),
    ],
)
def test_what_is_not_confirmed_is_named(module: str, word: str) -> None:
    assert any(word in said for said in MODULES.output(module).doubts)


def test_a_second_register_holds_the_bits_from_16_on() -> None:
    status = Status(
        registers=None, words=2, bits={0: "low", 15: "top", 16: "next"}, fail_safe=18
    )
    assert status.causes((0x8001, 0)) == ("low", "top")
    assert status.causes((0, 1)) == ("next",)
    assert status.causes((0, 0)) == ()
    assert status.tripped((0, 0b100))
    assert not status.tripped((0b100, 0))


def test_a_whole_value_goes_before_its_bits() -> None:
    status = Status(registers=None, bits={0: "bit"}, codes={3: "code"})
    assert status.causes((3,)) == ("code",)
    assert status.causes((1,)) == ("bit",)
