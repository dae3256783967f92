"""The columns of a recording: what files call them, and their way to SI."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from gripperd.model.track import Array
from gripperd.units import KILO, MILLI

CELSIUS_ZERO = 273.15
"""Zero of the Celsius scale, exact by definition (BIPM, SI brochure). [K]"""


@dataclass(frozen=True, slots=True)
class Column:
    """One quantity: its name and unit in a file, its name and scale inside."""

    name: str
    """In a file, such as ``pressure_kPa``."""
    quantity: str
    """In :class:`gripperd.diagnose.readings.recording.Run`, such as ``pressure``."""
    unit: str = ""
    """Of the file, for a person."""
    scale: float = 1.0
    """SI units in one unit of the file."""
    zero: float = 0.0
    """SI value of a zero in the file."""

    def si(self, values: Array) -> Array:
        """Put values of a file into SI; what is too large for that is infinite."""
        with np.errstate(over="ignore"):
            return values * self.scale + self.zero

    def written(self, values: Array) -> Array:
        """Put SI values into the unit of the file."""
        return (values - self.zero) / self.scale

    def shown(self, value: float) -> str:
        """Write an SI value with the unit of the file.

        >>> COLUMNS["pressure_kPa"].shown(250e3)
        '250 kPa'
        """
        return f"{(value - self.zero) / self.scale:.5g} {self.unit}".rstrip()


TIME = Column("t_s", "time", "s")

COLUMNS: Mapping[str, Column] = MappingProxyType(
    {
        column.name: column
        for column in (
            TIME,
            Column("current_mA", "current", "mA", MILLI),
            Column("pressure_kPa", "pressure", "kPa", KILO),
            Column("contraction", "contraction"),
            Column("length_mm", "length", "mm", MILLI),
            Column("force_N", "force", "N"),
            Column("opening_mm", "opening", "mm", MILLI),
            Column("grip_N", "grip", "N"),
            Column("object_mm", "object", "mm", MILLI),
            Column("temperature_C", "temperature", "°C", zero=CELSIUS_ZERO),
            Column("supply_kPa", "supply", "kPa", KILO),
            Column("ambient_kPa", "ambient", "kPa", KILO),
        )
    }
)
"""Every column of numbers, by its name in a file."""

BY_QUANTITY: Mapping[str, Column] = MappingProxyType(
    {column.quantity: column for column in COLUMNS.values()}
)
