"""Lost motion between muscle and jaws.

References
----------
.. [1] G. Tao, P. V. Kokotovic, "Adaptive Control of Systems with Actuator and Sensor
       Nonlinearities", Wiley, 1996: backlash.
.. [2] M. Brokate, J. Sprekels, "Hysteresis and Phase Transitions", Springer, 1996,
       section 2.3: play.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gripperd.model.effect import Signal
from gripperd.model.kinds import InGripper
from gripperd.model.memory import begin, play
from gripperd.model.parameter import amplitude, shape
from gripperd.model.track import Array, Track

AT_REST = 0.01
"""Contraction from which a way there was one of closing jaws. [-]"""
PRESSING = 5.0
"""Grip that moves the jaws through the gap, beyond what they rub and weigh. [N]"""


@dataclass(frozen=True, slots=True)
class LinkageBacklash(InGripper):
    """Play of half the width on the opening.

    An object that is gripped holds the jaws to the side to which they close, so that
    they lose no motion until they let go.
    """

    name: ClassVar[str] = "linkage_backlash"
    needs: ClassVar[frozenset[str]] = frozenset({"opening", "contraction"})
    shows: ClassVar[str] = (
        "when the muscle turns round the jaws stand still for a while, so that the"
        " opening differs closing and opening by a constant"
    )
    confused_with: ClassVar[tuple[str, ...]] = ("channel_delay", "linkage_friction")
    remedy: ClassVar[str] = "take up the play in the joints, or preload them"
    turns: ClassVar[str] = "contraction"

    width: float = amplitude(unit="mm", scale=0.3e-3, low=0.0, high=20e-3)
    """Opening lost at a reversal. [m]"""
    begun: float = shape(unit=None, starts=(0.0,), low=-1.0, high=1.0)
    """Where in the gap a record begins at a contraction: 0 in its middle, 1 on the side
    to which closing to it went, -1 on the other. [-]"""
    parked: float = shape(unit=None, starts=(0.0,), low=-1.0, high=1.0)
    """The same at rest length, 1 on the side to which opening to it went. [-]

    There nothing has to pull any more: jaws that were pushed open by hand, or by their
    own spring, lie on the other.
    """

    closed: float = shape(unit=None, starts=(0.0, 1.0), low=0.0, high=1.0)
    """Share of the gap that a grip closes. [-]"""

    @property
    def signal(self) -> Signal:
        """The opening."""
        return Signal.OPENING

    def rest(self) -> Array:
        """A play that has not begun."""
        return begin()

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Opening behind the gap. [m]."""
        if np.isnan(memory[0]) and value.size:
            away = min(max(track.contraction[0] / AT_REST, 0.0), 1.0)
            side = away * self.begun - (1 - away) * self.parked
            memory[0] = value[0] + side * self.width / 2
        half, pressed = self.width / 2, self.closed * (track.grip > PRESSING)
        free = np.asarray((1 - pressed) * half, np.float64)
        return play(value + pressed * half, free, memory)
