from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.explanation import Explanation
from gripperd.diagnose.loudness import _handed_on
from gripperd.diagnose.noise import Noise
from gripperd.diagnose.problem import Problem
from gripperd.diagnose.recording import Recording, Run
from gripperd.diagnose.setup import problem_of
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose.small import (
    FORCE_NOISE,
    LINKAGE,
    MODEL,
    PRESSURE_NOISE,
    Hidden,
    Moment,
    altered,
    moments,
    recording,
    rubbing,
    textbook,
    threshold,
)
from tests.diagnose.sweep import noise

ALL = ("vented", "a", "b", "c", "d", "e", "b2", "f")


def test_the_noise_of_each_signal_is_measured(blank: Problem) -> None:
    force, pressure = blank.noises[Signal.FORCE], blank.noises[Signal.PRESSURE]
    # A fifth more than the sensor alone: smooth inputs are never quite right.
    assert force.std == pytest.approx(FORCE_NOISE, rel=0.2)
    assert pressure.std == pytest.approx(PRESSURE_NOISE, rel=0.2)
    assert max(force.correlation, pressure.correlation) < 0.2


def test_a_converter_of_coarse_steps_is_no_quieter_than_its_steps() -> None:
    """Holds read in steps of 5 N, by a sensor with a noise of 1.5 N of its own.

    Most readings repeat the one before, so all but a few changes of the residual are 0.
    """
    runs, errors = [], []
    for place, held in enumerate((0.0, 0.04, 0.08, 0.12, 0.16)):
        pressure = np.repeat([100e3, 200e3, 300e3, 400e3, 500e3], 40)
        size, level = pressure.size, np.ones(pressure.size)
        time = 200 * place + np.arange(0.0, 50.0, 0.25)
        force = textbook(Moment(time, pressure, held * level, level))
        read = 5.0 * np.round((force + noise(size, 1.5, place)) / 5.0)
        errors.append(read - force)
        columns = {
            "time": time,
            "pressure": pressure + noise(size, 200.0, 10 + place),
            "contraction": held + noise(size, 2e-5, 20 + place),
            "force": read,
        }
        runs.append(Run(str(held), columns))
    problem = problem_of(Recording("coarse", "0" * 64, tuple(runs)), MODEL, {})
    wrong = float(np.std(np.concatenate(errors)))
    assert problem.noises[Signal.FORCE].std == pytest.approx(wrong, rel=0.15)


@pytest.mark.parametrize("hidden", [threshold(25.0), rubbing(20.0)])
def test_what_is_hidden_is_not_taken_for_noise(hidden: Hidden) -> None:
    problem = problem_of(recording(hidden), MODEL, {})
    assert problem.noises[Signal.FORCE].std == pytest.approx(FORCE_NOISE, rel=0.25)
    assert problem.noises[Signal.FORCE].drift < 3.0


@pytest.mark.parametrize(
    "left_out",
    [
        pytest.param((), id="holds and repeats"),
        pytest.param(("vented",), id="repeats alone"),
        pytest.param(("b2",), id="holds alone"),
    ],
)
def test_a_sensor_that_drifts_is_seen_to_drift(left_out: tuple[str, ...]) -> None:
    runs = tuple(run for run in recording().runs if run.name not in left_out)
    told = Recording("drift", "0" * 64, runs)
    drifting = told
    for seed, name in enumerate(ALL):
        drifting = altered(drifting, [name], "force", _drifted(seed))
    still, moving = (
        problem_of(one, MODEL, {}).noises[Signal.FORCE] for one in (told, drifting)
    )
    assert moving.drift > 1.5 * still.drift
    assert moving.std == pytest.approx(FORCE_NOISE, rel=0.2)


def _drifted(seed: int) -> Callable[[Array], Array]:
    """Add a drift of 5 N that forgets in 40 samples, 10 s."""
    return lambda force: force + noise(force.size, 5.0, seed, float(np.exp(-1 / 40)))


def _gripping(told: Recording, model: Explanation) -> Problem:
    """The small rig with jaws on something as wide as they are open."""
    moment = moments()
    runs = []
    for place, one in enumerate(told.runs):
        happened = moment[one.name]
        spring = 240.0 + 1000.0 * 0.25 * happened.contraction
        grip = np.maximum((textbook(happened) - spring) / 4, 0.0)
        fresh = noise(len(one), 0.5, 70 + place)
        runs.append(Run(one.name, {**one.columns, "grip": grip + fresh}))
    return problem_of(Recording("grip", "0" * 64, tuple(runs)), model, {})


@pytest.fixture(scope="module")
def gripping() -> Problem:
    return _gripping(recording(), replace(MODEL, linkage=LINKAGE))


def test_the_force_hands_its_noise_and_drift_on_to_the_grip(gripping: Problem) -> None:
    quarter = tuple(
        replace(
            one,
            smooth={**one.smooth, "force": one.smooth["force"]._replace(leverage=0.25)},
        )
        for one in gripping.courses
    )
    problem = replace(gripping, courses=quarter)
    told = {
        Signal.FORCE: Noise(8.0, 0.0, drift=6.0),
        Signal.GRIP: Noise(3.0, 0.0, drift=0.5),
    }
    handed = _handed_on(told, problem)[Signal.GRIP]
    play = 0.01 * gripping.full_scale[Signal.GRIP]
    # By the ratio of 4: a quarter of 64 N², 36 N², and what it has of its own.
    assert handed.drift**2 == pytest.approx(16 / 16 + 36 / 16 + 0.25 + play**2)
    # What the force brings is slow, so the fast part is that of the sensor alone.
    assert handed.std == pytest.approx(0.5, abs=0.2)
    assert _handed_on(told, problem)[Signal.FORCE] == told[Signal.FORCE]


def test_a_grip_is_weighed_by_what_its_force_brings(gripping: Problem) -> None:
    loud = _gripping(recording(noise=30.0), gripping.model)
    plain, handed = (one.noises[Signal.GRIP] for one in (gripping, loud))
    assert handed.drift > 1.3 * plain.drift
    assert handed.std == pytest.approx(0.5, abs=0.2)
