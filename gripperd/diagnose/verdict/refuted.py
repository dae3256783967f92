"""Whether sweeps that were left out speak against a name.

A name that is right foretells them better by what it changes there: by the sum D of the
squares of that change, in noise, give or take twice the root of D. One that fitted
what it was shown and no more makes them as much worse. What changes little there is
neither borne out nor refuted.

References
----------
.. [1] Q. H. Vuong, "Likelihood ratio tests for model selection and non-nested
       hypotheses", Econometrica 57(2), 307-333, 1989.
"""

from collections.abc import Sequence
from dataclasses import replace

from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.residuals.holdout import Split
from gripperd.diagnose.residuals.point import Point
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.belief import least
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.needed import without_each
from gripperd.diagnose.search.rivalry import Contest, Place, contest
from gripperd.diagnose.verdict.initial_state import with_fitted_state

TELLING = 20.0
"""Squares of the noise by which a name changes what was left out, from which that can
speak: four standard deviations of what noise makes of it. [-]"""
AGAINST = 0.25
"""Share of them by which it is worse with the name. On two rigs nobody here had seen 1
of 201 right names made it so, and 18 of 56 that were wrong. [-]"""


def without_refuted(
    parts: Split,
    inside: Problem,
    found: Found,
    best: Contest,
    listed: Sequence[Candidate],
) -> Contest:
    """Tell no more what was left out speaks against, as long as something else is told.

    That is what fits as well in its place, if nothing speaks against it: the sweeps
    left out have told the two apart. Else what stands beside a name that is wrong need
    not be wrong itself: it is fitted and challenged anew.

    Parameters
    ----------
    parts, inside, found, best
        As of :func:`refuted`.
    listed
        What could be missing.
    """
    while names := refuted(parts, inside, found, best):
        if other := _instead(parts, inside, found, best, names):
            return other
        if len(best.best.candidates) == 1:
            break
        without = [
            place.without
            for name, place in zip(best.best.names, best.places, strict=True)
            if name in names
        ]
        rest = max(without, key=lambda one: one.evidence)
        # Beside what is gone it may have been believed for less than it needs alone.
        if rest.evidence - found.null.evidence <= least(found.problem, rest.candidates):
            rest = found.null
        best = contest(replace(found, best=rest), listed)
    return best


def _instead(
    parts: Split, inside: Problem, found: Found, best: Contest, names: tuple[str, ...]
) -> Contest | None:
    """Give the likeliest that fits as well and that what was left out bears out."""
    rivals = [
        rival
        for name, place in zip(best.best.names, best.places, strict=True)
        if name in names
        for rival in place.rivals
    ]
    for rival in sorted(rivals, key=lambda one: -one.evidence):
        bare = without_each(found.problem, rival)
        other = replace(best, best=rival, places=tuple(map(Place, bare)))
        if not refuted(parts, inside, found, other):
            return other
    return None


def refuted(
    parts: Split, inside: Problem, found: Found, best: Contest
) -> tuple[str, ...]:
    """Names that what was left out speaks against.

    Parameters
    ----------
    parts
        What was searched, and what was not.
    inside
        Of the latter what lies within the former.
    found, best
        The search and its outcome.
    """
    # Misfit that no explanation reaches is noise here as it was in the search.
    test = replace(inside, noises=found.problem.noises)
    told = with_fitted_state(parts, best.best.fit.point)
    names = []
    for candidate, place in zip(best.best.candidates, best.places, strict=True):
        # Far above the noise one constant stands in for another.
        if candidate.effect is None and found.problem.is_inflated:
            continue
        without = with_fitted_state(parts, place.without.fit.point)
        changed, gained = _compared(test, without, told)
        if changed > TELLING and gained < -AGAINST * changed:
            names.append(candidate.name)
    return tuple(names)


def _compared(test: Problem, without: Point, told: Point) -> tuple[float, float]:
    """Sum of squares of the change, and by how much less is left with it. [-]."""
    changed, gained = 0.0, 0.0
    pairs = zip(test.residuals(without), test.residuals(told), strict=True)
    for index, pair in enumerate(pairs):
        before, after = test.white(pair, index).T
        changed += float((before - after) @ (before - after))
        gained += float(before @ before - after @ after)
    return changed, gained
