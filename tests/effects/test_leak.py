"""Air lost between regulator and muscle."""

from math import exp

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from gripperd.effects.leak import Leak
from gripperd.model import Muscle
from gripperd.model.track import Array
from tests.effects.tracks import track_of


def _left(effect: Leak, muscle: Muscle, pressure: list[float], **moved: Array) -> Array:
    track = track_of(muscle, **({"waiting": moved["still"]} | moved))
    return effect.along(np.array(pressure), track, effect.rest())


def test_a_shut_line_decays_with_its_rate(muscle: Muscle) -> None:
    still = np.array([0.0, 66.0, 132.0])
    step = np.array([0.0, 66.0, 66.0])
    found = _left(Leak(rate=1 / 66), muscle, 3 * [300e3], still=still, step=step)
    assert found == pytest.approx([300e3, 300e3 / exp(1), 300e3 / exp(2)])


@pytest.mark.parametrize(
    ("refill", "kept"), [(0.02, 0.0), (0.1, exp(-1)), (10.0, 0.99)]
)
def test_what_was_lost_is_filled_up_as_fast_as_the_regulator_fills(
    muscle: Muscle, refill: float, kept: float
) -> None:
    # Half a minute at 400 kPa, then told 450 kPa within a tenth of a second.
    still, step = np.array([0.0, 30.0, 0.0]), np.array([0.0, 30.0, 0.1])
    effect = Leak(rate=1e-3, refill=refill)
    found = _left(effect, muscle, [400e3, 400e3, 450e3], still=still, step=step)
    lost = 400e3 * (1 - exp(-0.03))
    assert found[1] == pytest.approx(400e3 - lost)
    assert found[2] == pytest.approx(450e3 - kept * lost, abs=100.0)


@pytest.mark.parametrize(
    ("told", "lacks"),
    [(200e3, 0.0), (400e3 * exp(-0.03), 0.0), (395e3, 400e3 * (1 - exp(-0.03)) - 5e3)],
    ids=["far down", "where it is", "above where it is"],
)
def test_what_is_left_is_let_out_to_a_command_that_falls(
    muscle: Muscle, told: float, lacks: float
) -> None:
    still, step = np.array([0.0, 30.0, 0.0]), np.array([0.0, 30.0, 0.1])
    effect = Leak(rate=1e-3, refill=1e4)
    found = _left(effect, muscle, [400e3, 400e3, told], still=still, step=step)
    assert found[2] == pytest.approx(told - lacks, abs=10.0)


@pytest.mark.parametrize("read", [0.0, 300.0])
def test_noise_of_a_command_that_rises_fills_nothing_up(
    muscle: Muscle, read: float
) -> None:
    """Of 12 kPa lost 12 are missing after a rise, whatever the current is read with."""
    asked = np.r_[400e3, 400e3, np.linspace(400e3, 480e3, 200)]
    asked[2:] += read * np.where(np.arange(200) % 2, 1.0, -1.0)
    still, step = np.zeros(202), np.full(202, 0.1)
    still[1] = step[1] = 30.0
    effect = Leak(rate=1e-3, refill=1e9)
    found = _left(effect, muscle, asked.tolist(), still=still, step=step)
    lost = 400e3 * (1 - exp(-0.03))
    assert (asked - found)[-1] == pytest.approx(lost, abs=read + 1.0)


def test_a_command_may_come_piece_by_piece(muscle: Muscle) -> None:
    asked = np.array([400e3, 400e3, 395e3, 392e3, 450e3, 450e3, 300e3])
    still = np.array([0.0, 30.0, 0.0, 0.0, 0.0, 20.0, 0.0])
    step = np.array([0.0, 30.0, 0.1, 0.1, 0.1, 20.0, 0.1])
    effect = Leak(rate=1e-3, refill=1.0)
    whole = _left(effect, muscle, asked.tolist(), still=still, step=step)
    memory, pieces = effect.rest(), []
    for one in range(7):
        track = track_of(muscle, **{
            "waiting": still[one : one + 1], "still": still[one : one + 1],
            "step": step[one : one + 1],
        })  # fmt: skip
        pieces.append(effect.along(asked[one : one + 1], track, memory)[0])
    assert pieces == pytest.approx(whole.tolist())


def test_what_a_regulator_keeps_is_not_lost(muscle: Muscle) -> None:
    still, waiting = np.array([0.0, 30.0, 60.0]), np.array([0.0, 30.0, 0.0])
    step = np.array([0.0, 30.0, 30.0])
    effect = Leak(rate=1e-3)
    moved = {"still": still, "waiting": waiting, "step": step}
    found = _left(effect, muscle, 3 * [400e3], **moved)
    # But for what it loses in the 50 ms in which it fills up.
    kept = 400e3 * (1 - 1e-3 * 0.05)
    assert found == pytest.approx([400e3, 400e3 * exp(-0.03), kept], abs=1.0)


def test_no_more_is_lost_than_there_is(muscle: Muscle) -> None:
    still, step = np.array([0.0, 100.0, 0.0]), np.array([0.0, 100.0, 0.1])
    effect = Leak(rate=0.1, refill=30.0)
    found = _left(effect, muscle, [400e3, 400e3, 0.0], still=still, step=step)
    assert found[2] == 0.0


def test_a_regulator_that_feeds_the_leak_droops_by_the_share(muscle: Muscle) -> None:
    effect = Leak(early=0.05)
    still = np.array([0.0, 10.0, 1000.0])
    found = effect.along(
        np.full(3, 100e3), track_of(muscle, still=still), effect.rest()
    )
    assert found == pytest.approx([100e3, 100e3 - 5e3 * (1 - exp(-1)), 95e3])


@pytest.mark.parametrize("exponent", [-0.5, 0.0, 1.0])
def test_a_slow_regulator_feeds_a_leak_that_goes_on(
    muscle: Muscle, exponent: float
) -> None:
    """It never shuts: what is lost is made up for with a time constant of 20 s."""
    step = np.full(600, 0.1)
    step[0] = 0.0
    effect = Leak(rate=2e-3, exponent=exponent, refill=20.0)
    found = _left(effect, muscle, 600 * [450e3], still=0.0 * step, step=step)

    def gained(_: float, lost: Array) -> Array:
        left = 450e3 - lost
        return np.asarray(2e-3 * left * (left / 300e3) ** exponent - lost / 20.0)

    told = solve_ivp(gained, (0.0, 60.0), [0.0], t_eval=np.cumsum(step), rtol=1e-9)
    assert found == pytest.approx(450e3 - told.y[0], abs=20.0)
    assert found[-1] < 440e3


def test_a_vented_line_has_nothing_to_lose(muscle: Muscle) -> None:
    effect = Leak(rate=0.01, early=0.1)
    still = np.array([0.0, 100.0])
    track = track_of(muscle, still=still, waiting=still)
    assert effect.along(np.zeros(2), track, effect.rest()).tolist() == [0.0, 0.0]


@pytest.mark.parametrize(
    ("exponent", "left"),
    [
        # A hole: the root of the pressure falls evenly, to nothing after 2 / k.
        pytest.param(-0.5, [(1 - 0.25) ** 2, (1 - 0.5) ** 2, 0.0, 0.0], id="orifice"),
        pytest.param(0.0, [exp(-0.5), exp(-1), exp(-2.5), exp(-4)], id="choked"),
        # A gap: one over the pressure grows evenly.
        pytest.param(1.0, [1 / 1.5, 1 / 2, 1 / 3.5, 1 / 5], id="gap"),
    ],
)
def test_a_hole_a_choke_and_a_gap_empty_a_shut_line_each_in_its_way(
    muscle: Muscle, exponent: float, left: list[float]
) -> None:
    still = np.array([0.0, 50.0, 100.0, 250.0, 400.0])
    step = np.diff(still, prepend=0.0)
    effect = Leak(rate=0.01, exponent=exponent)
    found = _left(effect, muscle, 5 * [300e3], still=still, step=step)
    assert found / 300e3 == pytest.approx([1.0, *left])


@pytest.mark.parametrize("exponent", [-0.5, -0.2, 0.0, 0.6, 1.0])
def test_it_lasts_until_the_pressure_has_fallen_as_told(
    muscle: Muscle, exponent: float
) -> None:
    effect = Leak(rate=0.01, exponent=exponent)
    lasts = effect.lasts(450e3, 0.7)
    still, step = np.array([0.0, lasts]), np.array([0.0, lasts])
    found = _left(effect, muscle, 2 * [450e3], still=still, step=step)
    assert found[1] == pytest.approx(450e3 * exp(-0.7))


def test_a_regulator_droops_at_once_by_what_it_feeds(muscle: Muscle) -> None:
    # 1 % a second over 3 s at 300 kPa, and as the square of the pressure.
    effect = Leak(rate=0.01, exponent=1.0, droop=3.0, refill=1e-9)
    pressures = [0.0, 150e3, 300e3, 600e3]
    still = np.zeros(4)
    found = _left(effect, muscle, pressures, still=still)
    fed = 0.03 * np.array(pressures) ** 2 / 300e3
    assert found == pytest.approx(np.array(pressures) - fed)
    assert effect.settled(300e3, (0.0, 500e3)) == pytest.approx(291e3)


def test_below_nothing_there_is_nothing_to_lose() -> None:
    assert Leak(rate=0.01, droop=3.0).settled(-5e3, (0.0, 500e3)) == -5e3


def test_a_prediction_is_of_the_moment_before_it_leaks() -> None:
    assert Leak(rate=0.01).settled(200e3, (0.0, 500e3)) == 200e3
