"""Pull of a muscle at standstill: eq. (7), and pressure from pull in closed form."""

from dataclasses import dataclass

import numpy as np

from gripperd.errors import DomainError
from gripperd.model.effect import Direction, MuscleEffect, MuscleState
from gripperd.model.muscle import CATALOGUE_RANGE, Muscle
from gripperd.model.real import Real, chunked, everywhere, positive_part

PROBE = 1e5
"""Step over which a slope in pressure is taken; any would do, it is affine. [Pa]"""


@dataclass(frozen=True)
class StaticMuscle:
    """A muscle and the effects that act in it.

    With ``rubber_elasticity`` and ``braid_friction`` it is the paper's static model,
    without any it is the ideal one.
    """

    muscle: Muscle
    effects: tuple[MuscleEffect, ...] = ()

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
        """Gauge pressure for a pull: eq. (7) solved for p, in closed form.

        The force rises with pressure in straight pieces that meet at the kinks of the
        effects, so the inverse is walked piece by piece.

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
            Where pressure no longer makes the muscle pull.
        """
        return self._pressure(force, contraction, direction)

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
        pressure = kinks[0] - positive_part(forces[0] - force) * PROBE / fall
        for index in range(len(kinks) - 1):
            step = forces[index + 1] - forces[index]
            run = kinks[index + 1] - kinks[index]
            excess = positive_part(force - forces[index])
            inside = excess - positive_part(excess - step)
            # Where two kinks coincide there is nothing to walk: 0 / 1, not 0 / 0.
            pressure = pressure + inside * run / (step + (step == 0))
        return pressure + positive_part(force - forces[-1]) * PROBE / rise

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
        """Pressures between which the force is affine, rising; at least one."""
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
