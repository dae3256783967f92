"""Zero error of the regulator.

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
class ValveOffset(InValve):
    r"""The whole line of the regulator is shifted: :math:`p = p_0 + b`."""

    name: ClassVar[str] = "valve_offset"
    needs: ClassVar[frozenset[str]] = frozenset({"current", "pressure"})
    shows: ClassVar[str] = (
        "measured pressure is off against the current by a constant, while the force"
        " fits the measured pressure"
    )
    confused_with: ClassVar[tuple[str, ...]] = (
        "pressure_sensor_bias", "ambient_pressure",
    )  # fmt: skip
    remedy: ClassVar[str] = "trim the zero of the regulator, or the valve's line"

    offset: float = amplitude(unit="kPa", scale=5e3, low=-100e3, high=100e3)
    """Pressure beyond the line. [Pa]"""

    def settled(self, pressure: Real, span: tuple[float, float]) -> Real:
        """Shifted pressure. [Pa]."""
        return pressure + self.offset
