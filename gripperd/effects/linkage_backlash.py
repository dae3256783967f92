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

from gripperd.model.effect import Signal
from gripperd.model.kinds import InGripper
from gripperd.model.memory import begin, play
from gripperd.model.parameter import amplitude
from gripperd.model.track import Array, Track


@dataclass(frozen=True, slots=True)
class LinkageBacklash(InGripper):
    """Play of half the width on the opening; it begins in the middle of the gap."""

    name: ClassVar[str] = "linkage_backlash"
    needs: ClassVar[frozenset[str]] = frozenset({"opening", "contraction"})
    shows: ClassVar[str] = (
        "when the muscle turns round the jaws stand still for a while, so that the"
        " opening differs closing and opening by a constant"
    )
    confused_with: ClassVar[tuple[str, ...]] = ("channel_delay", "linkage_friction")
    remedy: ClassVar[str] = "take up the play in the joints, or preload them"

    width: float = amplitude(unit="mm", scale=0.3e-3, low=0.0, high=20e-3)
    """Opening lost at a reversal. [m]"""

    @property
    def signal(self) -> Signal:
        """The opening."""
        return Signal.OPENING

    def rest(self) -> Array:
        """A play that has not begun."""
        return begin()

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Opening behind the gap. [m]."""
        return play(value, self.width / 2, memory)
