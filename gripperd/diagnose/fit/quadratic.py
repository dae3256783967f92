"""What a cost would be around a point, were everything linear in its numbers.

References
----------
.. [1] D. W. Marquardt, "An algorithm for least-squares estimation of nonlinear
       parameters", J. SIAM 11(2), 431-441, 1963.
"""

from typing import NamedTuple

import numpy as np

from gripperd.diagnose.fit.gram import bounded
from gripperd.model.track import Array


class Quadratic(NamedTuple):
    """A cost by its slope and its curvature at a point. [-]."""

    here: Array
    """Numbers of the point, shape ``(k,)``."""
    matrix: Array
    """Half of its second derivatives there, shape ``(k, k)``."""
    pull: Array
    """Half of how steeply it falls there, shape ``(k,)``."""

    def lowest(self, damping: float, low: Array, high: Array) -> Array:
        """Where it is least within limits, were its diagonal larger by a share [1]_."""
        damped = self.matrix + damping * np.diag(np.diag(self.matrix))
        goal = self.pull + damped @ self.here
        return bounded(damped, goal, low, high, self.here)

    def fall(self, aim: Array) -> float:
        """By how much it is less there than here. [-]."""
        way = aim - self.here
        return float(2 * self.pull @ way - way @ self.matrix @ way)
