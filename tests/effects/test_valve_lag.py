"""A regulator that fills slowly."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from gripperd.effects.valve_lag import ValveLag
from gripperd.model import Muscle
from gripperd.model.track import Array
from tests.effects.tracks import track_of


def test_a_step_is_followed_to_63_percent_in_one_time_constant(muscle: Muscle) -> None:
    effect = ValveLag(share=1.0, time=0.5)
    asked = np.array([0.0, 100e3, 100e3])
    track = track_of(muscle, step=np.array([0.0, 0.5, 0.5]))
    found = effect.along(asked, track, effect.rest())
    assert found == pytest.approx(1e5 * (1 - np.exp([0.0, -1.0, -2.0])))


def test_emptying_takes_longer_by_the_ratio(muscle: Muscle) -> None:
    effect = ValveLag(share=1.0, time=0.5, exhaust=2.0)
    asked = np.array([100e3, 0.0])
    track = track_of(muscle, step=np.array([0.0, 1.0]))
    assert effect.along(asked, track, effect.rest())[1] == pytest.approx(1e5 / np.e)


def test_a_swing_is_followed_as_the_differential_equation_says(muscle: Muscle) -> None:
    time = np.arange(0.0, 6.0, 0.002)
    asked = 2e5 + 1e5 * np.sin(2 * time)
    effect = ValveLag(share=1.0, time=0.4, exhaust=1.5)
    track = track_of(muscle, time=time, step=np.diff(time, prepend=0.0))

    def slope(t: float, p: Array) -> Array:
        gap = 2e5 + 1e5 * np.sin(2 * t) - p
        return np.asarray(gap / np.where(gap > 0, 0.4, 0.6))

    exact = solve_ivp(slope, (0.0, 6.0), [2e5], t_eval=time, rtol=1e-8).y[0]
    found = effect.along(asked, track, effect.rest())
    # A command that is held for a step leads the true one by half of it, 1 ms.
    assert found == pytest.approx(exact, abs=2e5 * 0.0015)


@pytest.mark.parametrize("throttle", [0.3, 0.9, 0.99])
@pytest.mark.parametrize("choked", [0.0, 0.5, 1.0])
def test_a_throttled_valve_fills_as_the_differential_equation_says(
    muscle: Muscle, throttle: float, choked: float
) -> None:
    # Short steps far away, and one that covers nearly all of the way.
    time = np.cumsum([0.0, 1e-3, 0.01, 0.1, 1.0, 5.0, 10.0, 0.1, 0.1])
    asked = np.where(time > 0, 500e3, 0.0)
    effect = ValveLag(share=1.0, time=0.5, throttle=throttle, choked=choked)
    track = track_of(muscle, time=time, step=np.diff(time, prepend=0.0))

    def slope(_t: float, p: Array) -> Array:
        far = np.abs(500e3 - p) / 100e3
        throttled = choked * far + (1 - choked) * np.sqrt(far)
        return np.asarray((500e3 - p) / 0.5 / (1 - throttle + throttle * throttled))

    ends = (0.0, float(time[-1]))
    exact = solve_ivp(slope, ends, [0.0], t_eval=time, rtol=1e-10, atol=1e-3).y[0]
    found = effect.along(asked, track, effect.rest())
    assert found == pytest.approx(exact, abs=1.0)


def test_a_choked_valve_empties_at_its_rate(muscle: Muscle) -> None:
    effect = ValveLag(share=1.0, time=4.0, exhaust=2.0, throttle=0.99, choked=1.0)
    time = np.linspace(0.0, 1.0, 11)
    asked = np.where(time > 0, 0.0, 300e3)
    track = track_of(muscle, time=time, step=np.diff(time, prepend=0.0))
    found = effect.along(asked, track, effect.rest())
    # 100 kPa in 8 s are 12.5 kPa/s, near that while the distance is long.
    assert np.diff(found) / 0.1 == pytest.approx(-12.5e3, rel=0.01)


def test_an_orifice_empties_as_the_square_root_of_the_distance(muscle: Muscle) -> None:
    effect = ValveLag(share=1.0, time=0.5, throttle=0.99, choked=0.0)
    time = np.linspace(0.0, 1.0, 11)
    asked = np.where(time > 0, 0.0, 400e3)
    track = track_of(muscle, time=time, step=np.diff(time, prepend=0.0))
    found = effect.along(asked, track, effect.rest())
    # Torricelli: the root falls at a constant rate, here from 2 by 1 in a second.
    assert np.sqrt(found / 1e5)[:-1] == pytest.approx(2 - time[:-1], abs=0.02)


def test_nothing_follows_before_the_dead_time_is_over(muscle: Muscle) -> None:
    effect = ValveLag(share=1.0, time=0.5, dead_time=0.2)
    time = np.arange(0.0, 4.0, 0.005)
    asked = np.where(time > 0, 100e3, 0.0)
    track = track_of(muscle, time=time, step=np.diff(time, prepend=0.0))
    found = effect.along(asked, track, effect.rest())
    # The delay theorem: the answer of the lag, shifted.
    exact = 1e5 * -np.expm1(-np.maximum(time - 0.2, 0.0) / 0.5)
    assert found == pytest.approx(exact, abs=1100.0)
    assert np.all(found[time < 0.2] == 0.0)


@pytest.mark.parametrize("dead_time", [0.0, 0.15])
def test_sample_by_sample_it_is_the_same(muscle: Muscle, dead_time: float) -> None:
    effect = ValveLag(share=0.9, time=0.3, exhaust=2.0, dead_time=dead_time)
    asked = np.array([0.0, 1e5, 2e5, 2e5, 0.5e5, 0.5e5])
    step = np.array([0.0, 0.1, 0.2, 0.1, 0.3, 0.1])
    time = np.cumsum(step)
    track = track_of(muscle, time=time, step=step)
    whole = effect.along(asked, track, effect.rest())
    memory = effect.rest()
    for index, found in enumerate(whole.tolist()):
        one = slice(index, index + 1)
        track = track_of(muscle, time=time[one], step=step[one])
        assert effect.along(asked[one], track, memory)[0] == pytest.approx(found)


def test_a_steady_pressure_has_arrived() -> None:
    assert ValveLag(share=1.0).settled(200e3, (0.0, 500e3)) == 200e3


def test_what_exhausts_goes_with_the_pressure_that_is_left(muscle: Muscle) -> None:
    """Choked above 2.4 bar, by ISO 6358 with b = 0.3: in proportion to it."""
    effect = ValveLag(share=1.0, time=2.0, exhaust=3.0, sonic=1.0)
    for pressure in (500e3, 300e3, 240e3):
        asked = np.array([pressure, pressure - 1e3])
        track = track_of(muscle, step=np.array([0.0, 0.06]))
        found = effect.along(asked, track, effect.rest())
        passed = 0.06 / 6.0 * (pressure + 101325) / (300e3 + 101325)
        assert found[0] - found[1] == pytest.approx(-1e3 * np.expm1(-passed), rel=0.01)
