"""Which explanations are fitted in full: those that a linear fit ranks first."""

from collections.abc import Mapping, Sequence
from itertools import combinations

import numpy as np

from gripperd.diagnose.fit.design import Design, Member
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.price import acts_on
from gripperd.diagnose.side_by_side import side_by_side
from gripperd.model.effect import Signal

FINALISTS = 4
"""Singles, and as many pairs."""


def leaders(singles: Mapping[Member, float]) -> list[Member]:
    """Give the best form of each kind, best first.

    Parameters
    ----------
    singles
        Gain of each form on its own. [nat]
    """
    found: dict[tuple[str, ...], Member] = {}
    for member in sorted(singles, key=lambda one: -singles[one]):
        found.setdefault(member.candidate.kind, member)
    return list(found.values())


def finalists(
    problem: Problem, around: Design, singles: Mapping[Member, float], *, thrifty: bool
) -> list[tuple[Member, ...]]:
    """Best singles, or all of them, and best pairs by the linear fit.

    Parameters
    ----------
    problem, around
        The recording and the model, and all that is linear around a point of it.
    singles
        Gain of each candidate on its own. [nat]
    thrifty
        Whether to hear but the best singles.
    """
    best = leaders(singles)
    if not best:
        return []
    # A threshold makes the linear rank of some unfair to them: known doubles of the
    # leader are heard as well, and what it may be in other words.
    doubles = {best[0].candidate.name, *best[0].candidate.doubles}
    late = [one for one in best[FINALISTS:] if one.candidate.name in doubles]
    first = heard(problem, singles, [(one,) for one in best], FINALISTS)
    alone = (
        [*first, *((one,) for one in late)]
        if thrifty
        else [(one,) for one in around.members]
    )
    # Two forms of one name are no pair: the second takes the place of the first.
    couples = [
        (one, other)
        for one, other in combinations(best, 2)
        if one.candidate.name != other.candidate.name
    ]
    evidence = side_by_side(
        lambda pair: around.fit(*pair).evidence, couples, problem.processes
    )
    order = np.argsort(-np.array(evidence), kind="stable")
    pairs = [couples[place] for place in order]
    return [*alone, *heard(problem, singles, pairs, FINALISTS)]


def heard(
    problem: Problem,
    singles: Mapping[Member, float],
    ranked: Sequence[tuple[Member, ...]],
    most: int,
) -> list[tuple[Member, ...]]:
    """Give the first few; where misfit counts, the first of each stage as well.

    There one signal may be so loud that no other would have its say. What gains nothing
    on its own has none.

    Parameters
    ----------
    problem
        The recording and the model.
    singles
        Gain of each candidate on its own. [nat]
    ranked
        Sets of candidates, best first.
    most
        How many are the first few.
    """
    found = list(ranked[:most])
    if problem.is_inflated:
        met = {_signals(problem, members) for members in found}
        for members in ranked[most:]:
            signals = _signals(problem, members)
            if signals not in met and all(singles[one] > 0 for one in members):
                met.add(signals)
                found.append(members)
    return found


def _signals(problem: Problem, members: Sequence[Member]) -> frozenset[Signal]:
    return frozenset().union(*(acts_on(problem, one.candidate) for one in members))
