"""Friction in the joints of the linkage, in proportion to the load.

References
----------
.. [1] C. A. Coulomb, "Théorie des machines simples", 1785: friction is in proportion
       to the load.
.. [2] P. R. Dahl, "A solid friction model", Aerospace Corp. TOR-0158(3107-18)-1, 1968:
       friction that turns round over a way, here that of the muscle, or that by which
       its pull winds up the linkage.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from types import MappingProxyType
from typing import ClassVar

import numpy as np

from gripperd.model.effect import Signal
from gripperd.model.kinds import InGripper
from gripperd.model.memory import begin, dahl
from gripperd.model.parameter import amplitude, choice, shape
from gripperd.model.real import Real
from gripperd.model.slip import turned
from gripperd.model.track import Array, Track


class Turning(StrEnum):
    """What turns the friction of joints round."""

    LOAD = "load"
    """The pull as it rises and falls: it winds up the linkage."""
    TRAVEL = "travel"
    """The way of the muscle; on an object that does not yield it stays as it came."""


@dataclass(frozen=True, slots=True)
class LinkageFriction(InGripper):
    r"""The joints keep a share of what they carry.

    .. math:: N = N_0 (1 - \lambda d) - \kappa d F

    with d the direction: some joints carry the grip, some the whole pull of the muscle,
    most of which goes into the return spring. After a reversal the pull has to change
    until the joints slip the other way, or the muscle has to go some way [2]_.
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
    idle: ClassVar[Mapping[str, tuple[str, ...]]] = MappingProxyType(
        {Turning.LOAD: ("distance",), Turning.TRAVEL: ("turn",)}
    )
    travelling: ClassVar[frozenset[str]] = frozenset({Turning.TRAVEL})

    loss: float = amplitude(unit=None, scale=0.05, low=0.0, high=0.9)
    """Share of the grip that is lost closing and won opening. [-]"""

    pull_loss: float = amplitude(unit=None, scale=0.01, low=0.0, high=0.5)
    """Grip force lost per pull of the muscle. [-]"""
    turn: float = shape(
        unit="N", starts=(0.0, 50.0), low=0.0, high=500.0, switches=True
    )
    """Change of the pull over which the joints turn round; 0 for at once. [N]"""
    distance: float = shape(
        unit=None, starts=(0.0, 1e-3), low=0.0, high=4e-3, switches=True
    )
    """Contraction over which they do; 0 for at once. [-]"""
    by: Turning = choice(Turning)  # noqa: RUF009  (declares)
    """What turns them round."""

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

    @property
    def leans(self) -> bool:
        """The way of the load, if that is what turns them."""
        return self.by is Turning.LOAD

    def rest(self) -> Array:
        """A sign that begins with the first travel; none if they turn at once."""
        way = self.turn if self.leans else self.distance
        return begin(4) if way > 0 else begin(0)

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Grip force of each moment. [N]."""
        pull, sign = np.fmax(track.force, 0.0), track.direction
        if memory.size and self.leans:
            sign = self._wound(pull, sign, memory)
        elif memory.size:
            sign = turned(track, self.distance, 0.0, memory[:2])
        return np.asarray(self.transmitted(value, sign) - self.taken(pull, sign))

    def _wound(self, pull: Array, sign: Array, memory: Array) -> Array:
        """Sign of friction that turns with the pull, which is where it was left."""
        if not pull.size:
            return sign
        begun = np.where(np.isnan(memory[2:]), [0.0, pull[0]], memory[2:])
        gone = np.abs(np.diff(pull, prepend=begun[1])) * np.sign(sign)
        way = begun[0] + np.cumsum(gone)
        memory[2:] = way[-1], pull[-1]
        return dahl(way, sign, np.ones_like(pull), self.turn, memory[:2])
