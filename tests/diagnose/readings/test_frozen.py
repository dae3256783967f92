from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.readings.frozen import frozen
from gripperd.diagnose.readings.recording import Run
from tests.diagnose.sweep import noise, pulled, run, triangle


def _rows(runs: Sequence[Run]) -> dict[tuple[int, str], list[int]]:
    return {
        (fault.run, fault.quantity): np.flatnonzero(fault.rows).tolist()
        for fault in frozen(runs)
    }


def _stuck(sweep: Run, quantity: str, start: int, end: int) -> Run:
    values = sweep.columns[quantity].copy()
    values[start:end] = values[start]
    return replace(sweep, columns={**sweep.columns, quantity: values})


@pytest.mark.parametrize("quantity", ["force", "pressure"])
@pytest.mark.parametrize("memory", [0.0, 0.6])
def test_a_channel_whose_noise_stops_is_frozen(quantity: str, memory: float) -> None:
    sweep = pulled()
    values = sweep.columns[quantity] + noise(400, 4e3, memory=memory)
    sweep = replace(sweep, columns={**sweep.columns, quantity: values})
    found = _rows([_stuck(sweep, quantity, 100, 130)])
    assert found == {(0, quantity): list(range(100, 130))}


def test_a_vibration_does_not_hide_that_a_channel_is_frozen() -> None:
    vibration = 30.0 * np.sin(0.6 * np.arange(400.0))
    force = 300.0 + vibration + noise(400, 3.0)
    found = _rows([_stuck(run(force=force), "force", 100, 130)])
    assert found == {(0, "force"): list(range(100, 130))}


def test_a_slow_simulated_wave_without_noise_may_stand_still() -> None:
    force = np.round(300.0 + 50.0 * np.sin(0.02 * np.arange(400.0)), 3)
    assert _rows([_stuck(run(force=force), "force", 100, 130)]) == {}


def test_a_locked_sensor_with_noise_may_freeze_too() -> None:
    contraction = 0.1 + noise(200, 1e-4)
    contraction[50:70] = contraction[50]
    assert _rows([run(contraction=contraction)]) == {
        (0, "contraction"): list(range(50, 70))
    }


def test_a_coarse_force_that_stands_while_pressure_moves_is_frozen() -> None:
    sweep = _stuck(pulled(step=20.0), "force", 100, 180)
    ((key, rows),) = _rows([sweep]).items()
    assert key == (0, "force")
    assert set(range(100, 180)) <= set(rows)
    assert len(rows) < 90


def test_a_whole_run_may_be_frozen() -> None:
    stuck = _stuck(pulled("b"), "force", 0, 400)
    assert _rows([pulled("a"), stuck]) == {(1, "force"): list(range(400))}


def test_a_weight_lifted_by_rising_pressure_is_not_frozen() -> None:
    sweep = run(
        pressure=triangle(),
        contraction=0.2 * triangle() / 500e3,
        force=np.full(400, 68.7),
    )
    assert _rows([sweep]) == {}


@pytest.mark.parametrize("step", [2.0, 6.0, 50.0])
def test_a_coarse_channel_is_not_frozen(step: float) -> None:
    assert _rows([pulled(step=step, seed=seed) for seed in range(3)]) == {}


def test_a_coarse_plateau_after_a_rough_rise_is_not_frozen() -> None:
    draws = np.random.default_rng(8)
    rise = np.cumsum(draws.uniform(1.0, 60.0, 150))
    plateau = rise[-1] + 2.0 * (draws.random(60) < 0.1)
    force = np.round(np.r_[rise, plateau, rise[::-1]] / 2.0) * 2.0
    assert _rows([run(force=force)]) == {}


def test_commands_and_locks_may_stand_for_ever() -> None:
    staircase = np.repeat(np.linspace(4e-3, 20e-3, 8), 50)
    locked = np.repeat([0.0, 0.05, 0.1, 0.05], 100)
    sweep = run(
        current=staircase,
        contraction=locked,
        object=np.full(400, 0.06),
        pressure=staircase * 25e6 + noise(400, 1e3),
    )
    assert _rows([sweep]) == {}


def test_a_simulated_hold_without_noise_is_not_frozen() -> None:
    ramp = np.round(np.linspace(100.0, 400.0, 200) ** 1.01, 3) * 1e3
    pressure = np.r_[ramp, np.full(100, ramp[-1])]
    assert _rows([run(pressure=pressure)]) == {}


def test_a_smooth_wave_of_full_precision_may_stand_still() -> None:
    force = 300.0 + 50.0 * np.sin(0.5 * np.arange(400.0))
    assert _rows([_stuck(run(force=force), "force", 100, 130)]) == {}


def test_a_command_may_dither_and_then_stand() -> None:
    current = 12e-3 + noise(400, 1e-4)
    assert _rows([_stuck(run(current=current), "current", 100, 130)]) == {}


def test_a_converter_that_often_repeats_itself_is_not_frozen() -> None:
    often = np.random.default_rng(5).choice([1, 1, 2, 3, 6, 12], 200)
    assert _rows([run(force=np.repeat(noise(200, 4.0), often))]) == {}


def test_a_converter_slower_than_the_logger_is_not_frozen() -> None:
    force = np.repeat(noise(100, 4.0), 12) + 300
    assert _rows([run(force=force, pressure=250e3 + noise(1200, 1e3))]) == {}


def test_a_hold_with_a_coarse_force_is_not_frozen() -> None:
    sweep = run(
        pressure=400e3 + noise(600, 2e3, memory=0.6),
        contraction=np.full(600, 0.1),
        force=np.full(600, 702.0),
    )
    assert _rows([sweep]) == {}


def test_a_force_that_never_changes_is_frozen_wherever_the_muscle_goes() -> None:
    """Held, its pressure tells; where it travels the cell is as dead."""
    dead = np.full(400, 300.0)
    held = run("held", pressure=triangle(), contraction=np.full(400, 0.1), force=dead)
    moved = run(
        "moved",
        pressure=300e3 + noise(400, 1e3),
        contraction=triangle() / 5e6,
        force=dead,
    )
    found = _rows([held, moved])
    assert len(found[1, "force"]) == 400
    alive = run("alive", pressure=triangle(), force=500.0 + noise(400, 4.0))
    assert (1, "force") not in _rows([held, moved, alive])
