"""Fingers that bend under the grip.

References
----------
.. [1] W. C. Young, R. G. Budynas, "Roark's Formulas for Stress and Strain", 7th ed.,
       McGraw-Hill, 2002: the end of a cantilever moves in proportion to its load.
.. [2] K. L. Johnson, "Contact Mechanics", Cambridge, 1985, section 4.2: a pad gives the
       less the more of it is pressed on.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gripperd.model.effect import Signal
from gripperd.model.kinds import InGripper
from gripperd.model.parameter import amplitude, shape
from gripperd.model.real import Real
from gripperd.model.spring import extension
from gripperd.model.track import Array, Track


@dataclass(frozen=True, slots=True)
class JawCompliance(InGripper):
    r"""The jaws open with the grip.

    .. math:: w = w_0 + \frac{c}{s} \ln(1 + s N)

    In proportion to it where s is 0, as fingers bend [1]_; less and less where pads are
    pressed flat [2]_, see :func:`~gripperd.model.spring.extension`.
    """

    name: ClassVar[str] = "jaw_compliance"
    needs: ClassVar[frozenset[str]] = frozenset({"opening", "contraction", "grip"})
    shows: ClassVar[str] = (
        "the opening is wider than the contraction says, and the more the harder the"
        " grip"
    )
    confused_with: ClassVar[tuple[str, ...]] = ("series_compliance", "length_datum")
    remedy: ClassVar[str] = "stiffen the fingers, or allow for it in the model"

    compliance: float = amplitude(unit="mm_per_N", scale=1e-5, low=0.0, high=1e-3)
    """Opening per grip force of each jaw, while that is small, c. [m/N]"""
    stiffening: float = shape(unit="per_kN", starts=(0.0, 0.02), low=0.0, high=0.2)
    """Share of their stiffness that each newton adds, s. [1/N]"""

    @property
    def signal(self) -> Signal:
        """The opening."""
        return Signal.OPENING

    @property
    def stiffens(self) -> bool:
        """Unless it gives in proportion."""
        return self.stiffening > 0

    def widening(self, grip: Real, pull: Real) -> Real:
        """Opening that the fingers give. [m]."""
        return extension(grip, self.compliance, self.stiffening)

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Opening of each moment; fingers without an object do not bend. [m]."""
        pressing = np.fmax(track.grip, 0.0)
        return np.asarray(value + self.widening(pressing, track.force))
