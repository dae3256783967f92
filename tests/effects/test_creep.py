"""Creep of the rubber."""

from dataclasses import replace

import numpy as np
import pytest

from gripperd.effects.creep import Creep, Creeping, Holding
from gripperd.model import Muscle
from gripperd.model.effect import MuscleState
from gripperd.model.track import Array
from tests.effects.tracks import track_of

CREEP = Creep(fast=0.01, medium=0.02, slow=0.04, time=2.0)
TIMES = np.array([2.0, 12.0, 72.0])
SHARES = np.array([0.01, 0.02, 0.04])
TIME = np.arange(0.0, 300.0, 0.5)


def late(muscle: Muscle, effect: Creep, pressure: Array | float) -> Array:
    """What has not come yet."""
    step = np.diff(TIME, prepend=0.0)
    track = track_of(muscle, time=TIME, step=step, pressure=pressure)
    return -effect.along(np.zeros_like(TIME), track, effect.rest())


def left_of(pull: float) -> Array:
    """A generalised Maxwell element after a step, by its series of exponentials."""
    found: Array = pull * np.exp(-TIME[:, None] / TIMES) @ SHARES
    return found


def test_after_a_step_it_comes_with_three_time_constants(muscle: Muscle) -> None:
    pressure = np.where(TIME > 0, 400e3, 0.0)
    pull = 400e3 * float(muscle.pull_area(0.0))
    # Where the step lies between the first two samples, it was made at the second.
    expected = left_of(pull)[1:]
    assert late(muscle, CREEP, pressure)[1:] == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("waited", [0.0, 4.0, 60.0])
def test_a_record_under_pressure_goes_on_where_the_wait_before_it_ended(
    muscle: Muscle, waited: float
) -> None:
    pull = 400e3 * float(muscle.pull_area(0.0))
    found = late(muscle, replace(CREEP, fresh=np.exp(-waited / 12.0)), 400e3)
    # What the same step would have left of it so much later.
    expected = pull * np.exp(-(TIME[:, None] + waited) / TIMES) @ SHARES
    assert found == pytest.approx(expected, rel=1e-6)


SHORTENED = np.where(TIME > 0, 0.1, 0.0)


def of_the_rubber(muscle: Muscle) -> float:
    """Eq. (5) of the paper a tenth shorter, at the constants of the muscle. [N]."""
    cosine = 0.9 * np.cos(muscle.braid_angle)
    wider = np.sqrt(1 - cosine**2) / np.sin(muscle.braid_angle)
    hoop = 0.81 / np.tan(muscle.braid_angle) ** 2 * (1 - 1 / wider)
    modulus = muscle.elastic_modulus * muscle.wall_thickness * np.pi * muscle.diameter
    return float(modulus * (hoop + 0.1 * wider))


def shortened(muscle: Muscle, effect: Creep, pressure: float) -> Array:
    """What it adds to the pull by a tenth shorter at once."""
    step = np.diff(TIME, prepend=0.0)
    track = track_of(
        muscle, time=TIME, step=step, pressure=pressure, contraction=SHORTENED
    )
    return effect.along(np.zeros_like(TIME), track, effect.rest())


def test_a_bladder_relaxes_under_its_own_stretch(muscle: Muscle) -> None:
    """Its rubber pulls back by 5 times the shares more."""
    effect = replace(CREEP, of=Creeping.RUBBER)
    forces = [shortened(muscle, effect, bar) for bar in (1e5, 4e5)]
    expected = left_of(5 * of_the_rubber(muscle))[1:]
    assert -forces[0][1:] == pytest.approx(expected, rel=1e-6)
    np.testing.assert_array_equal(forces[0], forces[1])


@pytest.mark.parametrize("even", [0.3, 1.0])
def test_what_relaxes_may_go_with_the_length_as_a_spring(
    muscle: Muscle, even: float
) -> None:
    """As stiff as eq. (5) is at rest length: s'(0) is 1 / tan² of the angle there."""
    effect = replace(CREEP, of=Creeping.RUBBER, even=even)
    modulus = muscle.elastic_modulus * muscle.wall_thickness * np.pi * muscle.diameter
    spring = 0.1 * modulus * (1 / np.tan(muscle.braid_angle) ** 4 + 1)
    told = (1 - even) * of_the_rubber(muscle) + even * spring
    expected = left_of(5 * told)[1:]
    assert -shortened(muscle, effect, 4e5)[1:] == pytest.approx(expected, rel=1e-6)


def test_what_rubber_takes_of_the_pull_may_come_late_with_it(muscle: Muscle) -> None:
    """With a fifth of the stretch, by the shares of what eq. (5) takes."""
    effect = replace(CREEP, stretch=0.2)
    expected = left_of(of_the_rubber(muscle))[1:]
    assert shortened(muscle, effect, 0.0)[1:] == pytest.approx(expected, rel=1e-6)
    both = shortened(muscle, effect, 4e5) - shortened(muscle, CREEP, 4e5)
    assert both[1:] == pytest.approx(expected, rel=1e-6)


def test_what_is_late_of_a_pressure_pulls_at_the_length_of_now(muscle: Muscle) -> None:
    """By a tenth shorter 50 s after a step, by A(h) of eq. (4) as the paper has it."""
    shortened = np.where(TIME >= 50.0, 0.1, 0.0)
    pressure = np.where(TIME > 0, 400e3, 0.0)
    cosine = (1 - shortened) * np.cos(muscle.braid_angle)
    ring = np.pi * muscle.diameter**2 / (4 * np.sin(muscle.braid_angle) ** 2)
    found = _pressed(muscle, pressure, shortened)
    expected = left_of(400e3 * ring) * (3 * cosine**2 - 1)
    assert found[1:] == pytest.approx(expected[1:], rel=1e-6)


def test_a_travel_under_a_settled_pressure_calls_nothing_up(muscle: Muscle) -> None:
    shortened = np.linspace(0.0, 0.2, TIME.size)
    assert _pressed(muscle, np.full(TIME.size, 400e3), shortened) == pytest.approx(0.0)


def _pressed(muscle: Muscle, pressure: Array, contraction: Array) -> Array:
    """What is late of a pressure that the bladder passes on. [N]."""
    step = np.diff(TIME, prepend=0.0)
    track = track_of(
        muscle, time=TIME, step=step, pressure=pressure, contraction=contraction
    )
    effect = replace(CREEP, of=Creeping.PRESSURE)
    return -effect.along(np.zeros_like(TIME), track, effect.rest())


def test_where_the_model_holds_at_once_all_that_comes_later_is_beyond_it(
    muscle: Muscle,
) -> None:
    pressure = np.where(TIME > 0, 400e3, 0.0)
    pull = 400e3 * float(muscle.pull_area(0.0))
    beyond = -late(muscle, replace(CREEP, holds=Holding.AT_ONCE), pressure)
    come = pull * SHARES.sum() - left_of(pull)
    assert beyond[1:] == pytest.approx(come[1:], rel=1e-6)


@pytest.mark.parametrize("of", Creeping)
@pytest.mark.parametrize("holds", Holding)
def test_its_static_force_is_what_a_long_wait_leaves(
    muscle: Muscle, of: Creeping, holds: Holding
) -> None:
    effect = replace(CREEP, of=of, holds=holds, leverage=0.4, stretch=0.3, even=0.6)
    at = MuscleState(300e3, 0.1, muscle.diameter_ratio(0.1), 1.0)
    step = np.array([0.0, 1e5])
    track = track_of(muscle, time=step, step=step, pressure=300e3, contraction=0.1)
    settled = effect.along(np.zeros(2), track, effect.rest())[-1]
    assert effect.force(at, muscle) == pytest.approx(settled, rel=1e-9, abs=1e-9)
    assert (abs(settled) > 1.0) == (holds is Holding.AT_ONCE)


def test_what_has_settled_stays(muscle: Muscle) -> None:
    assert late(muscle, replace(CREEP, fresh=0.0), 400e3) == pytest.approx(0.0)


def test_a_reading_that_was_lost_at_first_begins_nothing_anew(muscle: Muscle) -> None:
    effect = Creep(fast=0.05)
    pressure = np.where(TIME < 20.0, 100e3, 300e3)
    pressure[0] = np.nan
    whole = late(muscle, effect, pressure)
    memory = effect.rest()
    pieces = [
        -effect.along(
            np.zeros(TIME[part].size),
            track_of(
                muscle, time=TIME[part], step=np.diff(TIME, prepend=0.0)[part],
                pressure=pressure[part],
            ),
            memory,
        )
        for part in (slice(45), slice(45, None))
    ]  # fmt: skip
    np.testing.assert_allclose(np.concatenate(pieces), whole)


def test_only_a_record_without_a_past_begins(muscle: Muscle) -> None:
    effect = replace(CREEP, fresh=1.0)
    pressure = 300e3 + 100e3 * np.sin(TIME / 20)
    whole = late(muscle, effect, pressure)
    memory = effect.rest()
    for index, one in enumerate(pressure[:50]):
        track = track_of(
            muscle, time=TIME[index], step=0.5 if index else 0.0, pressure=float(one)
        )
        found = -effect.along(np.zeros(1), track, memory)
        assert found == pytest.approx(whole[index])
