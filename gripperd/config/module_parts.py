"""Parts of a module description: ranges, places, status, vectors."""

# ruff: noqa: N815  (names carry units, and units have capitals)

import re
from typing import Annotated, TypeAlias

from pydantic import (
    AfterValidator,
    BeforeValidator,
    Field,
    PlainValidator,
)

from gripperd.config.complaint import did_you_mean
from gripperd.config.section import Name, Rising, Section, Span, numbers
from gripperd.config.wording import shown
from gripperd.protocol.encoding import (
    Encoding,
    Range,
    Registers,
    ValueType,
    WordOrder,
)
from gripperd.protocol.modbus import Table
from gripperd.protocol.modules import Condition, NameRegister, Required, Status

TABLES = {table.name.lower(): table for table in Table}
HEXADECIMAL = re.compile(r"0x[0-9A-Fa-f]{1,8}")
DECIMAL_KEY = re.compile(r"[0-9]{1,9}")


def _whole(value: object) -> object:
    """Manuals give registers in hexadecimal, and keys of a mapping are text."""
    if isinstance(value, str) and HEXADECIMAL.fullmatch(value):
        return int(value, 16)
    if isinstance(value, str) and DECIMAL_KEY.fullmatch(value):
        return int(value)
    return value


def _table(name: object) -> Table:
    if not isinstance(name, str) or name not in TABLES:
        message = f"{shown(name)} is not a table; {did_you_mean(str(name), TABLES)}"
        raise ValueError(message)
    return TABLES[name]


def _power_of_two(number: int) -> int:
    if number & (number - 1):
        message = f"{number} is not a power of two"
        raise ValueError(message)
    return number


Word: TypeAlias = Annotated[int, BeforeValidator(_whole), Field(ge=0, le=0xFFFF)]
"""A register, or what it holds, in decimal or as 0x..."""
Whole: TypeAlias = Annotated[int, BeforeValidator(_whole), Field(ge=0, le=0xFFFF_FFFF)]
"""What one or two registers hold."""
Bit: TypeAlias = Annotated[int, BeforeValidator(_whole), Field(ge=0, le=31)]
Sentence: TypeAlias = Annotated[str, Field(min_length=1, max_length=1000)]
TableName: TypeAlias = Annotated[Table, PlainValidator(_table)]


class RangeSection(Section):
    """One range of a channel."""

    current_mA: Rising[Annotated[float, Field(ge=-24, le=24)]]
    count: Span[Annotated[float, BeforeValidator(_whole)]] | None = Field(
        default=None, alias="counts"
    )
    """Without it the module counts in mA."""
    code: Word | None = None

    def range(self, name: str) -> Range:
        """The same for the driver."""
        low, high = self.count or self.current_mA
        ends = numbers(self)
        return Range(
            name=name,
            current_low=ends["current_low"],
            current_high=ends["current_high"],
            count_low=low,
            count_high=high,
            code=self.code,
        )


class VectorSection(Section):
    """What a current must become, from the manual or worked out by hand."""

    range: Name | None = None
    current_mA: float = Field(ge=-24, le=24)
    registers: list[Word] = Field(default_factory=list, max_length=2)
    text: str | None = Field(default=None, min_length=1, max_length=100)
    """With unit 1 and channel 0."""


class RegistersSection(Section):
    """Where something stands."""

    table: TableName = Table.HOLDING
    address: Word
    stride: int = Field(default=1, ge=0, le=1000)

    @property
    def registers(self) -> Registers:
        """The same for the driver."""
        return Registers(self.table, self.address, self.stride)


class ValuesSection(RegistersSection):
    """Where the currents stand, and how they are written."""

    type: Annotated[ValueType, Field(strict=False)]
    word_order: Annotated[WordOrder, Field(strict=False)] = WordOrder.HIGH_FIRST
    resolution: Annotated[int, Field(ge=1, le=1024), AfterValidator(_power_of_two)] = 1

    @property
    def encoding(self) -> Encoding:
        """The same for the driver."""
        return Encoding(
            type=self.type, word_order=self.word_order, resolution=self.resolution
        )


class ReadBackSection(RegistersSection):
    """Where the current can be read back."""

    echo: bool = True


class RequiredSection(RegistersSection):
    """A register that must hold one value, or the rest means something else."""

    stride: int = Field(default=0, ge=0, le=1000)
    code: Word
    meaning: Sentence

    @property
    def required(self) -> Required:
        """The same for the driver."""
        return Required(registers=self.registers, code=self.code, meaning=self.meaning)


class NameSection(RegistersSection):
    """The register in which a module says its type."""

    stride: int = Field(default=0, ge=0, le=1000)
    code: Word

    @property
    def type_name(self) -> NameRegister:
        """The same for the driver."""
        return NameRegister(self.registers, self.code)


class StatusSection(Section):
    """What is said about a channel besides its value."""

    table: TableName = Table.HOLDING
    address: Word | None = None
    """Without it the status stands in the value itself."""
    words: int = Field(default=1, ge=1, le=2)
    bits: dict[Bit, Sentence] = Field(default_factory=dict)
    codes: dict[Word, Sentence] = Field(default_factory=dict)
    fail_safe_bit: Bit | None = None
    signs: dict[Annotated[Condition, Field(strict=False)], Whole] = Field(
        default_factory=dict
    )
    """What the whole status is when a loop is open, under or over its range."""

    @property
    def status(self) -> Status:
        """The same for the driver."""
        registers = None
        if self.address is not None:
            registers = Registers(self.table, self.address, self.words)
        return Status(
            registers=registers,
            words=self.words,
            bits=self.bits,
            codes=self.codes,
            fail_safe=self.fail_safe_bit,
            signs=self.signs,
        )
