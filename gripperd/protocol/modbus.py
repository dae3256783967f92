"""What can be asked of a Modbus device, whatever line it is on.

References
----------
.. [1] MODBUS Application Protocol Specification V1.1b3.
"""

from dataclasses import dataclass
from enum import IntEnum
from typing import TypeAlias

from gripperd.errors import InputError

WRITE_COIL = 5
WRITE_REGISTER = 6
WRITE_REGISTERS = 16
"""Function codes of the writes ([1], sections 6.5, 6.6 and 6.12)."""

MOST_WRITTEN = 123
"""Registers that one request can write ([1], section 6.12)."""


class Table(IntEnum):
    """What is read; the value is the function code ([1], sections 6.1 to 6.4)."""

    COILS = 1
    DISCRETE = 2
    HOLDING = 3
    INPUT = 4

    of_bits: bool
    """Whether it holds bits, not registers."""
    most: int
    """Bits or registers that one request can read."""

    def __init__(self, function: int) -> None:
        self.of_bits = function <= 2
        self.most = 2000 if self.of_bits else 125


class Refusal(IntEnum):
    """Exception codes ([1], section 7)."""

    ILLEGAL_FUNCTION = 1
    ILLEGAL_ADDRESS = 2
    ILLEGAL_VALUE = 3
    DEVICE_FAILURE = 4
    ACKNOWLEDGE = 5
    BUSY = 6
    MEMORY_PARITY = 8
    NO_PATH = 10
    NO_RESPONSE = 11


@dataclass(frozen=True, slots=True)
class Read:
    """Read consecutive registers, at most 125, or bits, at most 2000.

    Raises
    ------
    InputError
        A number does not fit in its field of the request.
    """

    unit: int
    table: Table
    address: int
    count: int = 1

    def __post_init__(self) -> None:
        _check(self.unit, self.address)
        if not 1 <= self.count <= self.table.most:
            message = (
                f"{self.count} {self.table.name.lower()} cannot be read in one request:"
                f" 1 to {self.table.most} can"
            )
            raise InputError(message, key="count")

    @property
    def function(self) -> int:
        """Function code."""
        return self.table

    def __str__(self) -> str:
        """As a person would say it."""
        what = self.table.name.lower()
        what = what if self.table.of_bits else f"{what} register(s)"
        return f"read {self.count} {what} at {self.address} of unit {self.unit}"


@dataclass(frozen=True, slots=True)
class Write:
    """Write consecutive holding registers, at most 123.

    Raises
    ------
    InputError
        A number does not fit in its field of the request.
    """

    unit: int
    address: int
    values: tuple[int, ...]
    multiple: bool = False
    """Function 16 even for one register: its reply differs from the request, which
    that of function 6 does not; several registers always take function 16."""

    def __post_init__(self) -> None:
        _check(self.unit, self.address)
        if not 1 <= len(self.values) <= MOST_WRITTEN:
            message = (
                f"{len(self.values)} registers cannot be written in one request:"
                f" 1 to {MOST_WRITTEN} can"
            )
            raise InputError(message, key="values")
        for value in self.values:
            if not 0 <= value <= 0xFFFF:
                message = f"{value} does not fit in a register: 0 to 65535 does"
                raise InputError(message, key="values")

    @property
    def function(self) -> int:
        """Function code."""
        several = self.multiple or len(self.values) > 1
        return WRITE_REGISTERS if several else WRITE_REGISTER

    def __str__(self) -> str:
        """As a person would say it."""
        values = ", ".join(map(str, self.values))
        return f"write {values} to holding register {self.address} of unit {self.unit}"


@dataclass(frozen=True, slots=True)
class WriteCoil:
    """Set or clear one coil.

    Raises
    ------
    InputError
        A number does not fit in its field of the request.
    """

    unit: int
    address: int
    on: bool

    def __post_init__(self) -> None:
        _check(self.unit, self.address)

    @property
    def function(self) -> int:
        """Function code."""
        return WRITE_COIL

    def __str__(self) -> str:
        """As a person would say it."""
        verb = "set" if self.on else "clear"
        return f"{verb} coil {self.address} of unit {self.unit}"


Request: TypeAlias = Read | Write | WriteCoil


def _check(unit: int, address: int) -> None:
    if not 0 <= unit <= 0xFF:
        message = f"unit {unit} is no Modbus unit: 0 to 255 is"
        raise InputError(message, key="unit")
    if not 0 <= address <= 0xFFFF:
        message = f"address {address} is no Modbus address: 0 to 65535 is"
        raise InputError(message, key="address")
