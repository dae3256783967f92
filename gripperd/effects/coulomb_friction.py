"""Dry friction of constant size.

References
----------
.. [1] B. Armstrong-Hélouvry, P. Dupont, C. Canudas de Wit, "A survey of models,
       analysis tools and compensation methods for the control of machines with
       friction", Automatica 30(7), 1083-1138, 1994.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gripperd.model.effect import MuscleState
from gripperd.model.kinds import InMuscle
from gripperd.model.memory import begin
from gripperd.model.muscle import Muscle
from gripperd.model.parameter import amplitude, shape
from gripperd.model.real import Real
from gripperd.model.slip import held, turned
from gripperd.model.track import Array, Track


@dataclass(frozen=True, slots=True)
class CoulombFriction(InMuscle):
    r"""A constant force against the direction of travel.

    .. math:: F = \mp a \min(1, p / p_s)

    Strands that lie loose on a vented muscle rub only as they press: in proportion to
    the pressure up to p_s, far below that of work. After a reversal it turns round over
    a distance too short to be called hysteresis (Dahl's model with exponent 1), and at
    rest it stays. What creeps rubs less, by :func:`gripperd.model.slip.called_up`;
    without a distance nothing is felt at rest.
    """

    name: ClassVar[str] = "coulomb_friction"
    needs: ClassVar[frozenset[str]] = frozenset({"force", "pressure", "contraction"})
    shows: ClassVar[str] = (
        "a loop over contraction of the same width everywhere, with a jump at every"
        " reversal"
    )
    confused_with: ClassVar[tuple[str, ...]] = (
        "presliding_hysteresis", "pressure_friction", "braid_friction",
        "viscous_friction", "force_sensor_bias",
    )  # fmt: skip
    remedy: ClassVar[str] = (
        "look for what rubs on the muscle and its rod, and always approach a grip from"
        " the same side"
    )
    turns: ClassVar[str] = "contraction"

    magnitude: float = amplitude(unit="N", scale=20.0, low=0.0, high=300.0)
    """Of the force. [N]"""
    distance: float = shape(
        unit=None, starts=(0.0, 3e-4, 1e-3), low=0.0, high=2e-3, switches=True
    )
    """Contraction over which it turns round; 0 for at once. [-]"""
    slip: float = shape(
        unit="per_s", starts=(0.0, 3e-3), low=0.0, high=1e-2, switches=True
    )
    """Rate of contraction at which three quarters of it are there; 0 for any. [1/s]"""
    seated: float = shape(
        unit="kPa", starts=(0.0, 20e3), low=0.0, high=60e3, switches=True
    )
    """Pressure from which all of it is there, p_s; 0 for at any. [Pa]"""

    def force(self, at: MuscleState, muscle: Muscle) -> Real:
        """Against contraction while contracting, with it while extending. [N].

        With a distance, at rest, all that the travel before left.
        """
        share = held(at.rate, self.distance, self.slip)
        return -at.direction * self._size(at.pressure) * share

    def kinks(
        self, contraction: Real, diameter_ratio: Real, muscle: Muscle
    ) -> tuple[Real, ...]:
        """Where it begins, and where it is seated. [Pa]."""
        ends = (0.0, self.seated) if self.seated > 0 else ()
        return tuple(0.0 * contraction + end for end in ends)

    def rest(self) -> Array:
        """A sign that begins with the first travel."""
        return begin(2)

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Take off the friction of each moment. [N]."""
        sign = turned(track, self.distance, self.slip, memory)
        return np.asarray(value - self._size(track.pressure) * sign)

    def _size(self, pressure: Real) -> Real:
        if not self.seated > 0:
            return self.magnitude
        return self.magnitude * np.clip(pressure / self.seated, 0.0, 1.0)
