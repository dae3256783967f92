"""What is connected to which channel of which module."""

from collections.abc import Mapping
from dataclasses import dataclass

from gripperd.protocol.encoding import Range
from gripperd.protocol.live_zero import LoopScale
from gripperd.protocol.modules import InputModule, ModuleDialect, OutputModule
from gripperd.signals import Reading
from gripperd.units import MILLI

OVERRANGE = 0.05
"""What a measured read-back may lie beyond its range, relative to the span. [-]"""


@dataclass(frozen=True, slots=True, kw_only=True)
class WatchdogSettings:
    """What the user asks of the communication watchdog of an output module."""

    timeout: float | None
    """Silence after which it trips; None where only the safe value is set here. [s]"""
    safe_current: float | None
    """Output once it has tripped; None leaves what the module has. [A]"""


@dataclass(frozen=True, slots=True, kw_only=True)
class OutputWiring:
    """Where the valve is connected."""

    module: OutputModule
    unit: int
    """Address on the bus; 0 where the line leads to one device alone."""
    channel: int
    dialect: ModuleDialect = ModuleDialect.MODBUS
    range_name: str | None = None
    """None: the first of the module."""
    set_range: bool = False
    """Set the range where the module has another; otherwise that is an error."""
    watchdog: WatchdogSettings | None = None
    """None: it is left as it is."""

    @property
    def range(self) -> Range:
        """Range of the channel."""
        return self.module.range(self.range_name)

    def reading(self, current: float) -> Reading:
        """A current that was read back, if the channel can give it. [A].

        A channel that is off reads as 0, also where its range begins at 4 mA.
        """
        chosen = self.range
        margin = OVERRANGE * (chosen.current_high - chosen.current_low)
        low = min(chosen.current_low, 0.0) - margin
        if low <= current <= chosen.current_high + margin:
            return Reading(current)
        said = f"{self} reads back as {current / MILLI:g} mA, which it cannot give"
        return Reading.bad(said)

    def __str__(self) -> str:
        """As a person would say it."""
        return f"channel {self.channel} of {self.module.name}, unit {self.unit},"


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorWiring:
    """Where one sensor is connected, and how its current reads."""

    channel: int
    scale: LoopScale


@dataclass(frozen=True, slots=True, kw_only=True)
class InputWiring:
    """Where the sensors are connected; the keys are names in `Measurement`."""

    module: InputModule
    unit: int
    sensors: Mapping[str, SensorWiring]
    dialect: ModuleDialect = ModuleDialect.MODBUS
    range_name: str | None = None
    """None: the first of the module."""
    set_range: bool = False
    """Set the ranges where the module has others; otherwise that is an error."""

    @property
    def range(self) -> Range:
        """Range of every channel that is used."""
        return self.module.range(self.range_name)
