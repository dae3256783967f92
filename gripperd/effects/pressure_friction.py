"""Dry friction that grows with a power of pressure, beyond eq. (6).

References
----------
.. [1] B. Tondu, "Modelling of the McKibben artificial muscle: a review", J. Intell.
       Mater. Syst. Struct. 23(3), 225-253, 2012: textile friction grows less than
       proportionally with the load.
.. [2] P. R. Dahl, "Solid friction damping of mechanical vibrations", AIAA J. 14(12),
       1675-1682, 1976.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gripperd.model.effect import MuscleState
from gripperd.model.kinds import InMuscle
from gripperd.model.memory import begin
from gripperd.model.muscle import Muscle
from gripperd.model.parameter import amplitude, shape
from gripperd.model.real import Real, positive_part
from gripperd.model.slip import held, turned
from gripperd.model.track import Array, Track

WORKING_PRESSURE = 300e3
"""Gauge pressure at which the friction has its amplitude. [Pa]"""


@dataclass(frozen=True, slots=True)
class PressureFriction(InMuscle):
    r"""A force against the direction of travel, with strands that press harder.

    .. math:: F = \mp a \left(\frac{p}{300 kPa}\right)^b, \quad p \ge 0

    times :func:`gripperd.model.slip.called_up`, where what creeps rubs less. After a
    reversal it turns round over a distance too short to be called hysteresis [2]_, and
    at rest it stays; without a distance nothing is felt at rest.
    """

    name: ClassVar[str] = "pressure_friction"
    needs: ClassVar[frozenset[str]] = frozenset({"force", "pressure", "contraction"})
    shows: ClassVar[str] = (
        "a loop over contraction that is wider at higher pressure and closes in a"
        " vented muscle"
    )
    confused_with: ClassVar[tuple[str, ...]] = (
        "coulomb_friction", "braid_friction", "presliding_hysteresis",
    )  # fmt: skip
    remedy: ClassVar[str] = "always approach a grip from the same side"
    turns: ClassVar[str] = "contraction"
    basis: ClassVar[str] = "braid_friction"

    magnitude: float = amplitude(unit="N", scale=20.0, low=0.0, high=300.0)
    """Friction at 300 kPa, a. [N]"""
    exponent: float = shape(unit=None, starts=(1.0, 0.5, 0.75, 1.5), low=0.3, high=2.0)
    """Power of pressure, b. [-]"""
    distance: float = shape(
        unit=None, starts=(0.0, 3e-4, 1e-3), low=0.0, high=2e-3, switches=True
    )
    """Contraction over which it turns round; 0 for at once. [-]"""
    slip: float = shape(
        unit="per_s", starts=(0.0, 3e-3), low=0.0, high=1e-2, switches=True
    )
    """Rate of contraction at which three quarters of it are there; 0 for any. [1/s]"""

    @property
    def affine(self) -> bool:
        """Only when it is proportional to pressure."""
        return self.exponent == 1

    def force(self, at: MuscleState, muscle: Muscle) -> Real:
        """Against contraction while contracting, with it while extending. [N].

        With a distance, at rest, all that the travel before left.
        """
        share = held(at.rate, self.distance, self.slip)
        return -at.direction * self._size(at.pressure) * share

    def kinks(
        self, contraction: Real, diameter_ratio: Real, muscle: Muscle
    ) -> tuple[Real, ...]:
        """Where the muscle is vented. [Pa]."""
        return (0.0 * contraction,)

    def rest(self) -> Array:
        """A sign that begins with the first travel; none if it turns at once."""
        return begin(2) if self.distance > 0 else begin(0)

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Take off the friction of each moment. [N]."""
        if not memory.size:
            return np.asarray(value + self.force(track.state, track.muscle))
        sign = turned(track, self.distance, self.slip, memory)
        return np.asarray(value - self._size(track.pressure) * sign)

    def _size(self, pressure: Real) -> Real:
        load = positive_part(pressure) / WORKING_PRESSURE
        return self.magnitude * load**self.exponent
