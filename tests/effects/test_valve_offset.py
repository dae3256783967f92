"""The regulator's line, shifted."""

import numpy as np
import pytest

from gripperd.diagnose.diagnosis import diagnose
from gripperd.diagnose.verdict.conclude import Verdict
from gripperd.effects import EFFECTS
from gripperd.effects.valve_offset import ValveOffset, Zero
from gripperd.model import Chain, Muscle
from gripperd.model.outlet import Outlet
from gripperd.model.track import Array
from tests.diagnose.sleeping import stuck
from tests.diagnose.small import MODEL
from tests.effects.tracks import track_of

SPAN = (0.0, 500e3)
VALVES = {
    name: EFFECTS[name]
    for name in ("valve_offset", "valve_gain", "valve_nonlinearity", "valve_lag")
}


def test_the_whole_line_is_shifted_by_as_much(muscle: Muscle) -> None:
    effect = ValveOffset(offset=-5e3)
    asked = np.array([0.0, 100e3, 500e3])
    found = effect.along(asked, track_of(muscle, command=asked), effect.rest())
    assert found == pytest.approx([-5e3, 95e3, 495e3])


def test_a_steady_pressure_is_shifted_too() -> None:
    assert ValveOffset(offset=3e3).settled(200e3, SPAN) == 203e3


def test_a_regulator_that_suppresses_its_zero_vents_there(muscle: Muscle) -> None:
    effect = ValveOffset(offset=8e3, zero=Zero.SUPPRESSED)
    # A read-back repeats to 0.02 mA, 0.6 kPa here.
    asked = np.array([0.6e3, 0.0, 20e3, 500e3])
    found = effect.along(asked, track_of(muscle, command=asked), effect.rest())
    assert found == pytest.approx([0.6e3, 0.0, 28e3, 508e3])


def test_it_vents_and_sucks_nothing(chain: Chain) -> None:
    low = ValveOffset(offset=-15e3, zero=Zero.SUPPRESSED)
    asked = np.array([-5e3, 0.0, 4e3, 10e3, 15e3, 20e3, 500e3])
    assert low.settled(asked, SPAN) == pytest.approx(
        [-5e3, 0.0, 0.0, 0.0, 0.0, 5e3, 485e3]
    )
    outlet = Outlet(chain.regulator, (low,))
    assert outlet.current(100e3) == pytest.approx(0.004 + 0.016 * 115 / 500)
    for vented in (outlet.current(0.0), *np.ravel(outlet.current(np.zeros(2)))):
        assert outlet.pressure(vented) == pytest.approx(0.0, abs=1e-3)


def test_it_vents_at_once_when_nothing_is_asked_though_the_pressure_lags(
    muscle: Muscle,
) -> None:
    effect = ValveOffset(offset=8e3, zero=Zero.SUPPRESSED)
    lagging = np.array([60e3, 40e3, 25e3])
    track = track_of(muscle, command=np.array([60e3, 0.0, 0.0]))
    found = effect.along(lagging, track, effect.rest())
    assert found == pytest.approx([68e3, 40e3, 25e3])


@pytest.mark.parametrize("offset", [8e3, -8e3])
def test_a_pilot_that_opens_by_and_by_brings_the_offset(
    muscle: Muscle, offset: float
) -> None:
    """By 63 % of it in the first 10 kPa, and never below what a vented muscle has."""
    effect = ValveOffset(offset, fade=10e3, zero=Zero.SUPPRESSED)
    asked = np.array([0.0, 10e3, 30e3, 400e3])
    found = effect.along(asked, track_of(muscle, command=asked), effect.rest())
    shift = offset * np.array([0.0, 1 - 1 / np.e, 1 - 1 / np.e**3, 1.0])
    assert found == pytest.approx(np.maximum(asked + shift, 0.0), abs=1e-6)
    assert effect.settled(asked, (0.0, 500e3)) == pytest.approx(found)


@pytest.mark.parametrize("fade", [0.0, 10e3])
def test_a_line_may_keep_part_of_it_where_nothing_is_asked(
    muscle: Muscle, fade: float
) -> None:
    effect = ValveOffset(20e3, fade=fade, kept=0.6, zero=Zero.SUPPRESSED)
    asked = np.array([0.0, 10e3, 400e3])
    found = effect.along(asked, track_of(muscle, command=asked), effect.rest())
    come = 1 - 1 / np.e if fade else 1.0
    assert found == pytest.approx([12e3, 10e3 + 12e3 + 8e3 * come, 420e3])
    assert effect.settled(asked, SPAN) == pytest.approx(found)


def _begins_softly(command: Array, offset: float) -> Array:
    """An offset that sets in over some percent of the range, as nothing is asked."""
    return np.asarray(command + offset * np.tanh(command / 15e3))


def _grows(command: Array, offset: float) -> Array:
    """An offset of which a third comes within the first tenth of the range."""
    return np.asarray(command + offset * (1 - 0.35 / (1 + (command / 20e3) ** 2)))


def _stays(command: Array, offset: float) -> Array:
    return command + offset


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_an_offset_is_named_where_a_vented_muscle_shows_none(seed: int) -> None:
    told = diagnose(stuck(_begins_softly, 15e3, seed), MODEL, {}, VALVES)
    assert told.verdict is Verdict.NAMED
    assert [one.name for one in told.named] == ["valve_offset"]
    (effect,) = told.explained.effects[-1:]
    assert isinstance(effect, ValveOffset)
    assert effect.zero is Zero.SUPPRESSED
    assert effect.offset == pytest.approx(15e3, abs=0.5e3)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_an_offset_that_grows_with_the_command_is_no_bow(seed: int) -> None:
    told = diagnose(stuck(_grows, 25e3, seed), MODEL, {}, VALVES)
    assert told.verdict is Verdict.NAMED
    assert [one.name for one in told.named] == ["valve_offset"]


def test_one_that_it_shows_is_regulated() -> None:
    told = diagnose(stuck(_stays, 15e3), MODEL, {}, VALVES)
    (effect,) = told.explained.effects[-1:]
    assert isinstance(effect, ValveOffset)
    assert effect.zero is Zero.REGULATED
