"""Ranges of sensors: a sound one is off by a share of its own, wherever it reads."""

from gripperd.diagnose.residuals.problem import Problem
from gripperd.model.effect import Signal


def ranges(problem: Problem) -> dict[Signal, float]:
    """Full scale of each signal, and of the reading that it is foretold from. [SI].

    An opening follows a length that goes far beyond it in sweeps without jaws, and a
    grip a force of which the spring takes a large part: as far as those are off, they
    seem to be.

    Parameters
    ----------
    problem
        The sweeps.
    """
    found, linkage = dict(problem.full_scale), problem.model.linkage
    if linkage is None:
        return found
    if Signal.OPENING in found:
        furthest = problem.highest.get(Signal.CONTRACTION, 0.0)
        length = problem.model.muscle.rest_length
        closed = float(linkage.opening(furthest, length))
        found[Signal.OPENING] += linkage.open_width - closed
    if Signal.GRIP in found:
        found[Signal.GRIP] += found.get(Signal.FORCE, 0.0) / linkage.ratio
    return found
