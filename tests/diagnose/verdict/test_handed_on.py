from dataclasses import replace

import pytest

from gripperd.diagnose.diagnosis import diagnose
from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.rivalry import Contest
from gripperd.diagnose.setup import problem_of
from gripperd.diagnose.verdict.conclude import Verdict, conclude
from gripperd.diagnose.verdict.handed_on import not_handed_on
from gripperd.diagnose.verdict.signature import signature
from gripperd.diagnose.verdict.structure import structures
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose.small import LINKAGE, MODEL, nothing, recording, with_grip
from tests.diagnose.sweep import noise

CELL = Noise(3.0, 0.0, drift=4.0, memory=200.0)
"""Of the force, which drifts by four newtons."""
OWN = 0.25
"""What the cell between the jaws drifts. [N]"""
GRIP = Noise(0.9, 0.0, drift=(OWN**2 + (CELL.drift / LINKAGE.ratio) ** 2) ** 0.5)
JAWS = replace(MODEL, linkage=LINKAGE)


@pytest.fixture(scope="module")
def drifting() -> Problem:
    """The small rig with a grip, foretold from a force that drifts."""
    problem = problem_of(with_grip(recording()), JAWS, {})
    return replace(problem, noises={Signal.FORCE: CELL, Signal.GRIP: GRIP})


def _left(
    problem: Problem, force: dict[int, float], grip: dict[int, float]
) -> list[Array]:
    """Noise, and how far off either is in some sweeps. [N]."""
    off = {Signal.FORCE: force, Signal.GRIP: grip}
    std = {Signal.FORCE: CELL.std, Signal.GRIP: GRIP.std}
    return [
        noise(int(block.good.sum()), std[block.signal], 300 + place)
        + off[block.signal].get(block.course, 0.0)
        for place, block in enumerate(problem.blocks)
    ]


def _sweeps(problem: Problem) -> list[int]:
    return [block.course for block in problem.blocks if block.signal is Signal.GRIP]


def test_what_a_drift_of_the_force_does_to_a_grip_is_handed_on(
    drifting: Problem,
) -> None:
    drift = {sweep: 24.0 * (-1) ** sweep for sweep in _sweeps(drifting)}
    handed = {sweep: -each / LINKAGE.ratio for sweep, each in drift.items()}
    assert not_handed_on(drifting, _left(drifting, drift, handed)) == {}
    assert not_handed_on(drifting, _left(drifting, drift, {})) != {}


def test_what_the_force_does_not_tell_is_the_grip_itself(drifting: Problem) -> None:
    # Three times what drifts, in one sweep of six, which no order of all shows.
    left = _left(drifting, {}, {_sweeps(drifting)[1]: 3.0})
    grips = [one for one in structures(drifting, left) if one.signal is Signal.GRIP]
    assert min(one.p_value for one in grips) > 1e-5
    # Root mean square over all samples, of which one sweep has its share.
    sizes = [
        (block.good & other.good).sum()
        for block in drifting.blocks
        for other in drifting.blocks
        if (block.signal, other.signal) == (Signal.GRIP, Signal.FORCE)
        and block.course == other.course
    ]
    size = 3.0 * (sizes[1] / sum(sizes)) ** 0.5
    assert not_handed_on(drifting, left) == {Signal.GRIP: pytest.approx(size, rel=0.1)}


@pytest.mark.parametrize(
    ("newtons", "own"),
    [
        pytest.param(0.6, 0.1, id="so little that nobody minds"),
        pytest.param(3.0, 2.0, id="beside a cell that drifts so itself"),
    ],
)
def test_sound_sensors_are_off_by_as_much(
    drifting: Problem, newtons: float, own: float
) -> None:
    drift = (own**2 + (CELL.drift / LINKAGE.ratio) ** 2) ** 0.5
    noises = {Signal.FORCE: CELL, Signal.GRIP: replace(GRIP, drift=drift)}
    problem = replace(drifting, noises=noises)
    off = {sweep: newtons * (-1) ** sweep for sweep in _sweeps(problem)}
    assert not_handed_on(problem, _left(problem, {}, off)) == {}


def test_without_a_cell_in_the_muscle_nothing_is_handed_on(drifting: Problem) -> None:
    left = _left(drifting, {}, {_sweeps(drifting)[1]: 9.0})
    own = replace(drifting, noises={Signal.GRIP: GRIP})
    grips = [
        each
        for block, each in zip(drifting.blocks, left, strict=True)
        if block.signal is Signal.GRIP
    ]
    assert not_handed_on(own, grips) == {}
    bare = replace(drifting, model=replace(drifting.model, linkage=None))
    assert not_handed_on(bare, left) == {}


def test_a_grip_of_its_own_leaves_it_unexplained() -> None:
    def held(stronger: float) -> tuple[Verdict, tuple[str, ...]]:
        plain = with_grip(recording(nothing))
        run = plain.runs[2]
        grip = run.columns["grip"] + stronger * (run.columns["grip"] > 5.0)
        runs = list(plain.runs)
        runs[2] = replace(run, columns={**run.columns, "grip": grip})
        told = diagnose(replace(plain, runs=tuple(runs)), JAWS, {}, {})
        noises = {**told.split.train.noises, Signal.FORCE: CELL, Signal.GRIP: GRIP}
        problem = replace(told.split.train, noises=noises)
        null = Contest(told.found.null)
        concluded = conclude(problem, told.found, null)
        return concluded.verdict, signature(problem, null, concluded)

    assert held(0.0)[0] is Verdict.NONE
    verdict, words = held(3.0)
    assert verdict is Verdict.UNEXPLAINED
    (told,) = (word for word in words if "sweeps in which the force" in word)
    assert told.startswith("grip: 0.9 N off")
    assert "share of the gap that known effects explain: 0%" in words
