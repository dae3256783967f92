"""Memory of pressure."""

from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.diagnosis import diagnose
from gripperd.effects import EFFECTS
from gripperd.effects.pressure_hysteresis import PressureHysteresis
from gripperd.model import Direction, Muscle, StaticMuscle
from gripperd.model.preisach import Hysteron
from gripperd.model.track import Array
from tests.diagnose.small import MODEL, Moment, recording
from tests.effects.tracks import track_of

HYSTERESIS = PressureHysteresis(near=4.0, middle=8.0, far=6.0, pressure=30e3)
TRIANGLE = np.concatenate([np.linspace(0, 400e3, 81), np.linspace(400e3, 0, 81)[1:]])


def force(
    muscle: Muscle,
    effect: PressureHysteresis,
    contraction: float = 0.0,
    pressure: Array = TRIANGLE,
) -> Array:
    track = track_of(muscle, pressure=pressure, contraction=contraction)
    return effect.along(np.zeros_like(pressure), track, effect.rest())


@pytest.mark.parametrize("contraction", [0.0, 0.15])
def test_at_a_fixed_length_inflating_pulls_less_than_deflating(
    muscle: Muscle, contraction: float
) -> None:
    pull = force(muscle, HYSTERESIS, contraction)
    up, down = pull[:81], pull[80:][::-1]
    assert np.all(down[:-1] > up[:-1])
    assert (up[40], down[20]) == pytest.approx((-18.0, 18.0))


def test_it_bends_at_a_third_one_and_three_radii(muscle: Muscle) -> None:
    pressure = np.array([0.0, 10e3, 30e3, 90e3, 300e3])
    expected = [0, 4 + 8 / 3 + 6 / 9, 4 + 8 + 6 / 3, 18, 18]
    reached = force(muscle, HYSTERESIS, pressure=pressure)
    assert -reached == pytest.approx(expected)


def test_a_record_may_begin_as_a_way_from_no_pressure_left_it(muscle: Muscle) -> None:
    whole = force(muscle, HYSTERESIS)
    begun = replace(HYSTERESIS, begun=1.0)
    for start in (4, 20, 60):
        cut = TRIANGLE[start:]
        assert force(muscle, begun, pressure=cut) == pytest.approx(whole[start:])
    half = force(muscle, replace(HYSTERESIS, begun=0.5), pressure=TRIANGLE[20:])
    assert half[0] == pytest.approx(whole[20] / 2)
    assert half[-1] == pytest.approx(whole[-1])
    vented = np.full(2, -4e3)
    assert force(muscle, begun, pressure=vented).tolist() == [0.0, 0.0]


@pytest.mark.parametrize(
    ("inflations", "kept", "exercised", "keeps"),
    [
        (0, 1.0, 0.0, False),
        (1, 1.0, 0.0, True),
        (3, 1.0, 0.0, True),
        (0, 0.0, 1.0, True),
        (1, 0.0, 1.0, False),
    ],
)
def test_a_muscle_inflated_before_keeps_what_deflating_it_has_loaded(
    muscle: Muscle, inflations: int, kept: float, exercised: float, *, keeps: bool
) -> None:
    keeping = replace(HYSTERESIS, begun=1.0, kept=kept, exercised=exercised)
    again = np.concatenate([TRIANGLE, TRIANGLE[1:]])
    both = force(muscle, HYSTERESIS, pressure=again)
    second = both[TRIANGLE.size - 1 :]
    assert second[0] == pytest.approx(18.0)
    for start in (4, 20):
        track = track_of(
            muscle, pressure=TRIANGLE[start:], contraction=0.0, cycle=float(inflations)
        )
        found = keeping.along(np.zeros(track.pressure.size), track, keeping.rest())
        assert (found == pytest.approx(second[start:])) is keeps


def test_a_vented_muscle_that_was_inflated_before_the_record_pulls(
    muscle: Muscle,
) -> None:
    vented = np.full(3, -100.0)
    used = replace(HYSTERESIS, exercised=1.0)
    assert force(muscle, used, pressure=vented) == pytest.approx([18.0] * 3)
    half = replace(HYSTERESIS, exercised=0.5)
    assert force(muscle, half, pressure=vented) == pytest.approx([9.0] * 3)


def test_only_a_record_without_a_past_begins(muscle: Muscle) -> None:
    begun = replace(HYSTERESIS, begun=1.0)
    track = track_of(muscle, pressure=TRIANGLE, contraction=0.0)
    memory = begun.rest()
    begun.along(np.zeros_like(TRIANGLE), track, memory)
    left = memory.copy()
    again = track_of(muscle, pressure=TRIANGLE[-1:], contraction=0.0)
    begun.along(np.zeros(1), again, memory)
    assert memory.tolist() == left.tolist()


def test_speed_makes_no_difference(muscle: Muscle) -> None:
    slow = force(muscle, HYSTERESIS, pressure=np.repeat(TRIANGLE, 2))
    assert slow[::2].tolist() == force(muscle, HYSTERESIS).tolist()


def test_with_full_leverage_it_is_a_lost_pressure(muscle: Muscle) -> None:
    lost = PressureHysteresis(4.0, 8.0, 6.0, 30e3, leverage=1.0)
    pressures = [
        force(muscle, lost, contraction)
        / float(StaticMuscle(muscle).force(1.0, contraction))
        for contraction in (0.0, 0.1, 0.2)
    ]
    assert pressures[1] == pytest.approx(pressures[0])
    assert pressures[2] == pytest.approx(pressures[0])
    assert force(muscle, lost).tolist() == force(muscle, HYSTERESIS).tolist()


@pytest.mark.parametrize("leverage", [0.0, 1.0])
def test_after_a_long_way_it_is_that_of_a_prediction(
    muscle: Muscle, leverage: float
) -> None:
    effect = PressureHysteresis(4.0, 8.0, 6.0, 30e3, leverage)
    static, ideal = StaticMuscle(muscle, (effect,)), StaticMuscle(muscle)
    run = force(muscle, effect, 0.1)
    for index, direction in ((80, Direction.CONTRACTING), (-1, Direction.EXTENDING)):
        settled = static.force(3e5, 0.1, direction) - ideal.force(3e5, 0.1)
        assert run[index] == pytest.approx(settled)


def test_a_muscle_without_ideal_pull_has_none_to_lose(muscle: Muscle) -> None:
    lost = PressureHysteresis(4.0, 8.0, 6.0, 30e3, leverage=0.5)
    assert np.all(force(muscle, lost, muscle.spent + 0.01) == 0)


RELAYS = PressureHysteresis(
    hysteron=Hysteron.RELAY, relays=40.0, radius=12.5e3, width=0.25, wide=0.4,
    centre=200e3,
)  # fmt: skip


def test_relays_pull_less_while_inflating_and_alike_at_the_ends(muscle: Muscle) -> None:
    wide = np.concatenate([np.linspace(0, 900e3, 91), np.linspace(900e3, 0, 91)[1:]])
    pull = force(muscle, RELAYS, pressure=wide)
    up, down = pull[:91], pull[90:][::-1]
    # Of each group the share between its two ways is up on the way down alone.
    shares = np.tanh(0.5 * np.array([0.25, 0.75]))
    assert down[20] - up[20] == pytest.approx(40 * np.dot([0.6, 0.4], shares), rel=1e-3)
    assert up[20] == pytest.approx(-down[20], rel=1e-3)
    assert pull[[0, 90]] == pytest.approx([0, 0], abs=0.5)


@pytest.mark.parametrize("leverage", [0.0, 1.0])
def test_after_a_long_way_relays_are_those_of_a_prediction(
    muscle: Muscle, leverage: float
) -> None:
    relays = replace(RELAYS, curve=1.0, leverage=leverage)
    reached = force(muscle, relays, 0.1)[60]
    static = StaticMuscle(muscle, (relays,))
    bare = StaticMuscle(muscle, ())
    expected = static.force(300e3, 0.1, Direction.CONTRACTING)
    assert expected - bare.force(300e3, 0.1, Direction.CONTRACTING) == pytest.approx(
        reached, rel=1e-3
    )


def _loses_work(moment: Moment) -> Array:
    """Dahl's 40 N over 25 kPa, in a muscle that was inflated and vented before."""
    way = np.diff(moment.pressure, prepend=0.0)
    sign, pull = -1.0, np.empty_like(way)
    for index, gone in enumerate(way):
        toward = np.sign(gone) if gone else sign
        sign = toward + (sign - toward) * np.exp(-abs(gone) / 25e3)
        pull[index] = -40.0 * sign
    return pull


@pytest.mark.parametrize("seed", [1, 2])
def test_what_a_vented_muscle_keeps_from_before_the_record_is_no_other_effect(
    seed: int,
) -> None:
    names = ("pressure_hysteresis", "first_cycle", "force_sensor_bias", "length_datum")
    library = {name: EFFECTS[name] for name in names}
    told = diagnose(recording(_loses_work, seed=seed), MODEL, {}, library)
    assert [one.name for one in told.named] == ["pressure_hysteresis"]
    (effect,) = told.explained.effects[-1:]
    assert isinstance(effect, PressureHysteresis)
    assert effect.exercised > 0.7
