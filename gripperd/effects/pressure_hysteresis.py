"""Memory of pressure: at a fixed length the force lags the pressure.

References
----------
.. [1] M. Brokate, J. Sprekels, "Hysteresis and Phase Transitions", Springer, 1996,
       chapter 2: the Prandtl-Ishlinskii operator.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gripperd.model.effect import MuscleState
from gripperd.model.kinds import InMuscle
from gripperd.model.muscle import Muscle
from gripperd.model.parameter import amplitude, shape
from gripperd.model.prandtl import at_rest, begin_at, carried
from gripperd.model.real import Real, positive_part
from gripperd.model.track import Array, Track


@dataclass(frozen=True, slots=True)
class PressureHysteresis(InMuscle):
    r"""Springs over pressure that slip after a third, one and three radii.

    .. math:: F = -H(p) \left(\frac{A(h)}{A(0)}\right)^c

    with H of :func:`gripperd.model.prandtl.carried`: less pull while inflating, more
    while deflating. With ``c = 1`` part of the pressure is lost in the bladder before
    it pulls; with ``c = 0`` the loop is the same at every length.
    """

    name: ClassVar[str] = "pressure_hysteresis"
    needs: ClassVar[frozenset[str]] = frozenset({"force", "pressure", "contraction"})
    shows: ClassVar[str] = (
        "a loop between measured pressure and force at a fixed length, the same at any"
        " speed"
    )
    confused_with: ClassVar[tuple[str, ...]] = (
        "valve_dead_band", "channel_delay", "creep", "series_compliance",
    )  # fmt: skip
    remedy: ClassVar[str] = "always reach a pressure from the same side"
    turns: ClassVar[str] = "pressure"

    near: float = amplitude(unit="N", scale=10.0, low=0.0, high=300.0)
    """Carried at rest length by the spring that slips first. [N]"""
    middle: float = amplitude(unit="N", scale=10.0, low=0.0, high=300.0)
    """Carried there by the next. [N]"""
    far: float = amplitude(unit="N", scale=10.0, low=0.0, high=300.0)
    """Carried there by the one that slips last. [N]"""
    pressure: float = shape(unit="kPa", starts=(30e3, 10e3, 100e3), low=2e3, high=300e3)
    """Change of pressure until the middle spring slips. [Pa]"""
    leverage: float = shape(unit=None, starts=(0.0, 1.0), low=0.0, high=1.0)
    """How far the loop shrinks with the ideal pull, c. [-]"""

    begun: float = shape(unit=None, starts=(0.0,), low=-1.0, high=1.0)
    """Load of the springs where a record begins: 1 as a way there from no pressure
    loads them, -1 the other way. [-]"""
    kept: float = shape(unit=None, starts=(0.0,), low=0.0, high=1.0)
    """Share that a vented muscle keeps of what deflating it has loaded. [-]"""

    def force(self, at: MuscleState, muscle: Muscle) -> Real:
        """What all springs carry once they slip; contracting is inflating. [N]."""
        total = self.near + self.middle + self.far
        return -at.direction * total * self._lever(at.contraction, muscle)

    def rest(self) -> Array:
        """Three springs without load."""
        return at_rest()

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Take what the springs carry. [N]."""
        forces = (self.near, self.middle, self.far)
        # A transmitter may read less than nothing; to be vented is no way up.
        load = self.begun if np.all(track.pressure[:1] > 0) else 0.0
        kept = self.kept if np.all(track.cycle[:1] >= 1) else 0.0
        begin_at(track.pressure, self.pressure, load, memory, kept)
        lost = carried(track.pressure, self.pressure, forces, memory)
        return value - lost * self._lever(track.contraction, track.muscle)

    def _lever(self, contraction: Real, muscle: Muscle) -> Real:
        area = positive_part(muscle.pull_area(contraction))
        return (area / muscle.pull_area(0.0)) ** self.leverage
