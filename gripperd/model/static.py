"""Pull of a muscle at standstill: eq. (7), and pressure from pull."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from gripperd.errors import DomainError
from gripperd.model.effect import Direction, MuscleState, StaticEffect
from gripperd.model.muscle import CATALOGUE_RANGE, Muscle
from gripperd.model.real import Real, chunked, everywhere, positive_part
from gripperd.model.root import falling_root, falling_roots
from gripperd.units import KILO

if TYPE_CHECKING:
    from numpy.typing import NDArray

PROBE = 1e5
"""Step over which a slope in pressure is taken; any would do, it is affine. [Pa]"""

VACUUM, HIGHEST = -100e3, 1e6
"""Gauge pressures between which a pull is sought when the force is not affine; fluidic
muscles take 0.8 MPa (Festo DMSP). [Pa]"""


@dataclass(frozen=True)
class StaticMuscle:
    """A muscle and the effects that act in it.

    With ``rubber_elasticity`` and ``braid_friction`` it is the paper's static model,
    without any it is the ideal one.
    """

    muscle: Muscle
    effects: tuple[StaticEffect, ...] = ()

    def state(self, pressure: Real, contraction: Real, direction: Real) -> MuscleState:
        """Everything the effects may ask for at one point.

        Raises
        ------
        DomainError
            Outside the geometry of the braid.
        """
        self._check(contraction)
        ratio = self.muscle.diameter_ratio(contraction)
        return MuscleState(pressure, contraction, ratio, direction)

    def force(
        self,
        pressure: Real,
        contraction: Real,
        direction: Real = Direction.CONTRACTING,
    ) -> Real:
        r"""Pull of the muscle, eq. (7).

        .. math:: F = F_i - F_s \mp F_k

        minus while contracting, plus while extending. The number is signed: below 0
        the muscle is slack, see :meth:`tension`.

        Parameters
        ----------
        pressure
            Gauge pressure. [Pa]
        contraction
            Shortening relative to rest. [-]
        direction
            Direction of travel, or of the last travel when at rest.

        Returns
        -------
        Force along the axis, in the shape the arguments broadcast to. [N]

        Raises
        ------
        DomainError
            Where a strand would have to be longer than it is.
        """
        return self._force(pressure, contraction, direction)

    @chunked
    def _force(self, pressure: Real, contraction: Real, direction: Real) -> Real:
        at = self.state(pressure, contraction, direction)
        total = pressure * self.muscle.pull_area(contraction)
        for effect in self.effects:
            total = total + effect.force(at, self.muscle)
        return total

    def tension(
        self,
        pressure: Real,
        contraction: Real,
        direction: Real = Direction.CONTRACTING,
    ) -> Real:
        """Pull that the mechanism feels: a muscle cannot push. [N]."""
        force = self.force(pressure, contraction, direction)
        return positive_part(force)

    def pressure(
        self,
        force: Real,
        contraction: Real,
        direction: Real = Direction.CONTRACTING,
    ) -> Real:
        """Gauge pressure for a pull: eq. (7) solved for p.

        With affine effects the force is made of straight pieces that meet at their
        kinks, and the inverse is closed: the pieces are walked down from the highest.
        With others it is sought between :data:`VACUUM` and :data:`HIGHEST`.

        Where several pressures give the same pull, as below a threshold, it is one of
        them; in closed form the highest.

        Parameters
        ----------
        force
            Pull along the axis. [N]
        contraction
            Shortening relative to rest. [-]
        direction
            Direction of travel, or of the last travel when at rest.

        Returns
        -------
        Gauge pressure, below 0 where the muscle would have to be evacuated. [Pa]

        Raises
        ------
        DomainError
            Where pressure no longer makes the muscle pull, or none that a muscle
            takes makes it pull so hard.
        """
        if all(effect.affine for effect in self.effects):
            return self._pressure(force, contraction, direction)
        return self._sought(force, contraction, direction)

    @chunked
    def _pressure(self, force: Real, contraction: Real, direction: Real) -> Real:
        self._check(contraction)
        kinks = self._kinks(contraction)
        forces = [self._force(kink, contraction, direction) for kink in kinks]
        fall = forces[0] - self._force(kinks[0] - PROBE, contraction, direction)
        rise = self._force(kinks[-1] + PROBE, contraction, direction) - forces[-1]
        if not (everywhere(fall > 0) and everywhere(rise > 0)):
            message = (
                f"at contraction {np.max(contraction):.4g} pressure no longer makes the"
                f" muscle pull; without friction that ends at {self.muscle.spent:.4f}"
            )
            raise DomainError(message, key="contraction")
        pressure = kinks[-1] + (force - forces[-1]) * PROBE / rise
        least = forces[-1]
        for index in range(len(kinks) - 2, -1, -1):
            step = forces[index + 1] - forces[index]
            run = kinks[index + 1] - kinks[index]
            # Where two kinks coincide there is nothing to walk: 0 / 1, not 0 / 0.
            back = (forces[index + 1] - force) * run / (step + (step == 0))
            pressure = _either(force < least, kinks[index + 1] - back, pressure)
            least = _either(forces[index] < least, forces[index], least)
        below = kinks[0] - (forces[0] - force) * PROBE / fall
        return _either(force < least, below, pressure)

    @chunked
    def _sought(self, force: Real, contraction: Real, direction: Real) -> Real:
        def lacking(pressure: Real) -> Real:
            return force - self._force(pressure, contraction, direction)

        weakest, strongest = lacking(VACUUM), lacking(HIGHEST)
        beyond = (weakest < 0) | (strongest > 0)
        if np.any(beyond):
            asked, held = (
                np.broadcast_to(value, np.shape(beyond))[beyond].flat[0]
                for value in (force, contraction)
            )
            message = (
                f"at contraction {held:.4g} no pressure from {VACUUM / KILO:g} to"
                f" {HIGHEST / KILO:g} kPa makes the muscle pull {asked:.4g} N"
            )
            raise DomainError(message, key="contraction")
        if isinstance(weakest, np.ndarray):
            ends = (np.full_like(weakest, end) for end in (VACUUM, HIGHEST))
            return falling_roots(lacking, *ends)
        return falling_root(lambda p: float(lacking(p)), VACUUM, HIGHEST)

    def _check(self, contraction: Real) -> None:
        straight = self.muscle.straight
        if not everywhere(contraction >= straight):
            message = (
                f"contraction {np.min(contraction):.4g} is below {straight:.4f}, where"
                " the strands of the braid are straight"
            )
            raise DomainError(message, key="contraction")
        if not everywhere(contraction < 1):
            message = (
                f"contraction {np.max(contraction):.4g} is not below 1: the muscle has"
                " no length left"
            )
            raise DomainError(message, key="contraction")

    def _kinks(self, contraction: Real) -> list[Real]:
        """Pressures between which an affine force is straight, rising; at least one."""
        ratio = self.muscle.diameter_ratio(contraction)
        kinks: list[Real] = [
            kink
            for effect in self.effects
            for kink in effect.kinks(contraction, ratio, self.muscle)
        ] or [0.0 * contraction]
        if len(kinks) == 1:
            return kinks
        return list(np.sort(np.stack(np.broadcast_arrays(*kinks)), axis=0))

    def extrapolates(self, contraction: float) -> bool:
        """Tell whether a contraction lies outside what the muscle is specified for."""
        low, high = CATALOGUE_RANGE
        return not low <= contraction <= high


def _either(
    condition: "bool | np.bool_ | NDArray[np.bool_]", yes: Real, no: Real
) -> Real:
    if isinstance(condition, np.ndarray):
        return np.where(condition, yes, no)
    return yes if condition else no
