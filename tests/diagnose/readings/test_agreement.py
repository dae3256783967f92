from collections.abc import Iterable

import numpy as np
import pytest

from gripperd.diagnose.readings.agreement import beyond_use
from gripperd.diagnose.readings.believed import believed
from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.diagnose.readings.repeats import contradictions
from tests.diagnose.small import altered, recording, rubbing, threshold, without
from tests.diagnose.sweep import noise, pulled, run, triangle

HALF = ("a", "c", "e", "b2")
LBF = 0.2248


def _scaled(names: Iterable[str], factor: float) -> Recording:
    return altered(recording(), names, "force", lambda force: factor * force)


def _isometric(*sweeps: tuple[float, float]) -> Recording:
    """Sweeps at a contraction, with a gain."""
    runs = tuple(
        pulled(f"{place}", contraction=contraction, gain=gain, seed=7 * place)
        for place, (contraction, gain) in enumerate(sweeps)
    )
    return Recording("bench", "0" * 64, runs, contradictions=contradictions(runs))


@pytest.mark.parametrize("factor", [LBF, 0.5, 1e-3, 4.4])
def test_half_of_the_sweeps_in_another_unit_are_beyond_use(factor: float) -> None:
    (found,) = beyond_use(_scaled(HALF, factor))
    assert HALF in (found.runs, found.others)
    assert (found.column, found.unit) == ("force_N", "N")


def test_it_says_by_how_much_they_disagree_and_repeat() -> None:
    sweeps = [(0.1, 1.0), (0.1, 2.0)] * 3
    (found,) = beyond_use(_isometric(*sweeps))
    assert (found.runs, found.others) == (("0", "2", "4"), ("1", "3", "5"))
    # 2 N/kPa against 4 N/kPa over 50 to 500 kPa: 608 N root mean square.
    assert found.difference == pytest.approx(-608.0, rel=0.05)
    assert found.spread < 10.0


@pytest.mark.parametrize(
    "plain",
    [
        pytest.param(recording(), id="nothing"),
        pytest.param(recording(threshold(60.0)), id="a large threshold"),
        pytest.param(recording(rubbing(80.0)), id="strong friction"),
        pytest.param(_scaled(HALF, 0.75), id="a quarter less"),
        pytest.param(_scaled(["c"], LBF), id="one sweep that is off"),
        pytest.param(recording(noise=5.0), id="noise"),
    ],
)
def test_what_physics_can_do_is_not_beyond_use(plain: Recording) -> None:
    assert beyond_use(plain) == ()


def test_wear_without_a_jump_is_not_beyond_use() -> None:
    worn = _isometric(*((0.1, 0.85**cycle) for cycle in range(8)))
    assert beyond_use(worn) == ()


def test_a_mount_that_slipped_at_one_length_of_three_is_left_out_instead() -> None:
    slipped = [(0.1, 1.0), (0.1, 0.5)] * 3
    others = [(length, 1.0) for length in (0.0, 0.2) for _ in range(6)]
    told = _isometric(*slipped, *others)
    assert beyond_use(told) == ()
    assert len(believed(told).runs) == len(told.runs) - 3


def test_too_little_left_without_the_weaker_repeats_is_beyond_use() -> None:
    # The weaker are more: three strong runs would have to stand for eight.
    told = _isometric(*[(0.1, gain) for gain in (1.0, 0.7, 0.7, 0.7) * 2])
    assert told.contradictions
    assert beyond_use(told) == told.contradictions


def test_sweeps_that_share_no_place_cannot_disagree() -> None:
    apart = _isometric((0.0, 1.0), (0.05, 0.4), (0.1, 1.0), (0.15, 0.4))
    assert beyond_use(apart) == ()


def _lifting(weight: float) -> Run:
    """A muscle that inflates and deflates under a weight, and sticks when it turns."""
    pressure = triangle(low=100e3)
    rubbing = 20.0 * np.sign(np.linspace(-1.0, 1.0, pressure.size))
    # 2 N/kPa at rest, and nothing left of it at a contraction of 0.25.
    contraction = 0.25 * (1 - (weight - rubbing) / (2e-3 * pressure))
    return run(
        f"{weight:.0f} N",
        pressure=pressure + noise(pressure.size, 1.5e3, 1),
        contraction=contraction + noise(pressure.size, 1e-3, 2),
        force=weight + noise(pressure.size, 4.0, int(weight)),
    )


def test_weights_of_different_size_meet_at_the_rim_of_a_place_and_agree() -> None:
    runs = tuple(_lifting(weight) for weight in (90.0, 92.0, 148.0, 150.0))
    told = Recording("bench", "0" * 64, runs)
    assert beyond_use(told) == ()
    # The same muscle through another gain: no surface holds both.
    assert beyond_use(altered(told, ["148 N", "150 N"], "force", lambda f: 3 * f))


@pytest.mark.parametrize("further", [0.0, 1e-4, 1e-3])
def test_another_muscle_contradicts_though_its_mount_is_off(further: float) -> None:
    sweeps = [
        (length + further * (gain > 1), gain)
        for length in (0.05, 0.1)
        for gain in (1.0, 1.0, 1.0, 2.0, 2.0, 2.0)
    ]
    assert beyond_use(_isometric(*sweeps))


def test_a_recording_without_force_is_not_judged_by_it() -> None:
    assert beyond_use(without(recording(), "force")) == ()


def test_how_far_repeats_differ_is_that_of_sweeps_at_one_place() -> None:
    # Two of a camp at 0.1, 20 N apart; the others are alone where they went.
    one = pulled("one", contraction=0.1, seed=1)
    other = altered(
        Recording("r", "0" * 64, (pulled("other", contraction=0.1, seed=2),)),
        ["other"],
        "force",
        lambda force: force + 20.0,
    ).runs
    twice = [pulled(f"{i}", contraction=0.1, gain=2.0, seed=3 + i) for i in range(2)]
    (found,) = beyond_use(Recording("bench", "0" * 64, (one, *other, *twice)))
    # Of 20 N and 0 N between two, root mean square of 14 N and 0 N.
    assert found.spread == pytest.approx(10.0, rel=0.1)
