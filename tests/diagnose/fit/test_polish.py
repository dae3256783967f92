from collections.abc import Sequence
from dataclasses import fields, replace
from functools import partial
from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import Bounds, minimize
from scipy.signal import lfilter

from gripperd.diagnose.fit.polish import (
    SIZE_STEPS,
    Coordinate,
    Polished,
    bounds,
    polished,
    slopes,
)
from gripperd.diagnose.readings.recording import Recording
from gripperd.diagnose.residuals.constants import MADE, NUISANCE
from gripperd.diagnose.residuals.explanation import Explanation
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.residuals.response import Base
from gripperd.diagnose.residuals.runs import Runs
from gripperd.diagnose.residuals.stages import predicted
from gripperd.diagnose.residuals.track import track_of
from gripperd.diagnose.setup import problem_of
from gripperd.effects.channel_delay import ChannelDelay
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.creep import Creep
from gripperd.effects.force_sensor_bias import ForceSensorBias
from gripperd.effects.nonlinear_elasticity import NonlinearElasticity
from gripperd.effects.presliding_hysteresis import PreslidingHysteresis
from gripperd.effects.series_compliance import SeriesCompliance
from gripperd.effects.threshold_pressure import ThresholdPressure
from gripperd.effects.valve_lag import ValveLag
from gripperd.model.effect import Effect, Signal
from gripperd.model.preisach import Hysteron
from gripperd.model.track import Array
from tests.diagnose.small import (
    MODEL,
    STEP,
    Hidden,
    Moment,
    altered,
    moments,
    nothing,
    pinned,
    recording,
    rubbing,
    threshold,
    without,
)


def _off(**built: float) -> Explanation:
    """The model of a rig whose muscle was built otherwise."""
    return replace(MODEL, muscle=replace(MODEL.muscle, **built))


def _problem(model: Explanation = MODEL) -> Problem:
    return problem_of(recording(), model, {})


def _start(problem: Problem, *effects: Effect) -> Point:
    return Point(np.zeros(len(problem.constants)), effects)


def _value(found: Polished, problem: Problem, path: str) -> tuple[float, float]:
    """Fitted constant and its standard deviation."""
    index = [one.path for one in problem.constants].index(path)
    constant = problem.constants[index]
    shift = float(found.point.shifts[index])
    std = constant.sigma * float(found.covariance[index, index]) ** 0.5
    return constant.nominal + shift * constant.sigma, std


def test_a_wrong_diameter_is_found_within_its_standard_deviation() -> None:
    problem = _problem(_off(diameter=0.0203))
    problem = pinned(problem, "muscle.diameter")
    found = polished(problem, _start(problem))
    value, std = _value(found, problem, "muscle.diameter")
    assert std < 5e-5
    assert abs(value - 0.020) < 4 * std


@pytest.mark.parametrize("diameter", [0.023, 0.017])
def test_no_constant_moves_beyond_its_tolerance(diameter: float) -> None:
    problem = _problem(_off(diameter=diameter))
    found = polished(problem, _start(problem))
    shifts = dict(zip(problem.constants, np.abs(found.point.shifts), strict=True))
    made = [s for c, s in shifts.items() if c.reach == MADE]
    assert max(made) == pytest.approx(MADE)
    assert all(s <= c.reach * (1 + 1e-9) for c, s in shifts.items())
    assert max(shifts.values()) <= NUISANCE * (1 + 1e-9)


def test_the_sign_of_friction_at_rest_is_no_larger_than_one() -> None:
    problem = problem_of(recording(lambda m: 40.0 + 0 * m.time), MODEL, {})
    found = polished(problem, _start(problem))
    signs = problem.explanation(found.point).rests
    assert max(abs(sign) for sign in signs.values()) <= 1.0 + 1e-9


def test_a_regulator_that_follows_at_once_has_no_response_time_left() -> None:
    # Below none nothing changes any more, and no slope would lead back: here pressures
    # are even ahead, as where clocks differ.
    plain = _problem()
    problem = replace(plain)
    problem.__dict__["measured"] = [
        value + 5e-3 * np.gradient(value) / STEP
        if block.signal is Signal.PRESSURE
        else value
        for block, value in zip(plain.blocks, plain.measured, strict=True)
    ]
    found = polished(problem, _start(problem))
    index = [one.path for one in problem.constants].index("response.valve")
    constant = problem.constants[index]
    at_once = -constant.nominal / constant.sigma
    assert found.point.shifts[index] == pytest.approx(at_once, abs=1e-6)
    assert found.information[index, index] > 1.0


def test_a_freed_constant_goes_where_it_has_to() -> None:
    problem = _problem(_off(diameter=0.022))
    index = [one.path for one in problem.constants].index("muscle.diameter")
    free = replace(_start(problem), freed=frozenset({index}))
    value, std = _value(polished(problem, free), problem, "muscle.diameter")
    assert value == pytest.approx(0.020, abs=5e-4)
    assert std > 0


def _cost(problem: Problem, found: Polished, vector: Array) -> float:
    """Chi² plus priors, from residuals and the definition of the priors."""
    count = found.point.shifts.size
    effects = tuple(
        replace(effect, bias=float(vector[count]) * found.coordinates[0].unit)
        for effect in found.point.effects
    )
    point = Point(vector[:count], effects)
    white = [
        problem.white([left], index)
        for index, left in enumerate(problem.residuals(point))
    ]
    return float(sum(np.sum(one**2) for one in white) + vector @ vector)


def test_the_optimum_is_that_of_another_optimiser() -> None:
    problem = _problem(_off(diameter=0.0202))
    problem = pinned(problem, "muscle.diameter")
    found = polished(problem, _start(problem, ForceSensorBias()))
    size = found.covariance.shape[0]
    assert size == len(problem.constants) + 1

    def cost(vector: Array) -> float:
        return _cost(problem, found, vector)

    best = minimize(cost, np.zeros(size), method="BFGS", options={"gtol": 0.02})
    assert found.cost == pytest.approx(best.fun, abs=0.05)
    # The covariance is the inverse of half the Hessian of chi².
    hessian = np.linalg.inv(found.covariance)
    moved = np.zeros(size)
    moved[-1] = 1.0
    curved = [cost(best.x + step * moved) for step in (-1.0, 0.0, 1.0)]
    assert hessian[-1, -1] == pytest.approx(
        0.5 * (curved[0] - 2 * curved[1] + curved[2]), rel=0.02
    )


@pytest.mark.parametrize("sharp", [0.0, 1e-6, 25.0, 1e4])
@pytest.mark.parametrize("unit", [2e-3, 1e-9])
def test_a_shape_is_as_doubtful_as_data_and_its_limits_leave_it(
    sharp: float, unit: float
) -> None:
    """Where data say nothing it is anywhere between these (a uniform law)."""
    shape = Coordinate("creep", "fresh", unit, 0.01, 1.0, is_amplitude=False)
    size = Coordinate("creep", "fast", 0.1, 0.0, 1.0, is_amplitude=True)
    told = np.diag([sharp, 9.0])
    held = np.asarray(np.linalg.inv(told + np.eye(2)), np.float64)
    fit = Polished(Point(np.zeros(0)), 0.0, {}, {}, (shape, size), held, told)
    alone = (1.0 - 0.01) / 12**0.5 / unit
    std = np.sqrt(np.diag(fit.posterior))
    assert std[0] == pytest.approx((sharp + alone**-2) ** -0.5)
    assert std[1] == pytest.approx(10**-0.5)


def test_the_cost_is_misfit_plus_prior() -> None:
    problem = _problem(_off(diameter=0.0203))
    found = polished(problem, _start(problem))
    prior = float(found.point.shifts @ found.point.shifts)
    assert found.cost == pytest.approx(sum(found.misfits.values()) + prior)
    assert found.samples == sum(time.size for time in problem.times)


@pytest.mark.parametrize(
    ("hidden", "start", "expected", "tolerance"),
    [
        (rubbing(20.0), CoulombFriction(magnitude=5.0), 20.0, 1.5),
        (threshold(25.0), ThresholdPressure(pressure=10e3), 25e3, 1.5e3),
    ],
)
def test_the_size_of_an_effect_is_found(
    hidden: Hidden, start: Effect, expected: float, tolerance: float
) -> None:
    problem = problem_of(recording(hidden), MODEL, {})
    found = polished(problem, _start(problem, start))
    (effect,) = found.point.effects
    name = found.coordinates[0].parameter
    assert getattr(effect, name) == pytest.approx(expected, abs=tolerance)


def test_an_amplitude_that_cannot_be_negative_ends_at_zero() -> None:
    problem = problem_of(recording(rubbing(-15.0)), MODEL, {})
    found = polished(problem, _start(problem, CoulombFriction(magnitude=10.0)))
    (effect,) = found.point.effects
    assert isinstance(effect, CoulombFriction)
    assert effect.magnitude == 0.0


def test_a_shape_stays_within_its_bounds() -> None:
    problem = problem_of(recording(threshold(25.0)), MODEL, {})
    soft = ThresholdPressure(pressure=25e3, softness=40e3)
    found = polished(problem, _start(problem, soft))
    (effect,) = found.point.effects
    assert isinstance(effect, ThresholdPressure)
    # The hidden threshold is sharp.
    assert 0.0 <= effect.softness < 5e3


@pytest.mark.parametrize(
    ("distance", "slip", "free"),
    [(0.0, 0.0, set()), (1e-3, 0.0, {"distance"}), (0.0, 3e-3, {"slip"})],
)
def test_no_step_leads_from_one_law_of_friction_to_another(
    distance: float, slip: float, free: set[str]
) -> None:
    problem = problem_of(recording(rubbing(15.0)), MODEL, {})
    start = CoulombFriction(magnitude=10.0, distance=distance, slip=slip)
    found = polished(problem, _start(problem, start))
    (effect,) = found.point.effects
    assert isinstance(effect, CoulombFriction)
    assert {one.parameter for one in found.coordinates} == {"magnitude"} | free
    # Nothing turns slowly here: at once is best, but for good it is another law.
    assert (effect.distance > 0, effect.slip > 0) == (distance > 0, slip > 0)


@pytest.mark.parametrize("start", [0.05, 0.5, 5.0])
def test_a_lag_is_found_in_time(start: float) -> None:
    late = problem_of(_lagging(1.0), MODEL, {})
    found = polished(late, _start(late, ValveLag(share=1.0, time=start)))
    (effect,) = found.point.effects
    assert isinstance(effect, ValveLag)
    # Behind a ramp only this product shows.
    behind = effect.share * (effect.dead_time + effect.time)
    assert behind == pytest.approx(1.0, rel=0.06)
    assert found.cost < found.samples


@pytest.mark.parametrize("unit", [1.0, 15.0])
def test_what_is_proportional_changes_alike_near_a_limit_and_far_from_it(
    unit: float,
) -> None:
    problem = problem_of(_lagging(1.0), MODEL, {})
    lag = ValveLag(share=1.0, time=0.5)
    # From 0 to 1.5: a tenth of the larger unit leaves it at either end.
    share = Coordinate("valve_lag", "share", unit, 0.0, 1.5, is_amplitude=True)
    columns = [
        slopes(problem, _start(problem, replace(lag, share=at)), [share])[:, -1]
        for at in (0.1, 0.75, 1.45, 1.5)
    ]
    assert np.ptp(columns[0]) > 1.0
    for column in columns[1:]:
        assert column == pytest.approx(columns[0], abs=1e-6 * np.ptp(columns[0]))


@pytest.mark.parametrize("unit", [STEP, 10 * STEP])
def test_a_delay_changes_as_the_line_to_the_sample_before_has_it(unit: float) -> None:
    # A step past the next sample is the slope of no place that is near.
    problem = _problem()
    late = ChannelDelay(delay=0.3 * STEP, channel=Signal.FORCE)
    one = Coordinate(late.name, "delay", unit, 0.0, 100 * STEP, is_amplitude=True)
    column = slopes(problem, _start(problem, late), [one], None, SIZE_STEPS[1])[:, -1]
    on_time = problem.explanation(_start(problem))
    expected = []
    for index, block in enumerate(problem.blocks):
        course = problem.courses[block.course]
        track = track_of(on_time, course, block.course)
        (force,) = predicted(on_time, course, [Signal.FORCE], track).values()
        falls = -np.diff(force, prepend=force[0]) / STEP * unit
        change = falls if block.signal is Signal.FORCE else 0.0 * falls
        expected.append(problem.white([change[block.good]], index)[:, 0])
    assert np.ptp(column) > 1.0
    assert column == pytest.approx(np.concatenate(expected), rel=1e-6, abs=1e-6)


def test_every_round_looks_nearer(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[float] = []

    def watched(
        problem: Problem,
        point: Point,
        coordinates: Sequence[Coordinate],
        base: Base,
        step: float,
    ) -> Array:
        seen.append(step)
        return slopes(problem, point, coordinates, base, step)

    problem = problem_of(recording(threshold(25.0)), MODEL, {})
    monkeypatch.setattr("gripperd.diagnose.fit.polish.slopes", watched)
    far: Effect = Creep(-0.02, -0.02, -0.02, time=0.7, leverage=1.0, fresh=0.7)
    polished(problem, _start(problem, far))
    longest, least = SIZE_STEPS
    assert len(seen) > 2
    assert seen[0] == longest
    assert all(max(a / 2, least) == b for a, b in pairwise(seen))


def _lagging(time: float) -> Recording:
    """Pressures behind a lag, whose commands are held between samples."""
    kept = np.exp(-STEP / time)
    found = without(recording(nothing), "force")
    for name, moment in moments().items():
        late = moment.pressure[0] + lfilter(
            [1 - kept], [1, -kept], moment.pressure - moment.pressure[0]
        )
        behind = late - moment.pressure
        found = altered(found, (name,), "pressure", partial(np.add, behind))
    return found


def test_what_is_best_already_stays() -> None:
    problem = _problem()
    once = polished(problem, _start(problem))
    again = polished(problem, once.point)
    assert again.cost <= once.cost
    assert again.cost == pytest.approx(once.cost, abs=0.5)


def test_what_is_good_enough_is_not_made_the_best() -> None:
    problem = problem_of(recording(rubbing(20.0)), MODEL, {})
    start = _start(problem, CoulombFriction(magnitude=5.0))
    best, first = polished(problem, start).cost, polished(problem, start, rounds=1).cost
    assert best < first - 1.0
    assert polished(problem, start, enough=best + 2 * (first - best)).cost == first
    assert polished(problem, start, enough=best - 1.0).cost == best


def test_what_promises_nothing_is_not_tried_again() -> None:
    problem = _problem()
    best = polished(problem, _start(problem))
    while (again := polished(problem, best.point)).cost < best.cost:
        best = again
    seen: list[Explanation] = []

    class Watched(Problem):
        """A problem that knows where it was looked at."""

        def tracks(self, explanation: Explanation) -> tuple[Runs, ...]:
            seen.append(explanation)
            return super().tracks(explanation)

    given = {one.name: getattr(problem, one.name) for one in fields(problem)}
    polished(Watched(**given), best.point)
    assert len(seen) == len(("where it starts", "the step that promises nothing"))


def test_a_step_that_leads_too_far_is_shortened_until_it_helps() -> None:
    problem = problem_of(recording(threshold(25.0)), MODEL, {})
    far: Effect = Creep(-0.02, -0.02, -0.02, time=0.7, leverage=1.0, fresh=0.7)
    found = polished(problem, _start(problem, far))
    count, units = found.point.shifts.size, [one.unit for one in found.coordinates]

    def cost(vector: Array) -> float:
        """Chi² and prior of constants and amplitude, in their sigmas."""
        pairs = zip(found.coordinates, vector[count:] * units, strict=True)
        values = {one.parameter: float(value) for one, value in pairs}
        point = Point(vector[:count], (replace(far, **values),))
        left = enumerate(problem.residuals(point))
        chi = sum(float(np.sum(problem.white([one], i) ** 2)) for i, one in left)
        prior = sum(
            (values[one.parameter] / one.unit) ** 2
            for one in found.coordinates
            if one.is_amplitude
        )
        return chi + prior + float(vector[:count] @ vector[:count])

    (effect,) = found.point.effects
    shapes = [getattr(effect, one.parameter) / one.unit for one in found.coordinates]
    here = np.concatenate([found.point.shifts, shapes])
    assert cost(here) == pytest.approx(found.cost)
    box = Bounds(*bounds(problem, found.point, found.coordinates))
    best = minimize(cost, here, method="L-BFGS-B", bounds=box, options={"maxiter": 3})
    assert best.fun > 0.99 * found.cost


def test_a_bent_valley_is_followed_to_its_end() -> None:
    # Early and late stiffness, bore and wall make up for each other: from far away the
    # way leads along a valley that bends, and steps damped by 1 % hardly follow it.
    def rubber(moment: Moment) -> Array:
        tenths = moment.contraction / 0.1
        early = -80.0 * np.expm1(-moment.contraction / 0.0106)
        return -(early - 42.0 * tenths**2 + 17.0 * tenths**3)

    built = _off(diameter=0.0202, wall_thickness=0.00195)
    problem = problem_of(recording(rubber), built, {})
    near, far = (
        polished(
            problem, _start(problem, NonlinearElasticity(50.0, 20.0, 10.0, length))
        )
        for length in (0.0106, 0.3)
    )
    assert far.cost < near.cost + 4.0
    (effect,) = far.point.effects
    assert isinstance(effect, NonlinearElasticity)
    assert effect.contraction == pytest.approx(0.0106, rel=0.2)


def test_the_size_of_relays_is_found() -> None:
    # A prior of another parameter's width held them at half their size.
    plain = _problem()
    hidden = PreslidingHysteresis(hysteron=Hysteron.RELAY, relays=120.0)
    problem = _told(plain, hidden)
    start = PreslidingHysteresis(hysteron=Hysteron.RELAY, relays=10.0)
    found = polished(problem, _start(problem, start))
    (effect,) = found.point.effects
    assert isinstance(effect, PreslidingHysteresis)
    assert effect.relays == pytest.approx(120.0, rel=0.05)


def test_a_shortening_is_found_from_none_at_all() -> None:
    plain = _problem()
    hidden = SeriesCompliance(shortening=1e-5)
    problem = _told(plain, hidden)
    found = polished(problem, _start(problem, SeriesCompliance()))
    (effect,) = found.point.effects
    assert isinstance(effect, SeriesCompliance)
    assert effect.shortening == pytest.approx(1e-5, rel=0.05)


def _told(problem: Problem, hidden: Effect) -> Problem:
    """The same sweeps, with the readings of an effect without noise."""
    truth = problem.explanation(_start(problem, hidden))
    told = replace(problem)
    told.__dict__["measured"] = problem.expected(truth)
    return told
