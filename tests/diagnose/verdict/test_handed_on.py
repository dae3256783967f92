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
"""Of the grip, by itself."""
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
    drift = {sweep: 12.0 * (-1) ** sweep for sweep in _sweeps(drifting)}
    handed = {sweep: -each / LINKAGE.ratio for sweep, each in drift.items()}
    (told,) = not_handed_on(drifting, _left(drifting, drift, handed))
    assert told.p_value > 0.01


def test_what_the_force_does_not_tell_is_the_grip_itself(drifting: Problem) -> None:
    # Two and a half times what drifts, and ten times what the grip drifts itself.
    left = _left(drifting, {}, {_sweeps(drifting)[1]: 2.6})
    grips = [one for one in structures(drifting, left) if one.signal is Signal.GRIP]
    (told,) = not_handed_on(drifting, left)
    assert min(one.p_value for one in grips) > 1e-4
    assert told.p_value < 1e-6
    # Root mean square over all samples, of which one sweep has its share.
    sizes = [
        (block.good & other.good).sum()
        for block in drifting.blocks
        for other in drifting.blocks
        if (block.signal, other.signal) == (Signal.GRIP, Signal.FORCE)
        and block.course == other.course
    ]
    scale = drifting.full_scale
    span = scale[Signal.GRIP] + scale[Signal.FORCE] / LINKAGE.ratio
    size = 2.6 * (sizes[1] / sum(sizes)) ** 0.5 / span
    assert told.size == pytest.approx(size, rel=0.2)


def test_without_a_cell_in_the_muscle_nothing_is_handed_on(drifting: Problem) -> None:
    left = _left(drifting, {}, {})
    own = replace(drifting, noises={Signal.GRIP: GRIP})
    grips = [
        each
        for block, each in zip(drifting.blocks, left, strict=True)
        if block.signal is Signal.GRIP
    ]
    assert not_handed_on(own, grips) == ()
    bare = replace(drifting, model=replace(drifting.model, linkage=None))
    assert not_handed_on(bare, left) == ()


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
    assert "grip: depends on the sweep, in which the force is as it should be" in words
