"""Register maps of analog modules.

References
----------
.. [1] Waveshare, "Modbus RTU Analog Output 8CH", protocol table: holding registers
       0x0000-0x0007 in µA, functions 3, 6 and 16.
.. [2] Waveshare, "Modbus RTU Analog Input 8CH", protocol table: input registers
       0x0000-0x0007 in µA, range codes in holding registers 0x1000-0x1007.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from gripperd.errors import InputError
from gripperd.units import MILLI

MICRO = 1e-6


@dataclass(frozen=True, slots=True, kw_only=True)
class OutputModule:
    """A module that drives 4-20 mA loops; one holding register a channel."""

    name: str
    channels: int
    address: int
    """Register of channel 0."""
    ampere_per_count: float
    highest: float
    """Largest current the module accepts. [A]"""

    def register(self, channel: int) -> int:
        """Holding register of a channel."""
        return self.address + channel

    def encode(self, current: float) -> int:
        """Register value of a current.

        >>> OUTPUTS["waveshare_ao_8ch"].encode(0.0107)
        10700

        Raises
        ------
        InputError
            Outside what the module accepts; it is not clamped.
        """
        if not 0.0 <= current <= self.highest:
            message = (
                f"{current / MILLI:g} mA is outside 0 to {self.highest / MILLI:g} mA,"
                f" the range of {self.name}"
            )
            raise InputError(message, key="current_mA")
        return round(current / self.ampere_per_count)

    def decode(self, count: int) -> float:
        """Current of a register value. [A]."""
        return count * self.ampere_per_count


@dataclass(frozen=True, slots=True, kw_only=True)
class InputModule:
    """A module that measures 4-20 mA loops; one input register a channel."""

    name: str
    channels: int
    address: int
    """Register of channel 0."""
    range_address: int
    """Holding register with the range code of channel 0."""
    range_code: int
    """Range code that the counts below belong to."""
    ampere_per_count: float

    def decode(self, count: int) -> float:
        """Current of a register value. [A]."""
        return count * self.ampere_per_count

    def encode(self, current: float) -> int:
        """Register value of a current, as the module would measure it."""
        return round(current / self.ampere_per_count)


OUTPUTS: Mapping[str, OutputModule] = MappingProxyType(
    {
        "waveshare_ao_8ch": OutputModule(
            name="waveshare_ao_8ch",
            channels=8,
            address=0x0000,
            ampere_per_count=MICRO,
            highest=0.020,
        )
    }
)

INPUTS: Mapping[str, InputModule] = MappingProxyType(
    {
        "waveshare_ai_8ch": InputModule(
            name="waveshare_ai_8ch",
            channels=8,
            address=0x0000,
            range_address=0x1000,
            range_code=2,
            ampere_per_count=MICRO,
        )
    }
)
