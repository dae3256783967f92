from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.fit.polish import polished
from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.residuals.holdout import split
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.setup import problem_of
from gripperd.diagnose.verdict.gap import (
    DRIFTS,
    Gap,
    _interval,
    beside_drift,
    by_signal,
    gaps,
)
from gripperd.effects.force_sensor_bias import ForceSensorBias
from gripperd.model.effect import Signal
from tests.diagnose.small import (
    LINKAGE,
    MODEL,
    altered,
    moments,
    nothing,
    recording,
    undoubted,
    with_grip,
)

NOISES = {Signal.FORCE: Noise(3.0, 0.0, drift=4.0), Signal.PRESSURE: Noise(1e3, 0.0)}


def _gap(recalibrated: float, after: float, floor: float = 3.0) -> Gap:
    return Gap(Signal.FORCE, 30.0, recalibrated, after, floor, (after, after))


@pytest.fixture(scope="module")
def judged(blank: Problem) -> tuple[Problem, dict[Signal, Gap]]:
    start = Point(np.zeros(len(blank.constants)))
    points = tuple(
        start.with_effect(ForceSensorBias(bias=b)) for b in (40.0, 20.0, 0.0)
    )
    test = replace(split(undoubted(blank)).test, noises=NOISES)
    one, other, last = points
    return test, gaps(test, (one, other, last), np.random.default_rng(0))


@pytest.mark.parametrize(
    ("gap", "share"),
    [
        pytest.param(_gap(5.0, 3.0), 1.0, id="down to the noise"),
        pytest.param(_gap(5.0, 5.0), 0.0, id="nothing"),
        pytest.param(_gap(5.0, 17**0.5), 0.5, id="half of the mean square"),
        pytest.param(_gap(5.0, 41**0.5), -1.0, id="worse"),
        pytest.param(_gap(2.0, 1.0), 0.0, id="no gap to close"),
    ],
)
def test_the_share_closed_is_of_the_mean_square_above_the_noise(
    gap: Gap, share: float
) -> None:
    assert gap.closed == pytest.approx(share)


@pytest.mark.parametrize(
    ("gap", "confirms"),
    [
        pytest.param(_gap(9.0, 3.0), True, id="down to the noise"),
        pytest.param(_gap(3.2, 3.2), True, id="there was nothing to close"),
        pytest.param(_gap(3.2, 3.3), False, id="worse than constants alone"),
        pytest.param(_gap(2.8, 3.0), True, id="worse, but within the noise"),
        pytest.param(_gap(9.0, 6.0), True, id="five eighths of the mean square"),
        pytest.param(_gap(9.0, 8.0), False, id="a quarter of the mean square"),
        pytest.param(
            _gap(4.1, 3.85), False, id="near the noise, but by a third hardly"
        ),
        pytest.param(_gap(4.1, 3.6), True, id="near the noise, and by half of it"),
    ],
)
def test_effects_are_confirmed_by_what_they_close_of_a_gap(
    gap: Gap, *, confirms: bool
) -> None:
    assert gap.confirms(1) is confirms
    assert gap.confirms(2) is confirms


@pytest.mark.parametrize(
    ("after", "low", "confirms"),
    [(3.4, 3.1, True), (3.4, 3.3, False), (4.2, 3.1, False)],
)
def test_what_is_worse_by_chance_where_little_was_left_says_nothing(
    after: float, low: float, *, confirms: bool
) -> None:
    # 3.2 N were left of a noise of 3 N, and 3.9 N is as far as noise may go.
    gap = replace(_gap(3.2, after), ci95_after=(low, 2 * after - low))
    assert gap.confirms(1) is confirms


@pytest.mark.parametrize(("recalibrated", "is_open"), [(3.8, False), (4.0, True)])
def test_a_gap_is_open_from_thirteen_tenths_of_the_noise(
    recalibrated: float, *, is_open: bool
) -> None:
    assert _gap(recalibrated, 3.0).is_open is is_open


def test_the_gap_is_the_root_mean_square_of_what_was_left_out(
    judged: tuple[Problem, dict[Signal, Gap]],
) -> None:
    test, found = judged
    start = Point(np.zeros(len(test.constants)))
    left = by_signal(test, start)[Signal.FORCE]
    force = found[Signal.FORCE]
    assert force.after == pytest.approx(float(np.sqrt(np.mean(left**2))))
    assert force.recalibrated == pytest.approx(np.sqrt(np.mean((left - 20) ** 2)))
    assert force.before == pytest.approx(np.sqrt(np.mean((left - 40) ** 2)))


def test_each_signal_is_judged_by_itself(
    judged: tuple[Problem, dict[Signal, Gap]],
) -> None:
    _, found = judged
    pressure = found[Signal.PRESSURE]
    assert pressure.before == pressure.after
    assert set(found) == {Signal.FORCE, Signal.PRESSURE}


def test_the_floor_is_the_repeatability_with_the_drift(
    judged: tuple[Problem, dict[Signal, Gap]],
) -> None:
    assert judged[1][Signal.FORCE].noise_floor == pytest.approx(5.0)


def test_the_interval_holds_the_gap_and_is_no_point(
    judged: tuple[Problem, dict[Signal, Gap]],
) -> None:
    for gap in judged[1].values():
        low, high = gap.ci95_after
        assert low < gap.after < high


def test_the_interval_is_about_as_wide_as_chi_square_says(blank: Problem) -> None:
    known = Point(np.zeros(len(blank.constants)))
    plain = replace(blank, constants=())
    found = gaps(plain, (Point(np.zeros(0)),) * 3, np.random.default_rng(1))[
        Signal.PRESSURE
    ]
    samples = by_signal(blank, known)[Signal.PRESSURE].size
    low, high = found.ci95_after
    # The standard deviation of a root mean square of n normal samples is s / root 2n.
    wide = 2 * 1.96 * found.after / (2 * samples) ** 0.5
    assert high - low == pytest.approx(wide, rel=0.5)


def test_the_same_draws_give_the_same_interval(blank: Problem) -> None:
    start = Point(np.zeros(len(blank.constants)))
    one, other = (gaps(blank, (start,) * 3, np.random.default_rng(5)) for _ in range(2))
    assert one == other


def test_residuals_of_a_signal_come_in_the_order_of_time(blank: Problem) -> None:
    start = Point(np.zeros(len(blank.constants)))
    times = np.concatenate(
        [
            time
            for block, time in zip(blank.blocks, blank.times, strict=True)
            if block.signal is Signal.FORCE
        ]
    )
    assert (np.diff(times) > 0).all()
    assert by_signal(blank, start)[Signal.FORCE].size == times.size


@pytest.mark.parametrize(
    ("after", "confirms"), [(3.3, True), (4.2, True), (5.0, False)]
)
def test_a_crowd_of_effects_must_close_a_gap_closely(
    after: float, *, confirms: bool
) -> None:
    # 85 % of 81 - 9 above the noise leaves a mean square of 19.8, that is 4.45 squared.
    gap = _gap(9.0, after)
    assert gap.confirms(3) is confirms
    assert gap.confirms(2)


@pytest.mark.parametrize(
    ("after", "confirms"), [(3.8, True), (4.4, True), (4.5, False), (6.0, False)]
)
def test_what_has_no_form_to_be_wrong_leaves_noise_or_little_of_the_gap(
    after: float, *, confirms: bool
) -> None:
    gap = _gap(9.0, after)
    assert gap.confirms(1, exact=True) is confirms
    assert gap.confirms(1)


@pytest.mark.parametrize(
    ("recalibrated", "after", "confirms"),
    [(3.2, 3.25, True), (3.6, 3.5, True), (3.6, 3.65, False)],
)
def test_a_name_closes_some_of_what_there_is_to_close(
    recalibrated: float, after: float, *, confirms: bool
) -> None:
    # Of a noise of 3 N, known to a tenth, 3.2 N are nothing to close and 3.6 N are.
    gap = replace(_gap(recalibrated, after), ci95_after=(3.0, 4.0))
    assert gap.confirms(1) is confirms


@pytest.mark.parametrize(("after", "confirms"), [(9.5, True), (12.0, False)])
def test_a_signal_that_sleeps_in_a_band_must_only_not_leave_it(
    after: float, *, confirms: bool
) -> None:
    """Beside a floor of 3 N nobody foretells 8 N: 8.5 N in all can be reached."""
    gap = replace(_gap(9.0, after), in_band=8.0)
    assert gap.reachable == pytest.approx(73**0.5)
    assert not gap.is_open
    assert gap.confirms(1) is confirms
    assert not replace(gap, in_band=0.0).confirms(1)


@pytest.mark.parametrize(
    ("recalibrated", "low", "spoilt"),
    [(2.5, 3.8, False), (2.5, 4.0, True), (9.0, 11.0, False), (9.0, 12.0, True)],
)
def test_a_signal_far_beyond_noise_and_constants_is_spoilt(
    recalibrated: float, low: float, *, spoilt: bool
) -> None:
    # 1.3 times a noise of 3 N is 3.9 N, and of 9 N that were left before 11.7 N.
    gap = replace(_gap(recalibrated, low + 1.0), ci95_after=(low, low + 2.0))
    assert gap.is_spoilt is spoilt


def test_few_samples_have_an_interval_as_well() -> None:
    residual = np.random.default_rng(0).normal(0.0, 3.0, 30)
    low, high = _interval(residual, np.random.default_rng(1))
    rms = float(np.mean(residual**2) ** 0.5)
    # 95 % of the root mean square of 30 normal numbers, by chi squared: 26 % each way.
    assert 0.6 * rms < low < 0.9 * rms
    assert 1.1 * rms < high < 1.4 * rms


def test_a_grip_is_off_by_the_drift_of_both_cells() -> None:
    """It is foretold from a force, which may have drifted by as much of its own."""
    model = replace(MODEL, linkage=LINKAGE)
    plain = problem_of(with_grip(recording(nothing)), model, {})
    point = Point(np.zeros(len(plain.constants)))
    told = altered(
        with_grip(recording(nothing)), moments(), "grip", lambda grip: grip + 2.5
    )
    off = problem_of(told, model, {})
    assert DRIFTS * plain.full_scale[Signal.GRIP] < 2.5
    before, after = (beside_drift(one, point)[Signal.GRIP] for one in (plain, off))
    assert after < 1.1 * before


def test_a_length_that_is_read_badly_is_no_gap_of_the_model() -> None:
    """A prediction knows the way of the length better than each reading of it."""
    rng = np.random.default_rng(23)
    loud = altered(
        recording(nothing), moments(), "contraction",
        lambda way: way + rng.normal(0.0, 2e-3, way.size),
    )  # fmt: skip
    problem = problem_of(loud, MODEL, {})
    point = polished(problem, Point(np.zeros(len(problem.constants)))).point
    judged = by_signal(problem, point)[Signal.FORCE]
    fitted = np.concatenate([
        residual
        for block, residual in zip(
            problem.blocks, problem.residuals(point), strict=True
        )
        if block.signal is Signal.FORCE
    ])  # fmt: skip
    rms, read = (float(np.sqrt(np.mean(one**2))) for one in (judged, fitted))
    assert rms < 0.9 * read
    assert rms == pytest.approx(problem.floor(Signal.FORCE), rel=0.15)
