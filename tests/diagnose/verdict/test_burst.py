from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.diagnosis import diagnose
from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.rivalry import Contest
from gripperd.diagnose.verdict.burst import bursts
from gripperd.diagnose.verdict.conclude import (
    Conclusion,
    Verdict,
    conclude,
    not_confirmed,
)
from gripperd.diagnose.verdict.conclude import _remaining as remaining
from gripperd.diagnose.verdict.signature import signature
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose.small import MODEL, Moment, recording
from tests.diagnose.sweep import noise

STD = 3.0


@pytest.fixture(scope="module")
def plain(blank: Problem) -> Problem:
    """The force alone."""
    return replace(blank, noises={Signal.FORCE: Noise(STD, 0.0)})


def _left(problem: Problem, *knocks: tuple[int, int, Sequence[float]]) -> list[Array]:
    """Noise, and readings that are off from a sample of a block on, in sigma."""
    found = [
        noise(int(block.good.sum()), STD, 100 + place)
        for place, block in enumerate(problem.blocks)
    ]
    for block, start, sizes in knocks:
        found[block][start : start + len(sizes)] = STD * np.array(sizes)
    return found


LONG = (12.0, 11.0, 9.0, 8.0)


def test_noise_has_none(plain: Problem) -> None:
    assert bursts(plain, _left(plain)) == {}


def test_what_comes_again_in_another_sweep_is_counted(plain: Problem) -> None:
    left = _left(plain, (0, 20, LONG), (0, 40, LONG), (2, 10, [-9.0, -9.0, -9.0]))
    assert bursts(plain, left) == {Signal.FORCE: 3}


@pytest.mark.parametrize(
    "knocks",
    [
        pytest.param([(0, 20, LONG), (0, 40, LONG)], id="in one sweep"),
        pytest.param([(0, 20, LONG), (1, 20, LONG[:2])], id="two readings"),
        pytest.param([(0, 20, LONG), (1, 20, [9.0, -9.0, 9.0])], id="to either side"),
        pytest.param([(0, 20, LONG), (1, 20, [5.0, 5.0, 5.0])], id="not so far"),
    ],
)
def test_less_is_none(
    plain: Problem, knocks: list[tuple[int, int, Sequence[float]]]
) -> None:
    assert bursts(plain, _left(plain, *knocks)) == {}


def test_readings_apart_do_not_follow_each_other(plain: Problem) -> None:
    left = _left(plain, (0, 20, LONG[:3]), (1, 20, LONG[:3]))
    assert bursts(plain, left) == {Signal.FORCE: 2}
    kept = []
    for course in plain.courses:
        mask = np.ones(len(course), dtype=bool)
        mask[1::2] = False
        kept.append(mask)
    sparse = replace(plain, kept=tuple(kept))
    assert bursts(sparse, _left(sparse, (0, 20, LONG[:3]), (1, 9, LONG[:3]))) == {}


def test_what_is_small_is_none(plain: Problem) -> None:
    left = _left(plain, (0, 20, LONG), (1, 20, LONG))
    # Down to 8 sigma of a force of 1.3 kN, of which 0.5 % are 6.5 N.
    quiet = [one / 10 for one in left]
    assert bursts(plain, quiet) == {}


def test_a_table_has_no_readings_in_a_row(plain: Problem) -> None:
    listed = tuple(replace(one, listed=True) for one in plain.courses)
    left = _left(plain, (0, 20, LONG), (1, 20, LONG))
    assert bursts(replace(plain, courses=listed), left) == {}


def _press(moment: Moment) -> Array:
    """A press beside the rig knocks every 31 s: 60 N that ring off within 3 s."""
    since = moment.time % 31.0
    return 60.0 * np.exp(-since / 1.2) * np.cos(since)


def test_a_rig_that_is_knocked_again_and_again_is_unexplained() -> None:
    told = diagnose(recording(_press), MODEL, {}, {})
    # As loud as all of it together, the noise would hide them.
    noises = {**told.split.train.noises, Signal.FORCE: Noise(6 * STD, 0.0)}
    problem, null = replace(told.split.train, noises=noises), Contest(told.found.null)
    concluded = conclude(problem, told.found, null)
    assert not concluded.louder
    assert not remaining(concluded.left)
    assert concluded.verdict is Verdict.UNEXPLAINED
    words = signature(problem, null, concluded)
    assert any("bursts, far off for a while each" in line for line in words)


def test_a_name_withdrawn_leaves_bursts_unexplained() -> None:
    odd = Conclusion(Verdict.NAMED, (), 1.0, bursts={Signal.FORCE: 4})
    assert not_confirmed(odd, is_open=False).verdict is Verdict.UNEXPLAINED
    assert odd.signals == (Signal.FORCE,)
