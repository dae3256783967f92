"""Span error of the regulator.

References
----------
.. [1] ISO 10094-1:2010, "Pneumatic fluid power - Electro-pneumatic pressure control
       valves - Part 1": characteristics of the control signal against pressure.
"""

from dataclasses import dataclass
from typing import ClassVar

from gripperd.model.kinds import InValve
from gripperd.model.parameter import amplitude
from gripperd.model.real import Real


@dataclass(frozen=True, slots=True)
class ValveGain(InValve):
    r"""The line is steeper or flatter: :math:`p = p_l + (p_0 - p_l)(1 + e)`.

    It turns about :math:`p_l`, the low end of the line.
    """

    name: ClassVar[str] = "valve_gain"
    needs: ClassVar[frozenset[str]] = frozenset({"current", "pressure"})
    shows: ClassVar[str] = (
        "measured pressure is off against the current in proportion to the pressure,"
        " while the force fits the measured pressure"
    )
    confused_with: ClassVar[tuple[str, ...]] = (
        "pressure_sensor_gain",
        "supply_saturation",
    )
    remedy: ClassVar[str] = "trim the span of the regulator, or the valve's line"

    error: float = amplitude(unit=None, scale=0.02, low=-0.5, high=0.5)
    """Slope relative to the line's, less 1. [-]"""

    def settled(self, pressure: Real, span: tuple[float, float]) -> Real:
        """Pressure on the turned line. [Pa]."""
        return pressure + self.error * (pressure - span[0])
