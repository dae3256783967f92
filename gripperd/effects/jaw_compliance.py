"""Fingers that bend under the grip.

References
----------
.. [1] W. C. Young, R. G. Budynas, "Roark's Formulas for Stress and Strain", 7th ed.,
       McGraw-Hill, 2002: the end of a cantilever moves in proportion to its load.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gripperd.model.effect import Signal
from gripperd.model.kinds import InGripper
from gripperd.model.parameter import amplitude
from gripperd.model.real import Real
from gripperd.model.track import Array, Track


@dataclass(frozen=True, slots=True)
class JawCompliance(InGripper):
    r"""The jaws open in proportion to the grip: :math:`w = w_0 + c N`."""

    name: ClassVar[str] = "jaw_compliance"
    needs: ClassVar[frozenset[str]] = frozenset({"opening", "contraction", "grip"})
    shows: ClassVar[str] = (
        "the opening is wider than the contraction says, in proportion to the grip"
    )
    confused_with: ClassVar[tuple[str, ...]] = ("series_compliance", "length_datum")
    remedy: ClassVar[str] = "stiffen the fingers, or allow for it in the model"

    compliance: float = amplitude(unit="mm_per_N", scale=1e-5, low=0.0, high=1e-3)
    """Opening per grip force of each jaw. [m/N]"""

    @property
    def signal(self) -> Signal:
        """The opening."""
        return Signal.OPENING

    def widening(self, grip: Real, pull: Real) -> Real:
        """Opening that the fingers give. [m]."""
        return self.compliance * grip

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Opening of each moment; fingers without an object do not bend. [m]."""
        pressing = np.fmax(track.grip, 0.0)
        return np.asarray(value + self.widening(pressing, track.force))
