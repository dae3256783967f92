"""Sweeps end to end are predicted as each by itself."""

from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.fit.candidates import forms
from gripperd.diagnose.readings.course import Course, joined
from gripperd.diagnose.readings.cutting import courses
from gripperd.diagnose.residuals.explanation import AtRest, Explanation
from gripperd.diagnose.residuals.stages import INPUTS, predicted
from gripperd.diagnose.residuals.track import track_of
from gripperd.effects import EFFECTS
from gripperd.model.effect import Signal
from tests.diagnose.small import LINKAGE, MODEL, recording, with_jaws, without

SEEN = replace(
    MODEL,
    linkage=LINKAGE,
    response=0.05,
    rests={1: -0.5, 2: 0.5},
    skews=dict.fromkeys(Signal, 0.02),
)


@pytest.fixture(scope="module")
def sweeps() -> tuple[Course, ...]:
    return courses(with_jaws(recording()), 0.25)[0]


def _apart(model: Explanation, sweeps: tuple[Course, ...]) -> dict[Signal, np.ndarray]:
    found = [
        predicted(model, one, tuple(INPUTS), track_of(model, one, place))
        for place, one in enumerate(sweeps)
    ]
    return {s: np.concatenate([one[s] for one in found]) for s in INPUTS}


def _together(
    model: Explanation, sweeps: tuple[Course, ...]
) -> dict[Signal, np.ndarray]:
    whole = joined(sweeps)
    track = track_of(model, whole, *range(len(sweeps)))
    return predicted(model, whole, tuple(INPUTS), track)


def _check(model: Explanation, sweeps: tuple[Course, ...]) -> None:
    apart, together = _apart(model, sweeps), _together(model, sweeps)
    for signal in INPUTS:
        np.testing.assert_allclose(together[signal], apart[signal], rtol=1e-9)


@pytest.mark.parametrize("name", EFFECTS)
def test_no_effect_carries_over_from_one_sweep_to_the_next(
    sweeps: tuple[Course, ...], name: str
) -> None:
    for effect in forms(EFFECTS[name]):
        _check(SEEN.with_effect(effect), sweeps)


def test_friction_at_rest_turns_with_the_pressure_of_its_own_sweep(
    sweeps: tuple[Course, ...],
) -> None:
    _check(replace(SEEN, at_rest=AtRest.INFLATING), sweeps)


def test_a_column_that_one_sweep_lacks_is_not_known_there(
    sweeps: tuple[Course, ...],
) -> None:
    mute = courses(without(recording(), "current", "force"), 0.25)[0]
    _check(SEEN, (sweeps[0], mute[1], sweeps[2]))


def test_a_slope_is_that_of_each_run_by_itself(sweeps: tuple[Course, ...]) -> None:
    runs = (slice(0, 2), slice(2, 3), slice(3, len(sweeps[0])))
    track = replace(track_of(SEEN, sweeps[0], 0), slices=runs)
    value = np.random.default_rng(5).normal(size=len(sweeps[0]))
    expected = [
        np.gradient(value[run], track.time[run]) if run.stop - run.start > 1 else [0.0]
        for run in runs
    ]
    np.testing.assert_allclose(track.slope(value), np.concatenate(expected))


def test_each_run_has_the_shape_of_its_own_contraction(
    sweeps: tuple[Course, ...],
) -> None:
    whole = joined(sweeps)
    together = track_of(SEEN, whole, *range(len(sweeps)))
    for course, run in zip(sweeps, together.apart, strict=True):
        contraction = run.contraction
        assert contraction.size == len(course)
        # Eqs. (1) to (4) by the angle of the strands.
        cosine = np.cos(SEEN.muscle.braid_angle) * (1 - contraction)
        resting = np.sin(SEEN.muscle.braid_angle)
        ratio = np.sqrt(1 - cosine**2) / resting
        np.testing.assert_allclose(run.diameter_ratio, ratio, rtol=1e-9)
        area = np.pi * SEEN.muscle.diameter**2 / 4
        pull = area * (3 * cosine**2 - 1) / resting**2
        np.testing.assert_allclose(run.pull_area, pull, rtol=1e-9)
