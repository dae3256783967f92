"""Whether the readings bear out the loop of what is called a hysteresis."""

import numpy as np

from gripperd.diagnose.fit.rival import Rival
from gripperd.diagnose.residuals.problem import Problem

SEEN = 13.0
"""By how much likelier the readings are with a loop than with its curve alone. [nat]"""


def shows_its_loop(problem: Problem, rival: Rival) -> bool:
    """Tell whether each of its effects needs the memory that it is named for.

    Relays follow a curve, which may be all that there is.

    Parameters
    ----------
    problem
        The recording and the model.
    rival
        The explanation that was fitted.
    """
    point, known = rival.fit.point, sum(rival.fit.misfits.values())
    for effect in point.effects:
        bare = effect.forgetful
        if bare is effect:
            continue
        residuals = problem.residuals(point.with_effect(bare))
        white = [problem.white([left], i) for i, left in enumerate(residuals)]
        if sum(float(np.sum(one**2)) for one in white) < known + 2 * SEEN:
            return False
    return True
