"""A fit and its surroundings, linear: what moves when any of its numbers does."""

from dataclasses import dataclass

import numpy as np

from gripperd.diagnose.fit.polish import Polished, bounds, coefficients, slopes
from gripperd.diagnose.readings.fault import Mask
from gripperd.diagnose.residuals.problem import Problem
from gripperd.model.track import Array


@dataclass(frozen=True)
class Tangent:
    """Columns and targets of a linear fit around a point, whitened, block by block."""

    here: Array
    """Where the fit stands, constants in widths, coordinates in units, ``(k,)``."""
    shapes: Mask
    """Which of the numbers are shapes: their prior has them where they are."""
    low: Array
    """Least of each number, shape ``(k,)``."""
    high: Array
    """Largest."""
    columns: list[Array]
    """Change for one unit of each number, shape ``(n, k)`` each. [-]"""
    targets: list[Array]
    """What the columns have to add up to, shape ``(n,)`` each. [-]"""

    @classmethod
    def at(cls, problem: Problem, fit: Polished) -> "Tangent":
        """Evaluate a problem around a fit."""
        point, coordinates = fit.point, fit.coordinates
        here = coefficients(point, coordinates)
        low, high = bounds(problem, point, coordinates)
        ends = np.cumsum([time.size for time in problem.times])[:-1]
        columns = np.split(slopes(problem, point, coordinates), ends)
        targets = [
            problem.white([residual], index)[:, 0] + columns[index] @ here
            for index, residual in enumerate(problem.residuals(point))
        ]
        plain = [True] * point.shifts.size + [c.is_amplitude for c in coordinates]
        return cls(here, ~np.array(plain), low, high, columns, targets)
