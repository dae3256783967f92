"""The regulator's curve between the ends of its line.

References
----------
.. [1] ANSI/ISA-51.1-1979 (R1993), "Process Instrumentation Terminology": terminal-based
       linearity, the deviation from the line through both ends.
.. [2] M. Abramowitz, I. A. Stegun, "Handbook of Mathematical Functions", 1964, table
       22.9: Legendre polynomials.
"""

from dataclasses import dataclass
from math import sqrt
from typing import ClassVar

import numpy as np

from gripperd.model.kinds import InValve
from gripperd.model.parameter import amplitude
from gripperd.model.real import Real

PEAKS = (1 / 4, sqrt(3) / 18, 1 / 8, 0.0925954)
"""Largest values of ``x (1 - x) P(1 - 2 x)``, for Legendre's polynomials from order 0:
at the middle, at ``x = 1/2 - sqrt(3)/6``, at the middle, at ``x = 0.3078``. [-]"""


@dataclass(frozen=True, slots=True)
class ValveNonlinearity(InValve):
    r"""A bow of the curve, a skew, and two waves, all zero at the ends of the line.

    .. math:: p = p_0 + \sum_{i=0}^{3} a_i \frac{x (1 - x) P_i(1 - 2 x)}{m_i}

    with x the place on the line, 0 to 1, Legendre's polynomials and the peaks m of
    their terms. These are all the deviations of fifth order; beyond the ends the line
    goes on as it was.
    """

    name: ClassVar[str] = "valve_nonlinearity"
    needs: ClassVar[frozenset[str]] = frozenset({"current", "pressure"})
    shows: ClassVar[str] = (
        "measured pressure bows away from the line against the current, most in the"
        " middle and nothing at the ends"
    )
    confused_with: ClassVar[tuple[str, ...]] = ("supply_saturation", "valve_gain")
    remedy: ClassVar[str] = "calibrate the regulator at several currents"

    bow: float = amplitude(unit="kPa", scale=5e3, low=-100e3, high=100e3)
    """Deviation in the middle of the line. [Pa]"""
    skew: float = amplitude(unit="kPa", scale=5e3, low=-100e3, high=100e3)
    """Deviation at a fifth of the line, and its opposite at four fifths. [Pa]"""
    wave: float = amplitude(unit="kPa", scale=5e3, low=-50e3, high=50e3)
    """Its opposite in the middle, with a third of it a tenth from the ends. [Pa]"""
    skew_wave: float = amplitude(unit="kPa", scale=5e3, low=-50e3, high=50e3)
    """Its opposite at a third of the line, and this at two thirds. [Pa]"""

    def settled(self, pressure: Real, span: tuple[float, float]) -> Real:
        """Pressure on the bent curve. [Pa]."""
        low, high = span
        place = np.clip((pressure - low) / (high - low), 0.0, 1.0)
        along = 1 - 2 * place
        terms = zip(
            (self.bow, self.skew, self.wave, self.skew_wave),
            (1.0, along, (3 * along**2 - 1) / 2, (5 * along**3 - 3 * along) / 2),
            PEAKS,
            strict=True,
        )
        bent = sum(size * legendre / peak for size, legendre, peak in terms)
        off: Real = pressure + place * (1 - place) * bent
        return off
