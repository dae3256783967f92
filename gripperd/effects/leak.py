"""Air lost between regulator and muscle.

References
----------
.. [1] ISO 10094-1:2010, "Pneumatic fluid power - Electro-pneumatic pressure control
       valves - Part 1": leakage, and the flow-rate characteristic by which it droops.
.. [2] ISO 6358-1:2013, "Pneumatic fluid power - Determination of flow-rate
       characteristics of components using compressible fluids": orifices.
.. [3] P. Beater, "Pneumatic Drives: System Design, Modelling and Control", Springer,
       2007: laminar flow through a gap, as the difference of the squared pressures.
"""

from dataclasses import dataclass
from math import expm1
from typing import ClassVar

import numpy as np

from gripperd.model.kinds import InValve
from gripperd.model.memory import leaked
from gripperd.model.parameter import amplitude, shape
from gripperd.model.real import Real
from gripperd.model.track import Array, Track

SOON = 10.0
"""Time in which a leaking line sinks to what the regulator's flow can keep. [s]"""
USUAL = 300e3
"""Pressure at which the rate is told: half of what muscles are driven with. [Pa]"""


@dataclass(frozen=True, slots=True)
class Leak(InValve):
    r"""The pressure sinks while the command stands still.

    .. math:: p = p_1 - l - d\,p_1\,(1 - e^{-t/10\,\mathrm s}),
        \quad p_1 = p_0 - f k\,p_0\,(p_0 / 300\,\mathrm{kPa})^n

    with l what is lost and q = p_1 - l, ``dl/dt = k q (q / 300 kPa)^n`` while the valve
    is shut, less ``l / r`` while the regulator feeds the leak, and t the time since the
    command last moved: told to move, the regulator fills up, or lets out what is left
    above a command that falls. So it does if it is taken to keep the pressure while air
    is lost elsewhere, as fast or as slow as it is. The last term is a regulator that
    droops.

    A hole lets through what goes with the root of a low pressure, an orifice that is
    choked as much as is there [2]_, a gap that the air creeps through the square of a
    high one [3]_: n is -1/2, 0 and 1.
    """

    name: ClassVar[str] = "leak"
    needs: ClassVar[frozenset[str]] = frozenset({"current", "pressure"})
    shows: ClassVar[str] = (
        "measured pressure sinks for as long as the current stands still, the faster"
        " the higher it is"
    )
    confused_with: ClassVar[tuple[str, ...]] = ("creep", "supply_saturation")
    remedy: ClassVar[str] = "find the leak with soap water, fittings first"
    timed: ClassVar[bool] = True

    rate: float = amplitude(unit="per_s", scale=1e-3, low=0.0, high=1.0)
    """Pressure lost per pressure and time, valve shut, at 300 kPa. [1/s]"""
    early: float = amplitude(unit=None, scale=0.02, low=0.0, high=0.9)
    """Share of the pressure lost to the droop. [-]"""
    exponent: float = shape(unit=None, starts=(0.0,), low=-0.5, high=1.0)
    """By which the rate goes with the pressure. [-]"""
    droop: float = shape(unit="s", starts=(0.0,), low=0.0, high=30.0)
    """Of the regulator at once, over what it loses per time. [s]"""
    refill: float = shape(unit="s", starts=(0.05, 2.0, 20.0), low=0.005, high=60.0)
    """Time in which a regulator fills up what was lost, r. [s]"""

    def rest(self) -> Array:
        """Nothing lost of nothing."""
        return np.zeros(2)

    def settled(self, pressure: Real, span: tuple[float, float]) -> Real:
        """Pressure of the moment before anything is lost: it droops at once. [Pa]."""
        usual = np.maximum(pressure, 0.0) / USUAL
        fed = self.rate * self.droop * USUAL * usual ** (1 + self.exponent)
        return pressure - np.minimum(fed, np.maximum(pressure, 0.0))

    def lasts(self, pressure: float, folds: float) -> float:
        """Time in which a trapped pressure [Pa] falls so many times by e. [s]."""
        bend = self.exponent
        pace = self.rate * float((pressure / USUAL) ** bend)
        return (expm1(bend * folds) / bend if bend else folds) / pace

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Pressure that is left. [Pa]."""
        value = np.asarray(self.settled(value, track.span))
        law = (self.rate, self.exponent, self.refill)
        lost = USUAL * leaked(value / USUAL, track.step, track.waiting, law, memory)
        return value - lost + value * self.early * np.expm1(-track.still / SOON)
