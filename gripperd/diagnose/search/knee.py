"""Rubber that was found: whether it saturates sooner than an exponential."""

from dataclasses import replace
from functools import partial

from gripperd.diagnose.fit.polish import polished
from gripperd.diagnose.fit.rival import Rival
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.refined import refined
from gripperd.diagnose.search.resting import DECIDED
from gripperd.diagnose.search.rivalry import Contest
from gripperd.model.elastic_curve import ElasticCurve

SHARP = 0.3
"""Sharpness to begin with: that of a hyperbolic tangent. [-]"""


def with_sharp_knee(found: Found, best: Contest) -> Contest:
    """Let an elastic curve that was found have a sharper knee, if that is likelier.

    Not before it is found: a curve with five numbers follows what creeps as well.

    Parameters
    ----------
    found, best
        The search and its outcome; only how it fits may change, and who fits as well.
    """
    sharp = partial(_sharp, found.problem)
    return refined(found, best, sharp(best.best), sharp)


def _sharp(problem: Problem, rival: Rival) -> Rival:
    """Give it with a sharper knee, or itself."""
    point = rival.fit.point
    for effect in point.effects:
        if isinstance(effect, ElasticCurve) and effect.sharpness == 0:
            point = point.changed(replace(effect, sharpness=SHARP))
    if point is rival.fit.point:
        return rival
    tried = replace(rival, fit=polished(problem, point))
    return tried if tried.evidence > rival.evidence + DECIDED else rival
