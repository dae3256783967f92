"""Force lost with the number of inflations.

References
----------
.. [1] B. K. S. Woods, M. F. Gentry, C. S. Kothera, N. M. Wereley, "Fatigue life testing
       of swaged pneumatic artificial muscles as actuators for aerospace applications",
       J. Intell. Mater. Syst. Struct. 23(3), 327-343, 2012.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gripperd.model.kinds import InMuscle
from gripperd.model.parameter import amplitude
from gripperd.model.track import Array, Track

EARLY = 5.0
"""Inflations over which the early loss comes. [-]"""


@dataclass(frozen=True, slots=True)
class Fatigue(InMuscle):
    r"""The pull shrinks from one inflation to the next, at first perhaps faster.

    .. math:: F = F_0 \left[1 - a N - b (1 - e^{-N/5})\right]

    with N inflations since the start of the recording. A prediction knows of none and
    is that of the muscle as it was then.
    """

    name: ClassVar[str] = "fatigue"
    needs: ClassVar[frozenset[str]] = frozenset({"force", "pressure", "contraction"})
    shows: ClassVar[str] = (
        "the force is scaled down, run after run, with the number of inflations and"
        " not with the clock"
    )
    confused_with: ClassVar[tuple[str, ...]] = (
        "force_sensor_drift", "first_cycle", "temperature_stiffness",
    )  # fmt: skip
    remedy: ClassVar[str] = (
        "count the inflations, calibrate again, and change the muscle in time"
    )
    timed: ClassVar[bool] = True

    loss: float = amplitude(unit="per_cycle", scale=0.002, low=0.0, high=0.05)
    """Share of the pull lost in each inflation, a. [-]"""
    early_loss: float = amplitude(unit=None, scale=0.02, low=0.0, high=0.5)
    """Share lost in the first few, b. [-]"""

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Pull that is left. [N]."""
        early = -np.expm1(-track.cycle / EARLY)
        return value * (1 - self.loss * track.cycle - self.early_loss * early)
