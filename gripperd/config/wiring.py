"""Sections of the settings file about buses, modules and channels."""

# ruff: noqa: N815  (names carry units, and units have capitals)

import re
from collections.abc import Mapping
from typing import Annotated, Literal, NamedTuple, TypeAlias

from pydantic import (
    Discriminator,
    Field,
    PlainValidator,
    Tag,
    ValidationInfo,
    field_validator,
)

from gripperd.bench.sensors import Channel as BenchChannel
from gripperd.config.complaint import did_you_mean
from gripperd.config.section import Kilopascals, Rising, Section, Span, numbers
from gripperd.config.wording import shown
from gripperd.drivers.analog import InputWiring, OutputWiring, SensorWiring
from gripperd.drivers.bus import TcpAddress
from gripperd.model import Regulator
from gripperd.protocol.live_zero import LoopScale
from gripperd.protocol.modules import INPUTS, OUTPUTS, InputModule, OutputModule
from gripperd.units import MILLI

BENCH: Literal["bench"] = "bench"
"""Name of the bus of the simulated rig."""
ADDRESS = re.compile(r"(?:\[([0-9A-Fa-f:.]+)\]|([^\s:\[\]]+)):([0-9]{1,5})")


class Address(NamedTuple):
    """A host and a port."""

    host: str
    port: int


def _address(text: object) -> Address:
    found = ADDRESS.fullmatch(text) if isinstance(text, str) else None
    if not found or int(found[3]) > 65535:
        message = f'{shown(text)} is not "host:port" with a port of 0 to 65535'
        raise ValueError(message)
    return Address(found[1] or found[2], int(found[3]))


def _output(name: object) -> OutputModule:
    if not isinstance(name, str) or name not in OUTPUTS:
        hint = did_you_mean(str(name), OUTPUTS)
        message = f"{shown(name)} is not an output module; {hint}"
        raise ValueError(message)
    return OUTPUTS[name]


def _input(name: object) -> InputModule:
    if not isinstance(name, str) or name not in INPUTS:
        hint = did_you_mean(str(name), INPUTS)
        message = f"{shown(name)} is not an input module; {hint}"
        raise ValueError(message)
    return INPUTS[name]


def _check_channel(channel: int, module: OutputModule | InputModule | None) -> None:
    """Refuse a channel that a module does not have; None is a module not known."""
    if module is not None and channel >= module.channels:
        last = module.channels - 1
        message = f"channel {channel} is not one of {module.name}: 0 to {last}"
        raise ValueError(message)


HostPort: TypeAlias = Annotated[Address, PlainValidator(_address)]
Unit: TypeAlias = Annotated[int, Field(ge=1, le=247)]
"""Address of a Modbus server on a line (Modbus over serial line V1.02, 2.2)."""
Channel: TypeAlias = Annotated[int, Field(ge=0)]
LiveZero: TypeAlias = Annotated[float, Field(ge=3.6, le=21)]
"""What a working loop carries; anything else says that it is broken (NE 43). [mA]"""


class TcpSection(Section):
    """A Modbus TCP device or gateway."""

    tcp: HostPort
    timeout_ms: float = Field(default=200.0, gt=0, le=10_000)

    @property
    def address(self) -> TcpAddress:
        """The same for the driver."""
        return TcpAddress(host=self.tcp.host, port=self.tcp.port, **numbers(self))


BusName: TypeAlias = Annotated[
    Annotated[Literal["bench"], Tag("the bench")]
    | Annotated[TcpSection, Tag("a TCP bus")],
    Discriminator(lambda bus: "a TCP bus" if isinstance(bus, dict) else "the bench"),
]


class OutputSection(Section):
    """The channel that drives the valve."""

    module: Annotated[OutputModule, PlainValidator(_output)]
    unit: Unit
    channel: Channel

    @field_validator("channel")
    @classmethod
    def _exists(cls, channel: int, read: ValidationInfo) -> int:
        _check_channel(channel, read.data.get("module"))
        return channel

    @property
    def wiring(self) -> OutputWiring:
        """The same for the driver."""
        return OutputWiring(module=self.module, unit=self.unit, channel=self.channel)


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
    pressure: PressureSection | None = None
    opening: OpeningSection | None = None
    grip: GripSection | None = None

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

    @property
    def wiring(self) -> InputWiring:
        """The same for the driver."""
        return InputWiring(module=self.module, unit=self.unit, sensors=self.sensors)


def check_bench_output(output: OutputSection) -> None:
    """Refuse a valve where the simulated rig has none."""
    if output.channel != 0:
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


def check_driven(regulator: Regulator, module: OutputModule) -> None:
    """Refuse a valve whose upper end its output module cannot drive."""
    if regulator.current_high > module.highest:
        message = (
            f"valve.current_mA ends at {regulator.current_high / MILLI:g} mA,"
            f" {module.name} drives up to {module.highest / MILLI:g} mA"
        )
        raise ValueError(message)
