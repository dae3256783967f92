"""Watchdogs in registers, over the time of the bench."""

from collections.abc import Sequence

import pytest

from gripperd.bench.modules import Modules
from gripperd.bench.rig import Rig
from gripperd.protocol.modbus import Read, Refusal, Request, Table, Write, WriteCoil

from .line import fitted
from .test_modules import ask, refusal

HOLDING, COILS = Table.HOLDING, Table.COILS
WAGO = (Write(1, 0x1000, (5,)), Write(1, 0x100A, (1,)))
ICPDAS = (Write(1, 488, (5,)), WriteCoil(1, 260, on=True))
STATUS = Read(1, HOLDING, 0x1006)


def armed(rig: Rig, name: str, arming: Sequence[Request], set_point: int) -> Modules:
    """A module with 0.5 s of patience, that gives 20 mA."""
    modules = Modules(rig, *fitted(name))
    for request in (Write(1, 0, (set_point,)), *arming):
        ask(modules, request)
    assert rig.plant.current == pytest.approx(0.020)
    return modules


def test_a_wago_coupler_goes_to_4_ma_when_its_host_falls_silent(rig: Rig) -> None:
    modules = armed(rig, "wago_750_554", WAGO, 0x7FF8)
    assert ask(modules, STATUS) == [1]
    modules.advance(0.499)
    assert rig.plant.current == pytest.approx(0.020)
    modules.advance(0.501)
    assert rig.plant.current == pytest.approx(0.004)
    assert ask(modules, STATUS) == [2]
    assert ask(modules, Read(1, HOLDING, 0x0200)) == [0]


def test_it_trips_at_its_time_also_when_nobody_looks(rig: Rig) -> None:
    modules = armed(rig, "wago_750_554", WAGO, 0x7FF8)
    modules.advance(0.55)
    # Filled for 0.5 s and vented for 0.05 s: tripped earlier it were empty, later full.
    assert 100e3 < rig.plant.pressure < 450e3
    modules.advance(5.0)
    assert rig.plant.pressure == pytest.approx(0.0, abs=1.0)


def test_every_request_keeps_it_quiet(rig: Rig) -> None:
    modules = armed(rig, "wago_750_554", WAGO, 0x7FF8)
    for step in range(1, 10):
        modules.advance(0.4 * step)
        assert ask(modules, STATUS) == [1]
    modules.advance(0.4 * 9 + 0.51)
    assert ask(modules, STATUS) == [2]


def test_a_request_to_another_unit_does_not_keep_it_quiet(rig: Rig) -> None:
    modules = Modules(rig, *fitted("wago_750_554", "waveshare_ai_8ch"))
    for request in WAGO:
        ask(modules, request)
    modules.advance(0.4)
    ask(modules, Read(2, Table.INPUT, 0))
    modules.advance(0.6)
    assert ask(modules, STATUS) == [2]


def test_a_trip_latches_until_it_is_cleared(rig: Rig) -> None:
    modules = armed(rig, "wago_750_554", WAGO, 0x7FF8)
    modules.advance(1.0)
    assert refusal(modules, Write(1, 0, (0x7FF8,))) == Refusal.DEVICE_FAILURE
    assert rig.plant.current == pytest.approx(0.004)
    ask(modules, Write(1, 0x1007, (1,)))
    assert ask(modules, STATUS) == [0]
    ask(modules, Write(1, 0, (0x7FF8,)))
    assert rig.plant.current == pytest.approx(0.020)
    ask(modules, WAGO[1])
    assert ask(modules, STATUS) == [1]


def test_a_time_out_stays_while_the_watchdog_runs(rig: Rig) -> None:
    modules = armed(rig, "wago_750_554", WAGO, 0x7FF8)
    assert refusal(modules, Write(1, 0x1000, (9,))) == Refusal.ILLEGAL_VALUE
    ask(modules, Write(1, 0x100A, (0,)))
    ask(modules, Write(1, 0x1000, (9,)))
    assert ask(modules, Read(1, HOLDING, 0x1000)) == [9]
    modules.advance(60.0)
    assert ask(modules, STATUS) == [0]


def test_the_signs_of_a_watchdog_cannot_be_written(rig: Rig) -> None:
    modules = armed(rig, "wago_750_554", WAGO, 0x7FF8)
    assert refusal(modules, Write(1, 0x1006, (0,))) == Refusal.ILLEGAL_ADDRESS


def test_the_trip_of_an_m_7024_outlives_a_power_cycle(rig: Rig) -> None:
    modules = armed(rig, "icpdas_i_7024", ICPDAS, 20_000)
    assert ask(modules, Read(1, COILS, 260)) == [1]
    modules.advance(1.0)
    modules.power_cycle(1)
    assert ask(modules, Read(1, COILS, 269)) == [1]
    assert refusal(modules, Write(1, 0, (20_000,))) == Refusal.DEVICE_FAILURE
    ask(modules, WriteCoil(1, 269, on=True))
    assert ask(modules, Read(1, COILS, 269)) == [0]
    ask(modules, Write(1, 0, (20_000,)))
    assert rig.plant.current == pytest.approx(0.020)


def test_the_trip_of_a_wago_coupler_does_not(rig: Rig) -> None:
    modules = armed(rig, "wago_750_554", WAGO, 0x7FF8)
    modules.advance(1.0)
    modules.power_cycle(1)
    assert ask(modules, STATUS) == [0]


def test_a_safe_value_that_was_written_is_what_a_trip_gives(rig: Rig) -> None:
    modules = Modules(rig, *fitted("adam_6224"))
    ask(modules, Write(1, 410, (2048,)))
    assert ask(modules, Read(1, HOLDING, 410, 2)) == [2048, 0]
    modules.trip(1)
    assert rig.plant.current == pytest.approx(4e-3 + 16e-3 * 2048 / 4095)
    # Bit 2 of the second status register of each channel.
    assert ask(modules, Read(1, HOLDING, 100, 4)) == [0, 1 << 2, 0, 1 << 2]
