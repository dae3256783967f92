from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.fit.design import Design, Member
from gripperd.diagnose.fit.gram import Gram
from gripperd.diagnose.fit.null import null_gains
from gripperd.diagnose.residuals.point import Point
from gripperd.model.track import Array

SAMPLES, NUISANCE, OTHERS = 60, 2, 5
SIMULATED = 2000


def _columns() -> Array:
    random = np.random.default_rng(1)
    columns = random.normal(size=(SAMPLES, NUISANCE + OTHERS)) * 3.0
    columns[:, 3] = columns[:, 2] + 0.3 * columns[:, 3]
    # One candidate is nearly a constant: it gains when that is further off than told.
    columns[:, 4] = columns[:, 0] + 0.1 * columns[:, 4]
    return columns


def _gram(columns: Array, target: Array, low: Array) -> Gram:
    return Gram(
        columns.T @ columns,
        columns.T @ target,
        float(target @ target),
        low,
        np.full(low.size, np.inf),
    )


def _design(columns: Array, target: Array, *, one_sided: bool) -> Design:
    low = np.full(columns.shape[1], -np.inf)
    if one_sided:
        low[NUISANCE:] = 0.0
    members = tuple(
        Member(Candidate(f"{place}", None), np.array([place]))
        for place in range(NUISANCE, NUISANCE + OTHERS)
    )
    nuisance = np.arange(NUISANCE, dtype=np.intp)
    gram = _gram(columns, target, low)
    return Design(Point(np.zeros(NUISANCE)), gram, nuisance, (), members, ())


def _brute_force(columns: Array, *, one_sided: bool) -> Array:
    """Best gain in recordings of noise and of constants that are a little off."""
    random = np.random.default_rng(7)
    found = np.zeros(SIMULATED)
    for index in range(SIMULATED):
        target = random.normal(size=SAMPLES)
        target += columns[:, :NUISANCE] @ random.normal(size=NUISANCE)
        one = _design(columns, target, one_sided=one_sided)
        base = one.fit().evidence
        for member in one.members:
            fit = one.fit(member)
            if fit.coefficients[-1] != 0.0:
                found[index] = max(found[index], fit.evidence - base)
    return found


@pytest.mark.parametrize("one_sided", [False, True])
def test_the_price_of_looking_is_that_of_simulated_recordings(one_sided: bool) -> None:
    columns = _columns()
    design = _design(columns, np.zeros(SAMPLES), one_sided=one_sided)
    gains = np.concatenate(
        [
            null_gains(design, design.members, np.random.default_rng(seed))
            for seed in range(10)
        ]
    )
    brute = _brute_force(columns, one_sided=one_sided)
    for level in (0.9, 0.97):
        assert np.quantile(gains, level) == pytest.approx(
            float(np.quantile(brute, level)), abs=0.2
        )


def test_one_that_cannot_be_positive_costs_as_much_as_its_mirror_image() -> None:
    design = _design(_columns(), np.zeros(SAMPLES), one_sided=True)
    sign = np.where(np.arange(NUISANCE + OTHERS) < NUISANCE, 1.0, -1.0)
    gram = design.gram
    high = np.where(sign < 0, 0.0, np.inf)
    low = np.full(high.size, -np.inf)
    mirrored = gram.products * np.outer(sign, sign)
    other = replace(gram, products=mirrored, low=low, high=high)
    levels = [
        np.quantile(
            np.concatenate(
                [
                    null_gains(one, one.members, np.random.default_rng(seed))
                    for seed in range(10)
                ]
            ),
            0.97,
        )
        for one in (design, replace(design, gram=other))
    ]
    assert levels[0] == pytest.approx(levels[1], abs=0.1)


def test_gains_rise_and_none_is_negative() -> None:
    design = _design(_columns(), np.zeros(SAMPLES), one_sided=False)
    gains = null_gains(design, design.members, np.random.default_rng(0))
    assert (np.diff(gains) >= 0).all()
    assert gains[0] >= 0


def test_who_looks_at_more_pays_more() -> None:
    design = _design(_columns(), np.zeros(SAMPLES), one_sided=False)
    few, many = (
        null_gains(design, members, np.random.default_rng(0))
        for members in (design.members[:1], design.members)
    )
    assert (many >= few).all()
    assert many.mean() > few.mean()


def test_without_candidates_nothing_is_gained() -> None:
    design = _design(_columns(), np.zeros(SAMPLES), one_sided=False)
    assert not null_gains(design, (), np.random.default_rng(0)).any()
