"""How a recording is read, where it leaves a choice: decided before the search."""

from collections.abc import Sequence

from gripperd.diagnose.fit.candidates import Candidate
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.dead_band import with_dead_band
from gripperd.diagnose.search.resting import with_resting_sign
from gripperd.diagnose.search.shut import with_valve_shut


def as_read(problem: Problem, listed: Sequence[Candidate]) -> Problem:
    """Give the problem as the data support it, by evidence.

    Which way friction acts at rest, whether the regulator sleeps within a band, and
    which holds its valve was shut in.

    Parameters
    ----------
    problem
        Before the search.
    listed
        What could be missing.
    """
    for reading in (with_resting_sign, with_dead_band, with_valve_shut):
        problem = reading(problem, listed)
    return problem
