"""Sections of the settings file about modules and channels."""

# ruff: noqa: N815  (names carry units, and units have capitals)

from collections.abc import Mapping
from typing import Annotated, TypeAlias

from pydantic import Field, PlainValidator, ValidationInfo, field_validator

from gripperd.bench.sensors import Channel as BenchChannel
from gripperd.config.complaint import did_you_mean
from gripperd.config.section import (
    Kilopascals,
    Milliamperes,
    Name,
    Rising,
    Section,
    Span,
    numbers,
)
from gripperd.config.surroundings import library
from gripperd.drivers.analog import (
    InputWiring,
    OutputWiring,
    SensorWiring,
    WatchdogSettings,
)
from gripperd.protocol.live_zero import LoopScale
from gripperd.protocol.modules import InputModule, Module, ModuleDialect, OutputModule

NOBODY = 0
"""Unit and channel of a device that is alone on its line."""


def _output(name: object, asked: ValidationInfo) -> OutputModule:
    return library(asked).output(name)


def _input(name: object, asked: ValidationInfo) -> InputModule:
    return library(asked).input(name)


def _check_channel(channel: int, module: Module | None) -> None:
    """Refuse a channel that a module does not have; None is a module not known."""
    if module is not None and channel >= module.channels:
        last = module.channels - 1
        message = f"channel {channel} is not one of {module.name}: 0 to {last}"
        raise ValueError(message)


def _check_range(name: str | None, module: Module | None) -> None:
    if module is not None and name is not None and name not in module.ranges:
        hint = did_you_mean(name, module.ranges)
        message = f'"{name}" is not a range of {module.name}; {hint}'
        raise ValueError(message)


Unit: TypeAlias = Annotated[int, Field(ge=1, le=247)]
"""Address of a Modbus server on a line (Modbus over serial line V1.02, 2.2)."""
Channel: TypeAlias = Annotated[int, Field(ge=0)]
LiveZero: TypeAlias = Annotated[float, Field(ge=3.6, le=21)]
"""What a working loop carries; anything else says that it is broken (NE 43). [mA]"""


class WatchdogSection(Section):
    """What the output module does when this daemon falls silent."""

    timeout_s: float | None = Field(default=None, gt=0, le=86_400)
    safe_mA: Milliamperes | None = None

    @property
    def settings(self) -> WatchdogSettings:
        """The same for the driver."""
        asked = numbers(self)
        return WatchdogSettings(
            timeout=asked.get("timeout"), safe_current=asked.get("safe")
        )


class OutputSection(Section):
    """The channel that drives the valve."""

    module: Annotated[OutputModule, PlainValidator(_output)]
    unit: Unit | None = Field(default=None, validate_default=True)
    channel: Channel | None = Field(default=None, validate_default=True)
    range: Name | None = None
    set_range: bool = False
    watchdog: WatchdogSection | None = None

    @field_validator("unit", "channel")
    @classmethod
    def _is_given(cls, number: int | None, read: ValidationInfo) -> int | None:
        module = read.data.get("module")
        if number is None and module is not None and not module.itv:
            message = f"{read.field_name} is missing; {module.name} needs one"
            raise ValueError(message)
        return number

    @field_validator("channel")
    @classmethod
    def _exists(cls, channel: int | None, read: ValidationInfo) -> int | None:
        if channel is not None:
            _check_channel(channel, read.data.get("module"))
        return channel

    @field_validator("range")
    @classmethod
    def _is_one(cls, name: str | None, read: ValidationInfo) -> str | None:
        _check_range(name, read.data.get("module"))
        return name

    def wiring(self, dialect: ModuleDialect) -> OutputWiring:
        """The same for the driver."""
        return OutputWiring(
            module=self.module,
            unit=self.unit or NOBODY,
            channel=self.channel or NOBODY,
            dialect=dialect,
            range_name=self.range,
            set_range=self.set_range,
            watchdog=self.watchdog.settings if self.watchdog else None,
        )


class SensorSection(Section):
    """The channel of one sensor, and the current at both ends of its span."""

    channel: Channel
    current_mA: Rising[LiveZero]

    @property
    def wiring(self) -> SensorWiring:
        """The same for the driver."""
        return SensorWiring(channel=self.channel, scale=LoopScale(**numbers(self)))


class PressureSection(SensorSection):
    """Gauge pressure in the muscle."""

    value_kPa: Span[Kilopascals] = Field(alias="pressure_kPa")


class OpeningSection(SensorSection):
    """Distance between the jaws."""

    value_mm: Span[Annotated[float, Field(ge=-1000, le=1000)]] = Field(
        alias="opening_mm"
    )


class GripSection(SensorSection):
    """Grip force per jaw."""

    value_N: Span[Annotated[float, Field(ge=-100_000, le=100_000)]] = Field(
        alias="grip_N"
    )


class InputSection(Section):
    """The module that the sensors are connected to."""

    module: Annotated[InputModule, PlainValidator(_input)]
    unit: Unit
    range: Name | None = None
    set_range: bool = False
    pressure: PressureSection | None = None
    opening: OpeningSection | None = None
    grip: GripSection | None = None

    @field_validator("range")
    @classmethod
    def _is_one(cls, name: str | None, read: ValidationInfo) -> str | None:
        _check_range(name, read.data.get("module"))
        return name

    @field_validator("pressure", "opening", "grip")
    @classmethod
    def _is_free(
        cls, sensor: SensorSection | None, read: ValidationInfo
    ) -> SensorSection | None:
        if sensor is None:
            return None
        _check_channel(sensor.channel, read.data.get("module"))
        for name, other in read.data.items():
            if isinstance(other, SensorSection) and other.channel == sensor.channel:
                message = f"channel {sensor.channel} is already that of {name}"
                raise ValueError(message)
        return sensor

    @property
    def sensors(self) -> Mapping[str, SensorWiring]:
        """The sensors that are fitted, by their name in a measurement."""
        fitted = {"pressure": self.pressure, "opening": self.opening, "grip": self.grip}
        return {name: sensor.wiring for name, sensor in fitted.items() if sensor}

    def wiring(self, dialect: ModuleDialect) -> InputWiring:
        """The same for the driver."""
        return InputWiring(
            module=self.module,
            unit=self.unit,
            sensors=self.sensors,
            dialect=dialect,
            range_name=self.range,
            set_range=self.set_range,
        )


def check_bench_output(output: OutputSection) -> None:
    """Refuse a valve where the simulated rig has none."""
    if output.channel:
        message = f"channel {output.channel}: the bench has its valve on channel 0"
        raise ValueError(message)


def check_bench_input(inputs: InputSection | None) -> None:
    """Refuse sensors where the simulated rig has others, or none."""
    if inputs is None:
        message = "no input is given; the bench has its sensors on one"
        raise ValueError(message)
    for channel, name in enumerate(BenchChannel):
        sensor = inputs.sensors.get(name)
        if sensor is not None and sensor.channel != channel:
            message = (
                f"{name} on channel {sensor.channel}: the bench has it on"
                f" channel {channel}"
            )
            raise ValueError(message)
