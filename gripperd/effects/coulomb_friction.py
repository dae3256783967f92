"""Dry friction of constant size.

References
----------
.. [1] B. Armstrong-Hélouvry, P. Dupont, C. Canudas de Wit, "A survey of models,
       analysis tools and compensation methods for the control of machines with
       friction", Automatica 30(7), 1083-1138, 1994.
"""

from dataclasses import dataclass
from typing import ClassVar

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
    """A constant force against the direction of travel.

    After a reversal it turns round over a distance too short to be called hysteresis
    (Dahl's model with exponent 1), and at rest it stays. What creeps rubs less, by
    :func:`gripperd.model.slip.called_up`; without a distance nothing is felt at rest.
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
        unit=None, starts=(0.0, 1e-3), low=0.0, high=2e-3, switches=True
    )
    """Contraction over which it turns round; 0 for at once. [-]"""
    slip: float = shape(
        unit="per_s", starts=(0.0, 3e-3), low=0.0, high=1e-2, switches=True
    )
    """Rate of contraction at which three quarters of it are there; 0 for any. [1/s]"""

    def force(self, at: MuscleState, muscle: Muscle) -> Real:
        """Against contraction while contracting, with it while extending. [N].

        With a distance, at rest, all that the travel before left.
        """
        share = held(at.rate, self.distance, self.slip)
        return -at.direction * self.magnitude * share

    def rest(self) -> Array:
        """A sign that begins with the first travel."""
        return begin(2)

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Take off the friction of each moment. [N]."""
        sign = turned(track, self.distance, self.slip, memory)
        return value - self.magnitude * sign
