"""Which ways of asking are tried on a line, and how long that takes."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum

from gripperd.drivers.address import (
    Address,
    DconAddress,
    ItvAddress,
    Parity,
    RtuAddress,
    TcpAddress,
)

BAUDS = (9600, 19_200, 38_400, 115_200)
"""What modules are shipped with and commonly set to; most leave the factory at 9600."""
PARITIES: tuple[Parity, ...] = ("N", "E")
"""Of Modbus RTU; the lines of text are without parity on every module described."""
FACTORY_BAUD = 9600
"""That of an ITV cannot be changed."""
REOPENING = 0.2
"""A TCP connection is opened anew after each unit that is silent. [s]"""


class Protocol(StrEnum):
    """What may be spoken on a serial line, as the settings file has it."""

    RTU = "rtu"
    DCON = "dcon"
    ITV = "itv"


@dataclass(frozen=True, slots=True)
class Attempt:
    """One way of asking, and whom."""

    address: Address
    units: tuple[int, ...]

    @property
    def longest(self) -> float:
        """Longest time that it takes while nobody answers. [s]."""
        timeout = self.address.timeout
        if isinstance(self.address, TcpAddress):
            return len(self.units) * (timeout + REOPENING)
        # A silent unit costs its time-out and the silence after it.
        return timeout + len(self.units) * 2 * timeout

    def __str__(self) -> str:
        """As a person would say it."""
        match self.address:
            case TcpAddress():
                return f"Modbus TCP at {self.address}"
            case RtuAddress(baud=baud, parity=parity):
                return f"Modbus RTU at {baud} Bd, parity {parity}"
            case DconAddress(baud=baud):
                return f"DCON at {baud} Bd"
            case ItvAddress(baud=baud):
                return f"ITV at {baud} Bd"


@dataclass(frozen=True, slots=True, kw_only=True)
class SerialSearch:
    """Everything that is to be tried on a serial port.

    The search ends with the first attempt that anybody answers: a line has one speed.
    """

    port: str
    units: tuple[int, ...]
    timeout: float
    """Wait for each reply. [s]"""
    bauds: Sequence[int] = BAUDS
    parities: Sequence[Parity] = PARITIES
    protocols: Sequence[Protocol] = tuple(Protocol)

    @property
    def attempts(self) -> Iterator[Attempt]:
        """In the order of what is likely."""
        for baud in self.bauds:
            for parity in self.parities:
                if Protocol.RTU in self.protocols:
                    yield Attempt(self._rtu(baud, parity), self.units)
                if Protocol.DCON in self.protocols and parity == self.parities[0]:
                    yield Attempt(self._dcon(baud), self.units)
            if Protocol.ITV in self.protocols and baud == FACTORY_BAUD:
                itv = ItvAddress(port=self.port, baud=baud, timeout=self.timeout)
                yield Attempt(itv, (0,))

    def _rtu(self, baud: int, parity: Parity) -> RtuAddress:
        return RtuAddress(
            port=self.port, baud=baud, parity=parity, timeout=self.timeout
        )

    def _dcon(self, baud: int) -> DconAddress:
        return DconAddress(port=self.port, baud=baud, timeout=self.timeout)
