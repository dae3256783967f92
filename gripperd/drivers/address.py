"""Where a bus is found, and how long one request may keep it."""

from dataclasses import dataclass
from typing import Literal, TypeAlias

Parity: TypeAlias = Literal["N", "E", "O"]
"""None, even, odd."""

LONGEST_DRAIN = 2
"""A serial line that is not quiet after so many time-outs is reopened. [-]"""


@dataclass(frozen=True, slots=True, kw_only=True)
class TcpAddress:
    """Where a Modbus TCP device or gateway listens."""

    host: str
    port: int
    timeout: float = 0.2
    """Longest wait for a reply. [s]"""

    def __str__(self) -> str:
        """As in a configuration file."""
        return f"{self.host}:{self.port}"

    @property
    def longest_turn(self) -> float:
        """Longest time for which one request keeps all others waiting. [s]."""
        return self.timeout


@dataclass(frozen=True, slots=True, kw_only=True)
class SerialAddress:
    """A serial port, and how characters travel on it; use one of its kinds below."""

    port: str
    """Path of the device; one under ``/dev/serial/by-id`` survives a replug."""
    baud: int = 9600
    parity: Parity = "N"
    stop_bits: Literal[1, 2] = 1
    data_bits: Literal[7, 8] = 8
    timeout: float = 0.25
    """Longest wait for a reply, sending included; as long must the line have been
    quiet before a request that follows a failed one. [s]"""
    silence: float | None = None
    """Pause on the line before every request; None takes what the grammar asks. [s]"""

    def __str__(self) -> str:
        """As in a configuration file."""
        return self.port

    @property
    def longest_turn(self) -> float:
        """Longest time for which one request keeps all others waiting. [s]."""
        # For silence, for the reply, and for a line that has to be drained.
        return (1 + 1 + LONGEST_DRAIN) * self.timeout


@dataclass(frozen=True, slots=True, kw_only=True)
class RtuAddress(SerialAddress):
    """Modbus RTU."""

    local_echo: bool = False
    """Whether the port hears what it sends, as some RS-485 converters do."""


@dataclass(frozen=True, slots=True, kw_only=True)
class DconAddress(SerialAddress):
    """ASCII of ICP DAS, Advantech and their like."""

    local_echo: bool = False
    """Whether the port hears what it sends, as some RS-485 converters do."""
    checksum: bool = False
    """Whether every line carries two digits of checksum."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ItvAddress(SerialAddress):
    """ASCII of SMC regulators."""


Address: TypeAlias = TcpAddress | RtuAddress | DconAddress | ItvAddress
