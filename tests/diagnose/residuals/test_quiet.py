"""Holds that come after something else: the rig goes to a length, and fills."""

import numpy as np
import pytest

from gripperd.diagnose.noise.drift import Quiet
from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.residuals.quiet import driven, repeated, vented
from gripperd.diagnose.setup import problem_of
from gripperd.model.effect import Signal
from tests.diagnose.small import MODEL, Moment, recording, textbook
from tests.diagnose.sweep import noise

STEP = 0.1
SIZE = 600
TRUE = Noise(4.0, 0.48, white=0.4)


def _run(name: str, start: float, pressure: float, *, leaves: bool = False) -> Run:
    """Ten seconds to 5 % of contraction, five to a pressure, and the rest a hold."""
    since = STEP * np.arange(SIZE, dtype=np.float64)
    filled = np.interp(since, [0.0, 10.0, 15.0], [0.0, 0.0, pressure])
    way = np.interp(since, [0.0, 10.0], [0.0, 0.05])
    if leaves:
        way = way + np.interp(since, [15.0, 60.0], [0.0, 0.08])
    level = np.ones(SIZE)
    seed = int(start)
    slow = noise(SIZE, TRUE.std * (1 - TRUE.white) ** 0.5, seed, TRUE.persistence)
    fast = noise(SIZE, TRUE.std * TRUE.white**0.5, seed + 1)
    force = textbook(Moment(start + since, filled, way, level)) + slow + fast
    columns = {
        "time": start + since,
        "pressure": filled + noise(SIZE, 300.0, seed + 2),
        "contraction": way + noise(SIZE, 5e-5, seed + 3),
        "force": force,
    }
    return Run(name, columns)


def _held(told: Problem) -> list[Quiet]:
    residuals = told.residuals(Point(np.zeros(len(told.constants))))
    forces = [i for i, b in enumerate(told.blocks) if b.signal is Signal.FORCE]
    return driven(told, residuals, forces)


def _problem(*runs: Run) -> Problem:
    swept = [run for run in recording().runs if run.name in "acdef"]
    return problem_of(Recording("holds", "0" * 64, (*swept, *runs)), MODEL, {})


def test_a_hold_begins_once_the_pressure_has_come() -> None:
    (quiet,) = _held(_problem(_run("hold", 1000.0, 400e3)))
    since = quiet.time - 1000.0
    # The last 3 % of the way to its pressure take 0.15 s, and two more are left out.
    assert 16.5 < since[0] < 17.5
    assert since[-1] == pytest.approx(STEP * (SIZE - 1))


def test_what_travels_holds_nothing() -> None:
    assert _held(_problem(_run("isobar", 1000.0, 400e3, leaves=True))) == []


def test_a_muscle_without_air_may_have_come_from_elsewhere() -> None:
    told = _problem(_run("empty", 1000.0, 0.0))
    (quiet,) = vented(told, Signal.FORCE)
    assert quiet.time.size > 450
    assert _held(told) == []


def test_the_noise_of_holds_that_were_filled_is_heard() -> None:
    told = _problem(_run("one", 1000.0, 400e3), _run("other", 2000.0, 250e3))
    found = told.noises[Signal.FORCE]
    assert found.slow_variance == pytest.approx(TRUE.slow_variance, rel=0.4)


def test_a_sweep_is_held_against_its_next_repeat_where_the_one_before_was_new() -> None:
    """Of three alike the first is that of a new muscle, which may differ."""
    told = problem_of(recording(order=("b", "b2", "c", "b", "a", "d", "e")), MODEL, {})
    residuals = told.residuals(Point(np.zeros(len(told.constants))))
    forces = [i for i, b in enumerate(told.blocks) if b.signal is Signal.FORCE]
    new, used = (
        [one.time[0] for one in repeated(told, residuals, forces, first=first)]
        for first in (True, False)
    )
    times = [course.time[0] for course in told.courses]
    assert (new, used) == ([times[0]], [times[1]])
