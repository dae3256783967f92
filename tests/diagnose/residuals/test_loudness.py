from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.noise.model import Noise, quick_noise
from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.diagnose.residuals.explanation import Explanation
from gripperd.diagnose.residuals.loudness import _handed_on
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.residuals.quiet import moved, repeated
from gripperd.diagnose.setup import problem_of
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose.small import (
    FORCE_NOISE,
    GRIP_NOISE,
    LINKAGE,
    MODEL,
    PRESSURE_NOISE,
    Hidden,
    Moment,
    altered,
    moments,
    nothing,
    recording,
    rubbing,
    tabled,
    textbook,
    threshold,
    with_grip,
)
from tests.diagnose.sweep import noise

JAWED = replace(MODEL, linkage=LINKAGE)
ALL = ("vented", "a", "b", "c", "d", "e", "b2", "f")


def test_the_noise_of_each_signal_is_measured(blank: Problem) -> None:
    force, pressure = blank.noises[Signal.FORCE], blank.noises[Signal.PRESSURE]
    # A fifth more than the sensor alone: smooth inputs are never quite right.
    assert force.std == pytest.approx(FORCE_NOISE, rel=0.2)
    assert pressure.std == pytest.approx(PRESSURE_NOISE, rel=0.2)
    assert max(force.correlation, pressure.correlation) < 0.2


def test_a_length_that_is_read_badly_does_not_make_the_force_loud() -> None:
    """Of isobars it makes most of what is left, and nothing where a length is held."""
    rng = np.random.default_rng(17)
    every = [run.name for run in recording(nothing).runs]
    loud = altered(
        recording(nothing), every, "contraction",
        lambda held: held + rng.normal(0.0, 2e-3, held.size),
    )  # fmt: skip
    problem = problem_of(loud, MODEL, {})
    assert problem.noises[Signal.FORCE].std == pytest.approx(FORCE_NOISE, rel=0.25)
    wrong = np.concatenate(
        [
            problem.courses[block.course].column("force")[block.good] - made
            for block, made in zip(
                problem.blocks, problem.expected(problem.model), strict=True
            )
            if block.signal is Signal.FORCE
        ]
    )
    # The model misses nothing, and the trend of a length so noisy is off.
    assert np.std(wrong) > 1.05 * FORCE_NOISE
    assert problem.floor(Signal.FORCE) == pytest.approx(np.std(wrong), rel=0.2)


def test_a_converter_of_coarse_steps_is_no_quieter_than_its_steps() -> None:
    """Holds read in steps of 5 N, by a sensor with a noise of 1.5 N of its own.

    Most readings repeat the one before, so all but a few changes of the residual are 0.
    """
    runs, errors = [], []
    for place, held in enumerate((0.0, 0.04, 0.08, 0.12, 0.16)):
        pressure = np.repeat([100e3, 200e3, 300e3, 400e3, 500e3], 40)
        size, level = pressure.size, np.ones(pressure.size)
        time = 200 * place + np.arange(0.0, 50.0, 0.25)
        force = textbook(Moment(time, pressure, held * level, level))
        read = 5.0 * np.round((force + noise(size, 1.5, place)) / 5.0)
        errors.append(read - force)
        columns = {
            "time": time,
            "pressure": pressure + noise(size, 200.0, 10 + place),
            "contraction": held + noise(size, 2e-5, 20 + place),
            "force": read,
        }
        runs.append(Run(str(held), columns))
    problem = problem_of(Recording("coarse", "0" * 64, tuple(runs)), MODEL, {})
    wrong = float(np.std(np.concatenate(errors)))
    assert problem.noises[Signal.FORCE].std == pytest.approx(wrong, rel=0.15)


@pytest.mark.parametrize("hidden", [threshold(25.0), rubbing(20.0)])
def test_what_is_hidden_is_not_taken_for_noise(hidden: Hidden) -> None:
    problem = problem_of(recording(hidden), MODEL, {})
    assert problem.noises[Signal.FORCE].std == pytest.approx(FORCE_NOISE, rel=0.25)
    assert problem.noises[Signal.FORCE].drift < 3.0


@pytest.mark.parametrize(
    "left_out",
    [
        pytest.param((), id="holds and repeats"),
        pytest.param(("vented",), id="repeats alone"),
        pytest.param(("b2",), id="holds alone"),
    ],
)
def test_a_sensor_that_drifts_is_seen_to_drift(left_out: tuple[str, ...]) -> None:
    runs = tuple(run for run in recording().runs if run.name not in left_out)
    told = Recording("drift", "0" * 64, runs)
    drifting = told
    for seed, name in enumerate(ALL):
        drifting = altered(drifting, [name], "force", _drifted(seed))
    still, moving = (
        problem_of(one, MODEL, {}).noises[Signal.FORCE] for one in (told, drifting)
    )
    assert moving.drift > 1.5 * still.drift
    assert moving.std == pytest.approx(FORCE_NOISE, rel=0.2)


@pytest.mark.parametrize(
    ("order", "is_drift"),
    [
        pytest.param(("b", "b2", "a", "vented", "c", "d", "e"), False, id="first"),
        pytest.param(("a", "b", "c", "b2", "vented", "d", "e"), True, id="later"),
        pytest.param(("b", "b2", "a", "c", "d", "e"), True, id="first, nothing else"),
    ],
)
def test_what_a_first_inflation_has_on_top_is_no_drift(
    order: tuple[str, ...], *, is_drift: bool
) -> None:
    told = recording(order=order)
    bulging = altered(
        told, ["b"], "force", lambda read: read + 20 * np.hanning(read.size) ** 3
    )
    still, moving = (
        problem_of(one, MODEL, {}).noises[Signal.FORCE].drift for one in (told, bulging)
    )
    assert (moving > 1.5 * still) is is_drift


def _drifted(seed: int) -> Callable[[Array], Array]:
    """Add a drift of 5 N that forgets in 40 samples, 10 s."""
    return lambda force: force + noise(force.size, 5.0, seed, float(np.exp(-1 / 40)))


def _gripping(told: Recording, model: Explanation = JAWED) -> Problem:
    return problem_of(with_grip(told), model, {})


@pytest.fixture(scope="module")
def gripping() -> Problem:
    return _gripping(recording())


def _handed(told: dict[Signal, Noise], problem: Problem) -> dict[Signal, Noise]:
    return _handed_on(told, problem, problem.residuals(_null(problem)))


def test_the_force_hands_its_noise_and_drift_on_to_the_grip(gripping: Problem) -> None:
    told = {
        Signal.FORCE: Noise(12.0, 0.5, drift=6.0, memory=60.0),
        Signal.GRIP: Noise(7.0, 0.5, drift=0.5, memory=20.0),
    }
    handed = _handed(told, gripping)[Signal.GRIP]
    # By the ratio of 4: 12² N² and 36 N² over 16, and what the grip has of its own.
    assert handed.std**2 == pytest.approx(12**2 / 16 + GRIP_NOISE**2, abs=0.5)
    turned = (0.003 * gripping.full_scale[Signal.GRIP]) ** 2
    assert handed.drift**2 == pytest.approx(36 / 16 + 0.25 + turned)
    # Means over many samples: three times the variance at a correlation of a half.
    mean = handed.std**2 * (1 + handed.correlation) / (1 - handed.correlation)
    assert mean == pytest.approx(3 * 12**2 / 16 + GRIP_NOISE**2, rel=0.05)
    slow = handed.drift**2 * handed.memory
    assert slow == pytest.approx(60 * 36 / 16 + 20 * 0.25 + 3 * turned)
    assert _handed(told, gripping)[Signal.FORCE] == told[Signal.FORCE]


def test_a_force_that_wanders_under_its_noise_hands_that_on_as_well(
    gripping: Problem,
) -> None:
    """Neighbours in the residual of the grip know nothing of it."""
    force = Noise(8.0, 0.54, white=0.4)
    neighbours = quick_noise([noise(400, 1.5, 3)])
    assert neighbours.slow_variance < 0.1 * force.slow_variance / 16
    told = {Signal.FORCE: force, Signal.GRIP: neighbours}
    handed = _handed(told, gripping)[Signal.GRIP]
    own = force.slow_variance / 16 + GRIP_NOISE**2
    assert handed.slow_variance == pytest.approx(own, rel=0.2)


def test_what_a_grip_leaves_is_as_quiet_as_it_was_told_at_first(
    gripping: Problem,
) -> None:
    """Its holds may tell less than its readings and its residual between turns do."""
    told = {Signal.FORCE: Noise(0.5, 0.0), Signal.GRIP: Noise(0.3, 0.0)}
    handed = _handed(told, gripping)[Signal.GRIP]
    assert handed.std**2 == pytest.approx(0.3**2 + 0.5**2 / 16)


def test_without_a_linkage_nothing_is_handed_on(gripping: Problem) -> None:
    told = {Signal.FORCE: Noise(8.0, 0.5), Signal.GRIP: Noise(3.0, 0.0)}
    bare = replace(gripping, model=MODEL)
    assert _handed(told, bare) == told


@pytest.mark.parametrize("loud", [4.0, 16.0])
def test_a_grip_is_as_noisy_as_its_two_cells(loud: float) -> None:
    problem = _gripping(recording(noise=loud))
    both = float(np.hypot(GRIP_NOISE, loud * FORCE_NOISE / 4))
    assert problem.noises[Signal.GRIP].std == pytest.approx(both, rel=0.2)
    left = [
        problem.white([residual], index)
        for index, residual in enumerate(problem.residuals(_null(problem)))
        if problem.blocks[index].signal is Signal.GRIP
    ]
    assert np.mean(np.concatenate(left) ** 2) == pytest.approx(1.0, abs=0.2)


def test_a_grip_that_rises_fast_is_no_noise() -> None:
    """Grasps at 12.5 Hz: twelve samples up, nineteen held, twelve down."""
    runs = []
    for place, held in enumerate((0.01, 0.03, 0.05, 0.07, 0.09, 0.11)):
        since = np.arange(0.0, 3.5, 0.08)
        pressure = np.interp(since, [0.0, 1.0, 2.5, 3.5], [0.0, 480e3, 480e3, 0.0])
        size, level = since.size, np.ones(since.size)
        force = textbook(Moment(100 * place + since, pressure, held * level, level))
        grip = np.maximum((force - 240.0 - 1000.0 * 0.25 * held) / 4, 0.0)
        columns = {
            "time": 100 * place + since,
            "pressure": pressure + noise(size, PRESSURE_NOISE, 10 + place),
            "contraction": held + noise(size, 2e-5, 20 + place),
            "force": force + noise(size, FORCE_NOISE, 30 + place),
            "grip": grip + noise(size, GRIP_NOISE, 40 + place),
        }
        runs.append(Run(f"grasp_{place}", columns))
    problem = problem_of(Recording("grasps", "0" * 64, tuple(runs)), JAWED, {})
    both = float(np.hypot(GRIP_NOISE, FORCE_NOISE / 4))
    assert problem.noises[Signal.GRIP].std == pytest.approx(both, rel=0.25)


def test_a_grip_that_rises_and_falls_in_few_readings_is_no_noise() -> None:
    """Grasps at 3 Hz, each with a second squeeze; their joints rub by 3 % of the load.

    Neighbours on an object differ by 7 N, but for two that jaws turn round between.
    """
    rng = np.random.default_rng(4)
    runs = []
    for place, held in enumerate((0.02, 0.03, 0.04, 0.05, 0.06, 0.07)):
        since = np.arange(0.0, 17.0, 0.3)
        knots = [0.0, 6.0, 9.0, 12.0, 17.0]
        loads = [0.0, 480e3, 240e3, 400e3, 0.0]
        pressure = np.interp(since, knots, loads)
        size, level = since.size, np.ones(since.size)
        force = textbook(
            Moment(2000 + 100 * place + since, pressure, held * level, level)
        )
        rubs = np.where(np.gradient(pressure) < 0, -0.03, 0.03) * force
        grip = np.maximum((force - rubs - 240.0 - 1000.0 * 0.25 * held) / 4, 0.0)
        columns = {
            "time": 2000 + 100 * place + since,
            "pressure": pressure + rng.normal(0.0, PRESSURE_NOISE, size),
            "contraction": held + rng.normal(0.0, 2e-5, size),
            "force": force + rng.normal(0.0, FORCE_NOISE, size),
            "grip": grip + rng.normal(0.0, GRIP_NOISE, size),
        }
        runs.append(Run(f"grasp_{place}", columns))
    told = recording()
    problem = problem_of(replace(told, runs=(*told.runs, *runs)), JAWED, {})
    both = float(np.hypot(GRIP_NOISE, FORCE_NOISE / 4))
    found = problem.noises[Signal.GRIP]
    assert found.slow_variance**0.5 == pytest.approx(both, rel=0.5)


def test_a_noisy_force_hides_no_contact(gripping: Problem) -> None:
    loud = _gripping(recording(noise=8.0))
    plain, noisy = (
        sum(b.good.sum() for b in one.blocks if b.signal is Signal.GRIP)
        for one in (gripping, loud)
    )
    assert noisy > 0.9 * plain


@pytest.mark.parametrize("play", [0.0, 2e-3])
def test_what_persists_in_an_opening_is_told_where_jaws_move(play: float) -> None:
    """Three isobars, neither a hold nor a repeat; play is no noise."""
    true = Noise(0.5e-3, 0.56, white=0.3)
    runs = []
    plain = recording()
    for run in plain.runs:
        columns = dict(run.columns)
        if run.name in ("d", "e", "f"):
            moment = moments()[run.name]
            # The rest length of the muscle is 0.25 m, the ratio 4.
            clean = 0.085 - 4.0 * 0.25 * moment.contraction + play * moment.direction
            share, seed = 1 - true.white, ord(run.name)
            columns["opening"] = (
                clean
                + noise(len(run), true.std * share**0.5, seed, 0.8)
                + noise(len(run), true.std * true.white**0.5, 50 + seed)
            )
        else:
            columns["opening"] = np.full(len(run), np.nan)
        runs.append(Run(run.name, columns, run.kind))
    problem = problem_of(Recording("jaws", "0" * 64, tuple(runs)), JAWED, {})
    residuals = problem.residuals(_null(problem))
    openings = [
        i for i, block in enumerate(problem.blocks) if block.signal is Signal.OPENING
    ]
    for each in moved(problem, residuals, openings):
        # Way, pull and pressure go together there; one by one they are no more apart.
        assert np.linalg.cond(each.regressors) == pytest.approx(1.0)
    found = problem.noises[Signal.OPENING]
    assert found.slow_variance == pytest.approx(true.slow_variance, rel=0.5)


def _null(problem: Problem) -> Point:
    return Point(np.zeros(len(problem.constants)))


def test_points_of_a_table_are_no_neighbours_of_each_other() -> None:
    """Forces up to 1.3 kN and grips up to 280 N in any order: an instrument's 0.2 %."""
    plain = tabled(lambda moment: 0 * moment.time)
    random = np.random.default_rng(3)
    runs = []
    for run in plain.runs:
        grip = np.maximum((run.columns["force"] - 240.0) / 4, 0.0)
        order = random.permutation(len(run))
        columns = {
            name: column if name == "time" else column[order]
            for name, column in {**run.columns, "grip": grip}.items()
        }
        runs.append(Run(run.name, columns, run.kind))
    problem = problem_of(replace(plain, runs=tuple(runs)), JAWED, {})
    top = problem.full_scale[Signal.GRIP]
    # Beside its own that of the force, 2.6 N over 4.
    assert 0.002 * top <= problem.noises[Signal.GRIP].std < 0.01 * top


def test_a_sweep_and_its_repeat_are_compared_where_both_tell() -> None:
    """A reading that one of them lacks shifts none of the rest against each other."""
    told = recording(lambda m: 0.5 * m.pressure * m.pull_area)
    gaps = altered(told, ["b"], "force", _without_one)
    problem = problem_of(gaps, MODEL, {})
    blocks = problem.blocks
    indices = [i for i, block in enumerate(blocks) if block.signal is Signal.FORCE]
    residuals = problem.residuals(_null(problem))
    (quiet,) = repeated(problem, residuals, indices, first=False)
    # 10 kPa from one sample to the next are 7 N and more of what is hidden.
    assert np.std(quiet.residual) == pytest.approx(2**0.5 * FORCE_NOISE, rel=0.2)


def _without_one(force: Array) -> Array:
    lacking = force.copy()
    lacking[20] = np.nan
    return lacking
