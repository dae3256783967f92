"""Friction in the joints of the linkage, in proportion to the load.

References
----------
.. [1] C. A. Coulomb, "Théorie des machines simples", 1785: friction is in proportion
       to the load.
.. [2] P. R. Dahl, "A solid friction model", Aerospace Corp. TOR-0158(3107-18)-1, 1968:
       friction that turns round over a way, here that by which the pull winds up the
       linkage.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gripperd.model.effect import Signal
from gripperd.model.kinds import InGripper
from gripperd.model.memory import begin, dahl
from gripperd.model.parameter import amplitude, shape
from gripperd.model.real import Real
from gripperd.model.track import Array, Track


@dataclass(frozen=True, slots=True)
class LinkageFriction(InGripper):
    r"""The joints keep a share of what they carry.

    .. math:: N = N_0 (1 - \lambda d) - \kappa d F

    with d the direction: some joints carry the grip, some the whole pull of the muscle,
    most of which goes into the return spring. After a reversal the pull has to change
    until the joints slip the other way [2]_.
    """

    name: ClassVar[str] = "linkage_friction"
    needs: ClassVar[frozenset[str]] = frozenset({"grip", "force", "contraction"})
    shows: ClassVar[str] = (
        "at the same pull of the muscle the grip is weaker closing and stronger"
        " opening, in proportion to it"
    )
    confused_with: ClassVar[tuple[str, ...]] = ("linkage_backlash", "coulomb_friction")
    remedy: ClassVar[str] = "grease or replace the joints of the jaws"
    turns: ClassVar[str] = "contraction"

    loss: float = amplitude(unit=None, scale=0.05, low=0.0, high=0.9)
    """Share of the grip that is lost closing and won opening. [-]"""

    pull_loss: float = amplitude(unit=None, scale=0.01, low=0.0, high=0.5)
    """Grip force lost per pull of the muscle. [-]"""
    turn: float = shape(
        unit="N", starts=(0.0, 50.0), low=0.0, high=500.0, switches=True
    )
    """Change of the pull over which the joints turn round; 0 for at once. [N]"""

    @property
    def signal(self) -> Signal:
        """The grip."""
        return Signal.GRIP

    def transmitted(self, grip: Real, direction: Real) -> Real:
        """Grip force behind the joints. [N]."""
        return grip * (1 - self.loss * direction)

    def taken(self, pull: Real, direction: Real) -> Real:
        """Grip force that joints take which carry the pull. [N]."""
        return self.pull_loss * direction * pull

    def rest(self) -> Array:
        """A sign that begins with the first travel; none if they turn at once."""
        return begin(4) if self.turn > 0 else begin(0)

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Grip force of each moment. [N]."""
        pull, sign = np.fmax(track.force, 0.0), track.direction
        if self.turn > 0 and pull.size:
            # The way of the pull, and the pull, go on from where the last call ended.
            begun = np.where(np.isnan(memory[2:]), [0.0, pull[0]], memory[2:])
            gone = np.abs(np.diff(pull, prepend=begun[1])) * np.sign(sign)
            way = begun[0] + np.cumsum(gone)
            sign = dahl(way, sign, np.ones_like(pull), self.turn, memory[:2])
            memory[2:] = way[-1], pull[-1]
        return np.asarray(self.transmitted(value, sign) - self.taken(pull, sign))
