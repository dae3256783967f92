"""The regulator as it is: its line, and what the effects of the valve make of it."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gripperd.errors import DomainError
from gripperd.model.effect import ValveEffect
from gripperd.model.real import Real, everywhere
from gripperd.model.regulator import Regulator
from gripperd.model.root import falling_root, falling_roots
from gripperd.units import KILO

BEYOND = 1.0
"""How far past both ends the line goes on in search of a pressure, in spans. [-]"""
PLACES = 769
"""Places at which the curve is looked at for its top: 256 on each span."""


@dataclass(frozen=True)
class Outlet:
    """Steady pressure behind a regulator with effects; it answers like the regulator.

    The curve is taken to rise up to its top. A pressure that it leaps over has the
    current of the leap, so that a ramp of pressures has one of currents.
    """

    regulator: Regulator
    effects: tuple[ValveEffect, ...]

    @property
    def span(self) -> tuple[float, float]:
        """Gauge pressures at both ends of the line. [Pa]."""
        return self.regulator.pressure_low, self.regulator.pressure_high

    def pressure(self, current: Real) -> Real:
        """Gauge pressure at a current, once settled. [Pa]."""
        return self._settled(self.regulator.pressure(current))

    def current(self, pressure: Real) -> Real:
        """Current for a gauge pressure, by a root of the curve. [A].

        Raises
        ------
        DomainError
            When no current gives this pressure.
        """
        low, top = self._range
        least, most = self._settled(low), self._settled(top)
        if not everywhere((pressure >= least) & (pressure <= most)):
            names = ", ".join(effect.name for effect in self.effects)
            message = (
                f"the valve does not reach {_furthest(pressure, least, most):g} kPa:"
                f" with {names} it gives {least / KILO:g} to {most / KILO:g} kPa"
            )
            raise DomainError(message, key="pressure_kPa")

        def lacking(line: Real) -> Real:
            return pressure - self._settled(line)

        if isinstance(pressure, np.ndarray):
            ends = (np.full_like(pressure, end) for end in (low, top))
            return self.regulator.current(falling_roots(lacking, *ends))
        line = falling_root(lambda line: float(lacking(line)), low, top)
        return self.regulator.current(line)

    @cached_property
    def _range(self) -> tuple[float, float]:
        """Pressures on the line: the lowest, and the one that gives most. [Pa]."""
        low, high = self.span
        reach = BEYOND * (high - low)
        line = np.linspace(low - reach, high + reach, PLACES)
        return float(line[0]), float(line[np.argmax(self._settled(line))])

    def _settled(self, pressure: Real) -> Real:
        for effect in self.effects:
            pressure = effect.settled(pressure, self.span)
        return pressure


def _furthest(pressure: Real, least: Real, most: Real) -> float:
    """The pressure that lies most outside. [kPa]."""
    outside = np.maximum(least - pressure, pressure - most)
    return float(np.ravel(pressure)[np.argmax(outside)]) / KILO
