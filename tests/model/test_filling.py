"""A volume that is filled and emptied through a throttle."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from gripperd.model.filling import Filling, filled
from gripperd.model.memory import begin
from gripperd.model.track import Array

TIME = np.arange(0.0, 6.0, 0.1)
STEP = np.diff(TIME, prepend=0.0)
ATMOSPHERE = 101325.0


def emptied(time: Array, law: Filling, start: float, goal: float) -> Array:
    """From a pressure to another, read at these times."""
    state = np.array([start])
    return filled(np.full(time.size, goal), np.diff(time, prepend=0.0), law, state)


def outflow(pressure: float) -> float:
    """Of an orifice with b = 0.3, as ISO 6358 has it, over that at 300 kPa."""
    absolute = pressure + ATMOSPHERE
    ratio = ATMOSPHERE / absolute
    subsonic = np.sqrt(1 - ((ratio - 0.3) / 0.7) ** 2) if ratio > 0.3 else 1.0
    return float(absolute * subsonic / (300e3 + ATMOSPHERE))


@pytest.mark.parametrize("step", [0.002, 0.05, 0.5])
@pytest.mark.parametrize("share", [0.5, 1.0])
@pytest.mark.parametrize("choke", [0.0, 2e-5])
def test_it_exhausts_as_the_differential_equation_says(
    step: float, share: float, choke: float
) -> None:
    """Also where one sample is several time constants after the other."""
    time = np.linspace(step, 2.0, round(2.0 / step))
    law = Filling(0.1, 0.2, choke=choke, sonic=share)

    def slope(_t: float, p: Array) -> Array:
        away = p - 20e3
        pace = 1 - share + share * outflow(float(p[0]))
        return np.asarray(-away / 0.2 * pace / (1 + choke * away))

    exact = solve_ivp(slope, (0.0, 2.0), [500e3], t_eval=time, rtol=1e-9, atol=1e-3).y[
        0
    ]
    found = emptied(time, law, 500e3, 20e3)
    assert found == pytest.approx(exact, abs=0.002 * 480e3)


def test_it_fills_as_fast_whatever_is_in_it() -> None:
    found = emptied(TIME, Filling(2.0, 9.0, sonic=1.0), 0.0, 400e3)
    assert found == pytest.approx(400e3 * -np.expm1(-TIME / 2.0))


def test_nothing_goes_out_of_what_has_no_more_than_the_air_around_it() -> None:
    """Beneath the atmosphere a muscle exhausts nothing: it has no pump."""
    found = emptied(TIME, Filling(0.1, 0.1, sonic=1.0), 100e3, -5e3)
    assert found[-1] == pytest.approx(0.0, abs=50.0)
    assert (found >= -1e-9).all()


def test_given_sample_by_sample_it_is_the_same() -> None:
    told = 2e5 * (1 + np.sin(2 * TIME))
    law = Filling(0.3, 0.5, orifice=1e-3, choke=1e-5, sonic=0.7)
    whole = filled(told, STEP, law, begin())
    state = begin()
    pieces = [
        filled(told[i : i + 1], STEP[i : i + 1], law, state) for i in range(TIME.size)
    ]
    np.testing.assert_array_equal(np.concatenate(pieces), whole)


def test_it_goes_on_where_a_sample_is_missing() -> None:
    told = np.where(TIME > 0, 5.0, 0.0)
    law = Filling(2.0, 2.0, orifice=0.5, choke=1.0)
    missing = np.where((TIME > 1.95) & (TIME < 2.25), np.nan, told)
    whole, found = (filled(one, STEP, law, begin()) for one in (told, missing))
    assert found == pytest.approx(whole)
