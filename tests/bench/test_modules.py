"""Modules as registers, asked without a wire."""

from dataclasses import replace
from functools import cache

import pytest

from gripperd.bench.channels import Inputs
from gripperd.bench.faults import BenchFaults
from gripperd.bench.modbus_speaker import RtuSpeaker, TcpSpeaker
from gripperd.bench.modules import Fitted, Modules
from gripperd.bench.register_device import RegisterDevice
from gripperd.bench.rig import Rig
from gripperd.bench.sensors import Channel
from gripperd.bench.text_speaker import DconSpeaker, ItvSpeaker
from gripperd.errors import DeviceRefused, InputError
from gripperd.protocol.mbap import ModbusTcp
from gripperd.protocol.modbus import Read, Refusal, Request, Table, Write, WriteCoil
from gripperd.protocol.modules import InputModule, OutputModule

from .line import DESCRIBED, fitted

HOLDING, INPUT, COILS = Table.HOLDING, Table.INPUT, Table.COILS
TCP = ModbusTcp()
speaking = cache(TcpSpeaker)


def ask(modules: Modules, request: Request) -> list[int]:
    """What comes back, by the codec of the driver."""
    reply = speaking(modules).answer(TCP.encode(request, 1))
    return list(TCP.decode(request, 1, reply))


def refusal(modules: Modules, request: Request) -> int | None:
    with pytest.raises(DeviceRefused) as refused:
        ask(modules, request)
    return refused.value.exception_code


def test_the_output_starts_at_zero_and_reads_back_what_was_written(
    modules: Modules, rig: Rig
) -> None:
    assert ask(modules, Read(1, HOLDING, 0, 8)) == [0] * 8
    assert ask(modules, Write(1, 0, (10_700,))) == [10_700]
    assert ask(modules, Read(1, HOLDING, 0, 2)) == [10_700, 0]
    assert rig.plant.current == pytest.approx(0.0107)


def test_only_channel_0_drives_the_valve(modules: Modules, rig: Rig) -> None:
    ask(modules, Write(1, 1, (5000, 6000)))
    assert ask(modules, Read(1, HOLDING, 0, 3)) == [0, 5000, 6000]
    assert rig.plant.current == 0.0


def test_only_the_first_output_module_drives_the_valve(rig: Rig) -> None:
    modules = Modules(rig, *fitted("waveshare_ao_8ch", "adam_6224"))
    ask(modules, Write(2, 0, (4095,)))
    assert rig.plant.current == 0.0
    assert ask(modules, Read(2, HOLDING, 0)) == [4095]


@pytest.mark.parametrize(
    ("request_", "exception"),
    [
        (Read(1, INPUT, 0), Refusal.ILLEGAL_FUNCTION),
        (WriteCoil(1, 0, on=True), Refusal.ILLEGAL_FUNCTION),
        (Write(2, 0, (1,)), Refusal.ILLEGAL_ADDRESS),
        (Write(2, 0x1000, (9,)), Refusal.ILLEGAL_VALUE),
        (Read(1, HOLDING, 8), Refusal.ILLEGAL_ADDRESS),
        (Read(1, HOLDING, 7, 2), Refusal.ILLEGAL_ADDRESS),
        (Write(1, 8, (1,)), Refusal.ILLEGAL_ADDRESS),
        (Write(1, 7, (1, 1)), Refusal.ILLEGAL_ADDRESS),
        (Read(2, INPUT, 8), Refusal.ILLEGAL_ADDRESS),
        (Read(2, HOLDING, 0), Refusal.ILLEGAL_ADDRESS),
        (Read(2, HOLDING, 0x1008), Refusal.ILLEGAL_ADDRESS),
        (Write(1, 0, (20_001,)), Refusal.ILLEGAL_VALUE),
        (Write(1, 0, (4000, 65_535)), Refusal.ILLEGAL_VALUE),
        (Read(3, HOLDING, 0), Refusal.NO_RESPONSE),
        (Write(0, 0, (1,)), Refusal.NO_RESPONSE),
    ],
)
def test_what_a_module_cannot_do_is_refused_with_its_exception(
    modules: Modules, rig: Rig, request_: Request, exception: Refusal
) -> None:
    assert refusal(modules, request_) == exception
    assert ask(modules, Read(1, HOLDING, 0, 8)) == [0] * 8
    assert rig.plant.current == 0.0


def test_20_milliamperes_is_still_driven(modules: Modules, rig: Rig) -> None:
    ask(modules, Write(1, 0, (20_000,)))
    assert rig.plant.current == pytest.approx(0.020)


def test_the_inputs_are_the_loops_in_microamperes(modules: Modules) -> None:
    pressure, opening, grip, *rest = ask(modules, Read(2, INPUT, 0, 8))
    # At rest: 0 of 600 kPa, 85 of 100 mm, 0 of 100 N; five sigma of 8 µA.
    assert pressure == pytest.approx(4000, abs=40)
    assert opening == pytest.approx(17_600, abs=40)
    assert grip == pytest.approx(4000, abs=40)
    # Both contacts are closed; nothing is on the rest.
    assert rest == [20_000, 20_000, 0, 0, 0]


def test_a_range_code_can_be_read_and_written(modules: Modules) -> None:
    assert ask(modules, Read(2, HOLDING, 0x1000, 8)) == [2] * 8
    ask(modules, Write(2, 0x1001, (3,)))
    assert ask(modules, Read(2, HOLDING, 0x1000, 3)) == [2, 3, 2]


def test_a_range_changes_what_a_count_means(rig: Rig) -> None:
    modules = Modules(rig, *fitted("adam_6224"))
    ask(modules, Write(1, 0, (2048,)))
    assert rig.plant.current == pytest.approx(4e-3 + 16e-3 * 2048 / 4095)
    ask(modules, Write(1, 200, (0x0182,)))
    assert ask(modules, Read(1, HOLDING, 0)) == [2048]
    assert rig.plant.current == pytest.approx(20e-3 * 2048 / 4095)


def test_a_module_can_be_set_to_another_range_from_the_start(rig: Rig) -> None:
    modules = Modules(rig, Fitted(DESCRIBED["adam_6224"], 1, "0-20mA"))
    assert ask(modules, Read(1, HOLDING, 200)) == [0x0182]
    with pytest.raises(InputError, match="4-20mA, 0-20mA"):
        Modules(rig, Fitted(DESCRIBED["adam_6224"], 1, "0-10V"))


# The words of the manuals, in the order of their addresses, on channel 1.
@pytest.mark.parametrize(
    ("name", "address", "words"),
    [
        ("waveshare_ao_8ch", 1, (0x29CC,)),
        ("adam_6024", 11, (1715,)),
        ("brainboxes_ed_560", 0x22, (0x3333, 0x412B)),
        ("brainboxes_ed_560_int", 1, (6860,)),
        ("brainboxes_ed_560_engineering", 1, (10_700,)),
        ("moxa_e1241", 2, (0x412B, 0x3333)),
        ("icpdas_i_7024", 1, (10_700,)),
    ],
)
def test_a_set_point_stands_where_and_as_the_manual_says(
    rig: Rig, name: str, address: int, words: tuple[int, ...]
) -> None:
    modules = Modules(rig, *fitted(name))
    ask(modules, Write(1, address, words))
    assert ask(modules, Read(1, HOLDING, address, len(words))) == list(words)
    (outputs,) = modules.outputs
    assert outputs.currents()[1] == pytest.approx(10.7e-3, abs=2e-6)


@pytest.mark.parametrize(
    ("name", "address", "word"),
    [
        ("waveshare_ao_8ch", 0x8000, 100),
        ("waveshare_ai_8ch", 0x8000, 100),
        ("adam_4024", 210, 0x4024),
        ("adam_4017_plus", 210, 0x4017),
    ],
)
def test_a_module_says_what_it_is(rig: Rig, name: str, address: int, word: int) -> None:
    modules = Modules(rig, *fitted(name))
    assert ask(modules, Read(1, HOLDING, address)) == [word]
    assert refusal(modules, Write(1, address, (1,))) == Refusal.ILLEGAL_ADDRESS


def test_a_module_that_clamps_does_so_without_a_word(rig: Rig) -> None:
    modules = Modules(rig, *fitted("brainboxes_ed_560_engineering"))
    assert ask(modules, Write(1, 0, (30_000,))) == [30_000]
    assert ask(modules, Read(1, HOLDING, 0)) == [20_000]
    assert rig.plant.current == pytest.approx(0.020)


def test_an_output_starts_with_the_current_that_is_described(rig: Rig) -> None:
    module = DESCRIBED["wago_750_554"]
    assert isinstance(module, OutputModule)
    Modules(rig, (replace(module, power_on_current=0.012), 1))
    assert rig.plant.current == pytest.approx(0.012)


@pytest.mark.parametrize(
    ("name", "current", "address", "table", "words"),
    [
        ("adam_6217", 2e-3, 100, HOLDING, [1 << 3, 0]),
        ("adam_6217", 22e-3, 100, HOLDING, [1 << 1, 0]),
        ("moxa_e1240", 2e-3, 0x3C, INPUT, [1]),
        ("wago_750_455", 2e-3, 0, INPUT, [0x0003]),
        ("icpdas_m_7017", 22e-3, 128, Table.DISCRETE, [1]),
    ],
)
def test_a_loop_out_of_range_shows_in_the_status(
    rig: Rig, name: str, current: float, address: int, table: Table, words: list[int]
) -> None:
    module = DESCRIBED[name]
    assert isinstance(module, InputModule)
    inputs = Inputs(module, lambda: [current])
    device = RegisterDevice(inputs)
    assert device.answer(Read(1, table, address, len(words))) == words


def test_half_a_float_is_refused(rig: Rig) -> None:
    modules = Modules(rig, *fitted("brainboxes_ed_560"))
    for words in ((0x3333,), (0x3333, 0x412B, 0x3333)):
        assert refusal(modules, Write(1, 0x20, words)) == Refusal.ILLEGAL_VALUE
    # Not a number, infinite.
    for high in (0x7FC0, 0x7F80):
        assert refusal(modules, Write(1, 0x20, (0, high))) == Refusal.ILLEGAL_VALUE


def test_a_coupler_reads_outputs_back_elsewhere(rig: Rig) -> None:
    modules = Modules(rig, *fitted("wago_750_554"))
    ask(modules, Write(1, 0, (0x3598 | 3,)))
    # The low three bits are no value.
    assert ask(modules, Read(1, HOLDING, 0x0200, 2)) == [0x3598, 0]
    assert refusal(modules, Read(1, HOLDING, 0)) == Refusal.ILLEGAL_ADDRESS


def test_two_modules_behind_a_coupler_share_its_unit(rig: Rig) -> None:
    both = DESCRIBED["wago_750_554"], DESCRIBED["wago_750_455"]
    modules = Modules(rig, *(Fitted(each, 1) for each in both))
    ask(modules, Write(1, 0, (0x7FF8,)))
    assert rig.plant.current == pytest.approx(0.020)
    opening = ask(modules, Read(1, INPUT, 1))[0]
    # 17.6 mA is 13.6 of 16 mA; the low three bits are clear.
    assert (opening & ~7) == pytest.approx(0x7FF8 * 13.6 / 16, abs=100)
    assert opening & 7 == 0


def test_two_modules_with_the_same_registers_cannot_share_a_unit(rig: Rig) -> None:
    outputs = [Fitted(DESCRIBED["waveshare_ao_8ch"], 1)] * 2
    with pytest.raises(InputError, match="holding register 0"):
        TcpSpeaker(Modules(rig, *outputs))


def test_a_broken_loop_shows_in_the_status_of_modules_that_have_one(rig: Rig) -> None:
    names = ("adam_6217", "moxa_e1240", "icpdas_m_7017")
    modules = Modules(rig, *fitted(*names))
    # Sound on channel 1, nothing connected to channel 7.
    assert ask(modules, Read(1, HOLDING, 102, 2)) == [0, 0]
    assert ask(modules, Read(1, HOLDING, 114, 2)) == [1 << 3, 0]
    assert ask(modules, Read(2, INPUT, 0x3C + 7)) == [1]
    assert ask(modules, Read(3, Table.DISCRETE, 128 + 7)) == [1]


def test_a_broken_loop_of_a_coupler_shows_in_the_value(rig: Rig) -> None:
    modules = Modules(rig, *fitted("wago_750_455"))
    rig.plant.faults = BenchFaults(broken=frozenset({Channel.PRESSURE}))
    assert ask(modules, Read(1, INPUT, 0)) == [0x0003]


def test_below_its_range_an_unsigned_count_is_0(rig: Rig) -> None:
    modules = Modules(rig, *fitted("adam_6217"))
    assert ask(modules, Read(1, HOLDING, 7)) == [0]


def test_the_format_that_is_required_is_set_and_stays(rig: Rig) -> None:
    modules = Modules(rig, *fitted("icpdas_i_7024"))
    assert ask(modules, Read(1, COILS, 268)) == [1]
    ask(modules, WriteCoil(1, 268, on=True))
    assert refusal(modules, WriteCoil(1, 268, on=False)) == Refusal.ILLEGAL_VALUE


def test_an_open_loop_is_set_and_not_delivered(rig: Rig) -> None:
    modules = Modules(rig, *fitted("adam_6224"))
    ask(modules, Write(1, 0, (1715,)))
    modules.cut_loop(1)
    assert rig.plant.current == 0.0
    assert ask(modules, Read(1, HOLDING, 0)) == [1715]
    assert ask(modules, Read(1, HOLDING, 100, 4)) == [1 << 3, 0, 0, 0]
    modules.mend()
    assert rig.plant.current == pytest.approx(10.7e-3, abs=4e-6)
    assert ask(modules, Read(1, HOLDING, 100)) == [0]


def test_after_a_power_cycle_the_outputs_are_where_power_puts_them(rig: Rig) -> None:
    modules = Modules(rig, *fitted("adam_6224"))
    ask(modules, Write(1, 0, (1715, 1715)))
    modules.power_cycle(1)
    assert ask(modules, Read(1, HOLDING, 0, 2)) == [0, 0]
    assert rig.plant.current == pytest.approx(4e-3)


@pytest.mark.parametrize(
    ("speaker", "name", "says"),
    [
        (TcpSpeaker, "smc_itv_rc", "speaks itv, this line modbus"),
        (RtuSpeaker, "smc_itv_rc", "speaks itv"),
        (DconSpeaker, "waveshare_ao_8ch", "speaks modbus, this line dcon and"),
        (ItvSpeaker, "icpdas_i_7024", "speaks modbus, dcon, this line itv"),
    ],
)
def test_a_module_that_does_not_speak_as_the_line_is_refused(
    rig: Rig, speaker: type[TcpSpeaker], name: str, says: str
) -> None:
    with pytest.raises(InputError, match=says):
        speaker(Modules(rig, *fitted(name)))
