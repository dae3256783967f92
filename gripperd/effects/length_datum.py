"""Wrong zero of the contraction.

References
----------
.. [1] JCGM 200:2012 (VIM), 4.20: instrumental bias.
"""

from dataclasses import dataclass
from typing import ClassVar

from gripperd.model.effect import Signal
from gripperd.model.kinds import InSensor
from gripperd.model.parameter import amplitude
from gripperd.model.track import Array, Track


@dataclass(frozen=True, slots=True)
class LengthDatum(InSensor):
    r"""The contraction is told from a wrong zero: :math:`h_r = h + s`.

    A rest length that was taken wrongly shifts it so near rest; by the ratio of both
    lengths less, the shorter the muscle is.
    """

    name: ClassVar[str] = "length_datum"
    needs: ClassVar[frozenset[str]] = frozenset({"contraction"})
    shows: ClassVar[str] = (
        "all curves are shifted along the contraction, so that the force is off by its"
        " slope, and the opening by a constant"
    )
    confused_with: ClassVar[tuple[str, ...]] = (
        "rubber_elasticity",
        "series_compliance",
    )
    remedy: ClassVar[str] = "measure the length of the vented, unloaded muscle again"

    shift: float = amplitude(unit=None, scale=0.003, low=-0.1, high=0.1)
    """Reading minus truth. [-]"""

    @property
    def signal(self) -> Signal:
        """The contraction."""
        return Signal.CONTRACTION

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Reading of a contraction. [-]."""
        return value + self.shift

    def truth(self, reading: Array, track: Track) -> Array:
        """Contraction behind a reading. [-]."""
        return reading - self.shift
