"""The regulator's curve between the ends of its line.

References
----------
.. [1] ANSI/ISA-51.1-1979 (R1993), "Process Instrumentation Terminology": terminal-based
       linearity, the deviation from the line through both ends.
"""

from dataclasses import dataclass
from math import sqrt
from typing import ClassVar

import numpy as np

from gripperd.model.kinds import InValve
from gripperd.model.parameter import amplitude
from gripperd.model.real import Real

SKEW_PEAK = sqrt(3) / 18
"""Largest value of ``x (1 - x) (1 - 2 x)``, at ``x = 1/2 - sqrt(3)/6``. [-]"""


@dataclass(frozen=True, slots=True)
class ValveNonlinearity(InValve):
    r"""A bow and a skew of the curve, both zero at the ends of the line.

    .. math:: p = p_0 + a\,4 x (1 - x) + b\,\frac{x (1 - x) (1 - 2 x)}{\sqrt 3 / 18}

    with x the place on the line, 0 to 1. These are all the deviations of third order;
    beyond the ends the line goes on as it was.
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

    def settled(self, pressure: Real, span: tuple[float, float]) -> Real:
        """Pressure on the bent curve. [Pa]."""
        low, high = span
        place = np.clip((pressure - low) / (high - low), 0.0, 1.0)
        bulge = place * (1 - place)
        skewed = bulge * (1 - 2 * place) / SKEW_PEAK
        bent: Real = pressure + 4 * self.bow * bulge + self.skew * skewed
        return bent
