"""Tolerances that are stated too tight: several constants at once lie beyond theirs."""

from dataclasses import replace

from gripperd.diagnose.fit.candidates import WRONG, Candidate
from gripperd.diagnose.fit.polish import Polished, polished
from gripperd.diagnose.fit.rival import Rival
from gripperd.diagnose.residuals.constants import TOLERATED
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.rivalry import SURE, Contest, Place

THIRD = 3.0
"""How much too tight a stated tolerance may be: a limit is often taken for three sigma,
and parts lie anywhere within. [-]"""
SEVERAL = 2
"""Constants beyond their tolerance that speak of the tolerances, not of one part."""


def with_usual_tolerances(found: Found, best: Contest) -> Contest:
    """Let constants alone explain what effects do, if parts as usual can.

    Held by tolerances that are too tight, constants leave a misfit that any effect of
    a similar form takes up. Parts no better than they are made leave none.

    Parameters
    ----------
    found, best
        The search and its outcome.
    """
    problem, here = found.problem, best.best
    usual = tuple(
        min(max(one.usual / one.sigma, 1.0), THIRD) for one in problem.constants
    )
    if not here.candidates or max(usual) == 1:
        return best
    start = replace(found.null.fit.point, looser=usual)
    rival = _beyond(problem, polished(problem, start))
    count = len(rival.candidates)
    # Here nobody pays for how far parts are off: the question is whether one is alone.
    lead = rival.evidence - here.evidence - here.fit.point.surprise
    # Those and more are no better an answer than those alone.
    least = 0.0 if set(here.names) < set(rival.names) else -SURE
    if count < SEVERAL or lead < least:
        return best
    alike = (here,) if lead <= SURE and here.names[0] not in rival.names else ()
    # They go together: none of them is an explanation without the others.
    others = (Place(found.null),) * (count - 1)
    return Contest(rival, (Place(found.null, alike), *others))


def _beyond(problem: Problem, fit: Polished) -> Rival:
    """Call wrong what lies beyond a stated tolerance, the furthest first."""
    sizes = dict(enumerate(abs(fit.point.shifts).tolist()))
    wrong = [
        index
        for index in sorted(sizes, key=lambda one: -sizes[one])
        if sizes[index] > TOLERATED and fit.point.looser[index] > 1
    ]
    point = replace(fit.point, freed=frozenset(wrong))
    return Rival(
        tuple(Candidate(WRONG + problem.constants[i].path, None, i) for i in wrong),
        replace(fit, point=point),
    )
