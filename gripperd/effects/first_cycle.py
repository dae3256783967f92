"""First inflation after a rest: rubber that has yet to soften and to settle.

References
----------
.. [1] L. Mullins, "Softening of rubber by deformation", Rubber Chem. Technol. 42(1),
       339-362, 1969.
.. [2] R. W. Ogden, D. G. Roxburgh, "A pseudo-elastic model for the Mullins effect in
       filled rubber", Proc. R. Soc. A 455(1988), 2861-2877, 1999: what was reached
       once is softer ever after.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gripperd.model.kinds import InMuscle
from gripperd.model.parameter import amplitude, shape
from gripperd.model.track import Array, Track

REFERENCE = 100e3
"""Pressure that the softening refers to. [Pa]"""
PERCENT = 0.01
"""Contraction that it refers to. [-]"""


@dataclass(frozen=True, slots=True)
class FirstCycle(InMuscle):
    r"""The pull of a first inflation differs by a share and by a force.

    .. math:: F = F_0 + w \left(1 - s \frac{p_m - p}{100\,\mathrm{kPa}}
              - e \frac{h_m - h}{1\,\%}\right)^+
              \left(a F_0 + b + c F_0 \frac{p_m}{100\,\mathrm{kPa}}\right)

    with the highest pressure and contraction so far, p_m and h_m: rubber that has been
    there is soft already, and where it was most strained the curve of virgin rubber
    meets that of soft rubber.
    What is first depends on what undoes the softening: with ``after = 0`` it never
    comes back, and ``w = 1`` in the first inflation of the recording alone; with
    ``after = 1`` a pause is enough, and ``w = 1`` in the first sweep of every row of
    repeats. Between them the two count in proportion. A prediction is that of a
    muscle that has been inflated before.
    """

    name: ClassVar[str] = "first_cycle"
    needs: ClassVar[frozenset[str]] = frozenset({"force", "pressure", "contraction"})
    shows: ClassVar[str] = (
        "the first inflation differs from the same sweep run again, and no later one"
        " does"
    )
    confused_with: ClassVar[tuple[str, ...]] = ("fatigue", "creep")
    remedy: ClassVar[str] = "inflate the muscle a few times before work"
    timed: ClassVar[bool] = True

    gain: float = amplitude(unit=None, scale=0.05, low=-1.0, high=1.0)
    """Share of the pull that the first has on top, a. [-]"""
    offset: float = amplitude(unit="N", scale=10.0, low=-1e3, high=1e3)
    """Force that the first has on top, b. [N]"""
    growth: float = amplitude(unit=None, scale=0.01, low=-0.3, high=0.3)
    """Change of that share for each 100 kPa reached, c. [-]"""
    after: float = shape(unit=None, starts=(0.0, 1.0), low=0.0, high=1.0)
    """Whether the rest before a row of repeats makes its first sweep a first. [-]"""
    softened: float = shape(unit=None, starts=(0.0, 2.0), low=0.0, high=20.0)
    """Share of it that a fall by 100 kPa ends, s; with none its deflation counts as
    well. [-]"""
    eased: float = shape(unit=None, starts=(0.0, 2.0), low=0.0, high=20.0)
    """Share of it that a return by 1 % of contraction ends, e. [-]"""

    def rest(self) -> Array:
        """Never inflated, never contracted."""
        return np.full(2, -np.inf)

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Pull with what the first inflation has on top. [N]."""
        reached = np.fmax.accumulate(np.fmax(track.pressure, memory[0]))
        shortest = np.fmax.accumulate(np.fmax(track.contraction, memory[1]))
        memory[:] = reached[-1], shortest[-1]
        fallen = (reached - track.pressure) / REFERENCE
        returned = (shortest - track.contraction) / PERCENT
        left = np.maximum(1 - self.softened * fallen - self.eased * returned, 0.0)
        ever = np.where(track.cycle < 1, 1 - self.after, 0.0)
        row = np.where(track.repeat == 0, self.after, 0.0)
        share = self.gain + self.growth * reached / REFERENCE
        return value + (ever + row) * left * (share * value + self.offset)
