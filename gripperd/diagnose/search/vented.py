"""A regulator that vents when it is asked for nothing, whatever its line."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.evidence import evidence
from gripperd.diagnose.search.resting import DECIDED
from gripperd.model.effect import Signal

TELLING = (
    "valve_gain", "valve_nonlinearity", "pressure_sensor_bias", "pressure_sensor_gain",
)  # fmt: skip
"""What may stand beside it. An offset may stand for it, if it is within tolerance."""
NOTHING = 0.01
"""Share of the span below which nothing is asked for. [-]"""


def with_vented_zero(problem: Problem, listed: Sequence[Candidate]) -> Problem:
    """Give the problem with the zero of its regulator suppressed, if that says more.

    How far its line is off within its tolerance does not show there, then.

    Parameters
    ----------
    problem
        Before the search.
    listed
        What could be missing; of it what :data:`TELLING` names is tried beside each.
    """
    regulator = problem.model.regulator
    if regulator is None or Signal.PRESSURE not in problem.signals:
        return problem
    low, high = regulator.pressure_low, regulator.pressure_high
    asked = [regulator.pressure(one.column("current")) for one in problem.courses]
    if not any(np.any(each < low + NOTHING * (high - low)) for each in asked):
        return problem
    few = [one for one in listed if one.name in TELLING]
    vents = replace(problem, model=replace(problem.model, vents=low))
    gained = evidence(vents, few) - evidence(problem, few)
    return vents if gained > DECIDED else problem
