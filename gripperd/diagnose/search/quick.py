"""Whether a regulator is as quick as any: a slow one is what its model may lack.

Before anything is known its response time may stand for whatever else the pressure
does. Where all that is explained, a time that no quick regulator takes is a lag.
"""

from collections.abc import Callable
from dataclasses import replace

from gripperd.diagnose.fit.rival import Rival
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.search.found import Found
from gripperd.diagnose.search.step_response import QUICK, RESPONDS
from gripperd.model.effect import Signal

USUAL, OFF = 0.01, 0.006
"""Response time of a quick regulator and one sigma of it, of which 2.6 are the end:
:data:`~gripperd.diagnose.search.step_response.QUICK`. [s]"""


def with_quick_regulator(found: Found, searched: Callable[[Problem], Found]) -> Found:
    """Give the search with a quick regulator, if it names more than with a slow one.

    Asked where the best has a slow one and leaves but noise of the pressure.

    Parameters
    ----------
    found
        The search, with the problem as it was searched.
    searched
        Searches a problem as that was.
    """
    problem = found.problem
    paths = [one.path for one in problem.constants]
    if RESPONDS not in paths or problem.inflation({Signal.PRESSURE}) > 1:
        return found
    place = paths.index(RESPONDS)
    slow = problem.constants[place]
    if slow.value(float(found.best.fit.point.shifts[place])) <= QUICK:
        return found
    quick = list(problem.constants)
    quick[place] = replace(slow, nominal=USUAL, sigma=OFF)
    other = searched(replace(problem, constants=tuple(quick)))
    return other if _effects(other.best) > _effects(found.best) else found


def _effects(rival: Rival) -> frozenset[str]:
    """Names without wrong constants: one takes a little of a lag that has no name."""
    return frozenset(one.name for one in rival.candidates if one.effect is not None)
