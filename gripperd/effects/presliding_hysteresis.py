"""Memory of contraction: strands that bend before they slip on each other.

References
----------
.. [1] T. Vo-Minh, T. Tjahjowidodo, H. Ramon, H. Van Brussel, "A new approach to
       modeling hysteresis in a pneumatic artificial muscle using the Maxwell-slip
       model", IEEE/ASME Trans. Mechatronics 16(1), 177-186, 2011.
.. [2] I. D. Mayergoyz, "Mathematical Models of Hysteresis and Their Applications",
       2nd ed., Elsevier, 2003, chapter 1: Preisach's model.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import ClassVar, Self

import numpy as np

from gripperd.model.effect import MuscleState
from gripperd.model.kinds import InMuscle
from gripperd.model.muscle import Muscle
from gripperd.model.parameter import amplitude, choice, shape
from gripperd.model.prandtl import at_rest, begin_after, begin_at, carried, settled
from gripperd.model.preisach import (
    BARE,
    CLOSEST,
    HELD,
    NARROWEST,
    PARAMETERS,
    Hysteron,
    Relays,
)
from gripperd.model.real import Real
from gripperd.model.track import Array, Track

SHORTEST = 0.006
"""Least way of the middle spring; the near one slips after a third of it. [-]"""
SUDDEN = 0.009
"""Way of the middle spring up to which the near one slips within 0.3 %: as little as a
length is read by, and dry friction turns round over as much. [-]"""
NARROW = 0.01
"""Least half width of relays. A muscle that sticks or snaps at one length has much
narrower ones, close together. [-]"""
MOST = 300.0
"""Most that relays give, either way: a fifth of what a large muscle pulls. [N]"""
AT_ONCE = 0.95
"""Share of all that the near spring carries then, from which the force jumps. [-]"""


@dataclass(frozen=True, slots=True)
class PreslidingHysteresis(InMuscle):
    """Maxwell-slip [1]_: springs that slip after a third, one, three radii; or relays.

    See :func:`gripperd.model.prandtl.carried`. Far from a reversal all slip, and what
    is left is dry friction. The loop of relays [2]_ closes at the ends of their way
    instead, and a curve without a loop may go with them, see
    :class:`gripperd.model.preisach.Relays`.
    """

    name: ClassVar[str] = "presliding_hysteresis"
    needs: ClassVar[frozenset[str]] = frozenset({"force", "pressure", "contraction"})
    shows: ClassVar[str] = (
        "a rounded loop over contraction with minor loops that close, the same at any"
        " speed: the force remembers where the travel turned"
    )
    confused_with: ClassVar[tuple[str, ...]] = (
        "coulomb_friction", "viscous_friction", "creep", "pressure_friction",
        "braid_friction",
    )  # fmt: skip
    remedy: ClassVar[str] = (
        "always approach a grip from the same side, from well beyond the last reversal"
    )
    turns: ClassVar[str] = "contraction"
    one_sided: ClassVar[bool] = True
    idle: ClassVar[Mapping[str, tuple[str, ...]]] = MappingProxyType({
        Hysteron.STOP: PARAMETERS,
        Hysteron.RELAY: ("near", "middle", "far", "contraction"),
    })  # fmt: skip

    near: float = amplitude(unit="N", scale=10.0, low=0.0, high=300.0)
    """Carried by the spring that slips first. [N]"""
    middle: float = amplitude(unit="N", scale=10.0, low=0.0, high=300.0)
    """Carried by the next. [N]"""
    far: float = amplitude(unit="N", scale=10.0, low=0.0, high=300.0)
    """Carried by the one that slips last. [N]"""
    contraction: float = shape(
        unit=None, starts=(0.012, 0.006, 0.03), low=SHORTEST, high=0.1
    )
    """Way of the middle spring from rest until it slips. [-]

    The near one slips after a third of it. Within 0.3 % of contraction that is no
    hysteresis any more but a jump, see ``coulomb_friction``.
    """

    begun: float = shape(unit=None, starts=(0.0,), low=-1.0, high=1.0)
    """Load of the springs where a record begins: 1 as a way there from rest length
    loads them, -1 the other way. [-]"""
    kept: float = shape(unit=None, starts=(0.0,), low=0.0, high=1.0)
    """Share that is left at rest length of what a long way back to it loads. [-]"""

    hysteron: Hysteron = choice(Hysteron)  # noqa: RUF009  (declares)
    """What remembers."""
    relays: float = amplitude(unit="N", scale=10.0, low=-MOST, high=MOST)
    """Given by the relays with all up; their loop loses work if it is positive. [N]"""
    radius: float = shape(unit=None, starts=(0.025,), low=NARROW, high=0.035)
    """Half the width of the narrow ones; no travel switches much wider ones. [-]"""
    width: float = shape(unit=None, starts=(0.5,), low=NARROWEST, high=CLOSEST)
    """The same in scales of their density: much less, and they lie far apart. [-]"""
    wide: float = shape(unit=None, starts=(0.5,), low=0.0, high=1.0)
    """Share of those three times as wide. [-]"""
    centre: float = shape(unit=None, starts=(0.08, 0.16), low=0.0, high=0.3)
    """Mean contraction at which relays switch. [-]"""
    curve: float = shape(unit=None, starts=(0.0, 1.0), low=0.0, high=1.0)
    """Share that is left of the curve they would follow without a loop. [-]"""

    @property
    def becomes(self) -> str:
        """Dry friction, once nearly all slips within 0.3 % of contraction."""
        total = self.near + self.middle + self.far
        jumps = self.near > AT_ONCE * total and self.contraction <= SUDDEN
        slips = self.hysteron is Hysteron.STOP and jumps
        return "coulomb_friction" if slips else ""

    @property
    def is_misnamed(self) -> bool:
        """Something snaps at one length: a fold of the bladder, a cable, a stop.

        Or relays would be narrower yet, and as many more, if they might: that is dry
        friction, which remembers nothing, of another size at every length.
        """
        relays = self._relays
        rubs = relays.is_narrow(NARROW) and abs(self.relays) >= (1 - HELD) * MOST
        return self.hysteron is Hysteron.RELAY and (relays.snaps(NARROW) or rubs)

    @property
    def forgetful(self) -> Self:
        """Relays that fall back where they rose."""
        if self.hysteron is Hysteron.STOP:
            return self
        return replace(self, radius=BARE * self.radius, width=BARE * self.width)

    def force(self, at: MuscleState, muscle: Muscle) -> Real:
        """Of springs after a way from rest or a long way back; of relays, up. [N]."""
        if self.hysteron is Hysteron.STOP:
            springs = (self.near, self.middle, self.far)
            path = at.contraction, at.direction, self.contraction
            return -settled(*path, springs, self.kept)
        return self.relays * self._relays.settled(at.contraction, at.direction)

    def rest(self) -> Array:
        """Three springs without load."""
        return at_rest()

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Take what the springs carry. [N]."""
        if np.isnan(track.came[:1]).all():
            # What was never inflated has not come back from anywhere.
            kept = self.kept if np.all(track.cycle[:1] >= 1) else 0.0
            begin_at(track.contraction, self._reach, self.begun, memory, kept)
        else:
            begin_after(track.contraction, self._reach, track.came[0], memory)
        if self.hysteron is Hysteron.RELAY:
            up = self._relays.up(track.contraction, memory[1:])
            return value + self.relays * up
        springs = (self.near, self.middle, self.far)
        return value - carried(track.contraction, self.contraction, springs, memory)

    @property
    def _reach(self) -> float:
        return self.contraction if self.hysteron is Hysteron.STOP else self.radius

    @property
    def _relays(self) -> Relays:
        return Relays(self.radius, self.width, self.wide, self.centre, self.curve)
