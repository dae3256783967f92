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
from gripperd.model.parameter import amplitude, choice
from gripperd.model.real import Real
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

    .. math:: w = w_0 + c F, \quad h = h_m + e F

    The jaws close less by c F; where the length is measured outside the stretch, the
    muscle itself is shorter than measured by e F. Its friction then turns round with
    the stretch, so that no small step leads from one to the other.
    """

    name: ClassVar[str] = "series_compliance"
    needs: ClassVar[frozenset[str]] = frozenset({"contraction", "force"})
    shows: ClassVar[str] = (
        "the opening is wider than the contraction says, in proportion to the pull of"
        " the muscle, with or without an object"
    )
    confused_with: ClassVar[tuple[str, ...]] = ("jaw_compliance", "length_datum")
    remedy: ClassVar[str] = "stiffen the mount or the tendon of the muscle"

    idle: ClassVar[Mapping[str, tuple[str, ...]]] = MappingProxyType(
        {Measured.INSIDE: ("shortening",)}
    )

    compliance: float = amplitude(unit="mm_per_N", scale=1e-5, low=0.0, high=1e-3)
    """Opening per pull of the muscle. [m/N]"""

    shortening: float = amplitude(unit="per_kN", scale=3e-6, low=0.0, high=1e-4)
    """Contraction beyond the measured one, per pull of the muscle. [1/N]"""

    measured: Measured = choice(Measured)  # noqa: RUF009  (declares)
    """What the length that is told takes in."""

    @property
    def signal(self) -> Signal:
        """The opening."""
        return Signal.OPENING

    def widening(self, grip: Real, pull: Real) -> Real:
        """Opening lost in the stretch. [m]."""
        return self.compliance * pull

    def hidden_contraction(self, pull: Real) -> Real:
        """Contraction inside the stretch. [-]."""
        outside = self.measured is Measured.OUTSIDE
        return self.shortening * pull if outside else 0.0 * pull

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Opening of each moment; a slack muscle stretches nothing. [m]."""
        pulling = np.fmax(track.force, 0.0)
        return np.asarray(value + self.widening(track.grip, pulling))
