"""Communication watchdogs: what a module does when its host falls silent."""

from abc import ABC, abstractmethod
from dataclasses import dataclass

from gripperd.protocol.encoding import Registers
from gripperd.protocol.modbus import Request, Table, Write, WriteCoil
from gripperd.protocol.phrase import Phrase


@dataclass(frozen=True, slots=True)
class Setting:
    """A register or coil, and a value that it may hold."""

    table: Table
    address: int
    value: int

    def write(self, unit: int) -> Request:
        """Request that gives it the value."""
        if self.table is Table.COILS:
            return WriteCoil(unit, self.address, on=bool(self.value))
        return Write(unit, self.address, (self.value,))

    def __str__(self) -> str:
        """As a person would say it."""
        return f"{Registers(self.table, self.address)} = {self.value}"


RESET = "clear it with the maker's utility, or switch the module off and on"
"""What a person can do where no description says how a trip is cleared."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Watchdog(ABC):
    """What every watchdog has, whatever is spoken."""

    step: float
    """Unit of the time-out. [s]"""
    longest: float
    """Longest time-out. [s]"""
    acts: str
    """What the module does on time-out, for a person."""
    survives_power_cycle: bool = False
    """Whether a trip outlives a power cycle."""
    safe_current: float | None = None
    """Output on time-out where the module has no choice. [A]"""

    @property
    @abstractmethod
    def remedy(self) -> str:
        """How a person clears it once it has tripped."""

    def steps(self, timeout: float) -> int:
        """Time-out as the module counts it."""
        return round(timeout / self.step)


@dataclass(frozen=True, slots=True, kw_only=True)
class RegisterWatchdog(Watchdog):
    """A watchdog set by registers."""

    time: int
    """Holding register of the time-out."""
    arm: tuple[Setting, ...]
    """Written in this order once the time-out is set."""
    armed: Setting | None = None
    """Holds while it is armed."""
    tripped: Setting | None = None
    """Holds once it has tripped."""
    clear: Setting | None = None
    """Written by a person, it clears a trip."""
    keep: tuple[Setting, ...] = ()
    """Written to keep it quiet; nothing where every request does."""

    @property
    def remedy(self) -> str:
        """How a person clears it once it has tripped."""
        if self.clear is None:
            return RESET
        place = Registers(self.clear.table, self.clear.address)
        return f"write {self.clear.value} to {place} (0x{self.clear.address:04X})"


@dataclass(frozen=True, slots=True, kw_only=True)
class PhraseWatchdog(Watchdog):
    """A watchdog set by lines of text."""

    arm: Phrase
    armed: Phrase | None = None
    """Asks for the time-out; the reply says that it is armed."""
    status: Phrase | None = None
    tripped: int = 0
    """Bits of the status, one of which is set once it has tripped."""
    clear: Phrase | None = None
    """Sent by a person, it clears a trip."""
    keep: Phrase | None = None
    """Sent to keep it quiet; None where every request does."""
    digits: int = 2
    """Of the time-out in a line."""
    radix: int = 16
    """Of the time-out in a line: 10 or 16."""

    @property
    def remedy(self) -> str:
        """How a person clears it once it has tripped."""
        return RESET if self.clear is None else f"send {self.clear}"

    def time_text(self, timeout: float) -> str:
        """Time-out the way a line has it.

        >>> hexadecimal = PhraseWatchdog(step=0.1, longest=25.5, acts="",
        ...                              arm=Phrase("~{unit}31{time}"))
        >>> hexadecimal.time_text(2.0)
        '14'
        """
        form = "X" if self.radix == 16 else "d"
        return f"{self.steps(timeout):0{self.digits}{form}}"
