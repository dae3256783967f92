"""A frame, cable or tendon that stretches under the pull of the muscle.

References
----------
.. [1] G. A. Pratt, M. M. Williamson, "Series elastic actuators", Proc. IEEE/RSJ IROS,
       1995, 399-406: motion lost in a spring between actuator and load.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from types import MappingProxyType
from typing import ClassVar

import numpy as np

from gripperd.model.effect import Signal
from gripperd.model.kinds import InGripper
from gripperd.model.parameter import amplitude, choice, shape
from gripperd.model.real import Real
from gripperd.model.spring import extension
from gripperd.model.track import Array, Track


class Measured(StrEnum):
    """What the length that is told takes in."""

    OUTSIDE = "outside"
    """The stretch as well: the muscle itself is shorter."""
    INSIDE = "inside"
    """The muscle alone."""


@dataclass(frozen=True, slots=True)
class SeriesCompliance(InGripper):
    r"""The mount or the tendon stretches with the pull.

    .. math:: w = w_0 + c F_s, \quad h = h_m + e F_s, \quad
              F_s = \frac{1}{s} \ln(1 + s F)

    The jaws close less by c F_s; where the length is measured outside the stretch, the
    muscle itself is shorter than measured by e F_s. Its friction then turns round with
    the stretch, so that no small step leads from one to the other. F_s is the pull
    itself where s is 0; a rope stiffens with it, see
    :func:`~gripperd.model.spring.extension`.
    """

    name: ClassVar[str] = "series_compliance"
    needs: ClassVar[frozenset[str]] = frozenset({"contraction", "force"})
    shows: ClassVar[str] = (
        "the opening is wider than the contraction says, and the more the harder the"
        " muscle pulls, with or without an object"
    )
    confused_with: ClassVar[tuple[str, ...]] = ("jaw_compliance", "length_datum")
    remedy: ClassVar[str] = "stiffen the mount or the tendon of the muscle"

    idle: ClassVar[Mapping[str, tuple[str, ...]]] = MappingProxyType(
        {Measured.INSIDE: ("shortening",)}
    )

    compliance: float = amplitude(unit="mm_per_N", scale=1e-5, low=0.0, high=1e-3)
    """Opening per pull of the muscle, while that is small, c. [m/N]"""

    shortening: float = amplitude(unit="per_kN", scale=3e-6, low=0.0, high=1e-4)
    """Contraction beyond the measured one, per pull, while that is small, e. [1/N]"""

    stiffening: float = shape(unit="per_kN", starts=(0.0, 0.004), low=0.0, high=0.05)
    """Share of its stiffness that each newton adds, s. [1/N]"""

    measured: Measured = choice(Measured)  # noqa: RUF009  (declares)
    """What the length that is told takes in."""

    @property
    def signal(self) -> Signal:
        """The opening."""
        return Signal.OPENING

    @property
    def stiffens(self) -> bool:
        """Unless it gives in proportion."""
        return self.stiffening > 0

    def widening(self, grip: Real, pull: Real) -> Real:
        """Opening lost in the stretch. [m]."""
        return extension(pull, self.compliance, self.stiffening)

    def hidden_contraction(self, pull: Real) -> Real:
        """Contraction inside the stretch. [-]."""
        if self.measured is not Measured.OUTSIDE:
            return 0.0 * pull
        return extension(pull, self.shortening, self.stiffening)

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Opening of each moment; a slack muscle stretches nothing. [m]."""
        pulling = np.fmax(track.force, 0.0)
        return np.asarray(value + self.widening(track.grip, pulling))
