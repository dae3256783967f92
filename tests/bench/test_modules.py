import pytest

from gripperd.bench.modules import Modules
from gripperd.bench.rig import Rig
from gripperd.protocol.modbus import Read, Refusal, Request, Table, Write

HOLDING, INPUT = Table.HOLDING, Table.INPUT


def registers(modules: Modules, request: Request) -> list[int]:
    answer = modules.answer(request)
    assert not isinstance(answer, Refusal)
    return list(answer)


def test_the_output_starts_at_zero_and_reads_back_what_was_written(
    modules: Modules, rig: Rig
) -> None:
    assert registers(modules, Read(1, HOLDING, 0, 8)) == [0] * 8
    assert modules.answer(Write(1, 0, (10_700,))) == ()
    assert registers(modules, Read(1, HOLDING, 0, 2)) == [10_700, 0]
    assert rig.plant.current == pytest.approx(0.0107)


def test_only_channel_0_drives_the_valve(modules: Modules, rig: Rig) -> None:
    assert modules.answer(Write(1, 1, (5000, 6000))) == ()
    assert registers(modules, Read(1, HOLDING, 0, 3)) == [0, 5000, 6000]
    assert rig.plant.current == 0.0


@pytest.mark.parametrize(
    ("request_", "refusal"),
    [
        (Read(1, INPUT, 0), Refusal.ILLEGAL_FUNCTION),
        (Write(2, 0, (1,)), Refusal.ILLEGAL_FUNCTION),
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
    modules: Modules, rig: Rig, request_: Request, refusal: Refusal
) -> None:
    assert modules.answer(request_) is refusal
    assert registers(modules, Read(1, HOLDING, 0, 8)) == [0] * 8
    assert rig.plant.current == 0.0


def test_20_milliamperes_is_still_driven(modules: Modules, rig: Rig) -> None:
    assert modules.answer(Write(1, 0, (20_000,))) == ()
    assert rig.plant.current == pytest.approx(0.020)


def test_the_inputs_are_the_loops_in_microamperes(modules: Modules) -> None:
    pressure, opening, grip, *rest = registers(modules, Read(2, INPUT, 0, 8))
    # Both contacts are closed.
    assert rest[:2] == [20_000, 20_000]
    # At rest: 0 of 600 kPa, 85 of 100 mm, 0 of 100 N; five sigma of 8 µA.
    assert pressure == pytest.approx(4000, abs=40)
    assert opening == pytest.approx(17_600, abs=40)
    assert grip == pytest.approx(4000, abs=40)
    assert rest[2:] == [0] * 3


def test_the_input_ranges_can_be_read(modules: Modules) -> None:
    assert registers(modules, Read(2, HOLDING, 0x1000, 8)) == [2] * 8
