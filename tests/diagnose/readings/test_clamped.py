from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.readings.cutting import courses
from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.diagnose.residuals.usable import usable
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose.sweep import noise, run

RISING = np.interp(np.arange(200), [50, 150], [260.0, 600.0])
STEADY = np.full(200, 600.0)
APART = np.full(200, 100.0)


def _sweep(name: str, force: Array, seed: int) -> Run:
    """Jaws that press by what a spring of 240 N leaves of the pull, through 1 to 4."""
    told = run(
        name,
        force=force + noise(200, 2.0, seed),
        pressure=600.0 * force + noise(200, 500.0, seed + 1),
        contraction=np.full(200, 0.08) + noise(200, 2e-4, seed + 2),
        grip=np.maximum(force - 240.0, 0.0) / 4 + noise(200, 0.3, seed + 3),
    )
    return replace(told, columns={**told.columns, "time": told.columns["time"] + seed})


def _without(told: Run, name: str) -> Run:
    columns = {key: one for key, one in told.columns.items() if key != name}
    return replace(told, columns=columns)


def _cut(*forces: Array, blind: bool = False) -> tuple[Course, ...]:
    runs = [_sweep(f"{n}", force, 100 * n) for n, force in enumerate(forces, 1)]
    if blind:
        runs = [_without(one, "force") for one in runs]
    return courses(Recording("r", "0" * 64, tuple(runs)), 0.25)[0]


@pytest.mark.parametrize("blind", [False, True])
def test_a_steady_grasp_tells_nothing_where_the_load_of_others_turns(
    *, blind: bool
) -> None:
    grasp, hold = _cut(RISING, STEADY, blind=blind)
    assert (grasp.clamped, hold.clamped) == (False, True)
    assert usable(grasp, Signal.GRIP).sum() > 80
    assert not usable(hold, Signal.GRIP).any()


def test_where_nothing_else_is_grasped_it_is_all_there_is() -> None:
    sweeps = _cut(STEADY, STEADY, APART)
    assert not any(one.clamped for one in sweeps)
    assert usable(sweeps[0], Signal.GRIP).sum() > 180


def test_jaws_that_press_on_nothing_hold_nothing() -> None:
    _, free = _cut(RISING, APART)
    assert not free.clamped
