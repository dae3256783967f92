"""How a module writes a current down: ranges, counts and registers."""

import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from math import inf
from types import MappingProxyType

from gripperd.errors import InputError
from gripperd.protocol.modbus import Table
from gripperd.units import MILLI

ROUNDING = 1e-9
"""A current this close to a limit is at it: 20 mA is 20 * 1e-3. [A]"""


class ValueType(StrEnum):
    """What the registers of one channel hold."""

    U16 = "u16"
    S16 = "s16"
    F32 = "f32"
    """IEEE 754 binary32, in two registers."""


LIMITS: Mapping[ValueType, tuple[int, int]] = MappingProxyType(
    {ValueType.U16: (0, 0xFFFF), ValueType.S16: (-0x8000, 0x7FFF)}
)
"""Least and largest integer of a register."""


class WordOrder(StrEnum):
    """Which half of a float stands in the first register."""

    HIGH_FIRST = "high_first"
    LOW_FIRST = "low_first"


@dataclass(frozen=True, slots=True)
class Registers:
    """Where the channels of a module stand: 0-based PDU addresses."""

    table: Table
    address: int
    """Of channel 0."""
    stride: int = 1
    """From one channel to the next; 0 where all channels share one place."""

    def of(self, channel: int) -> int:
        """First register of a channel."""
        return self.address + self.stride * channel

    def __str__(self) -> str:
        """As a person would say it."""
        kind = self.table.name.lower()
        return f"{kind} {'' if self.table.of_bits else 'register '}{self.address}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Encoding:
    """Counts as registers."""

    type: ValueType = ValueType.U16
    word_order: WordOrder = WordOrder.HIGH_FIRST
    resolution: int = 1
    """Smallest step of an integer, a power of two: the bits below it are no value."""

    @property
    def words(self) -> int:
        """Registers of one value."""
        return 2 if self.type is ValueType.F32 else 1

    @property
    def limits(self) -> tuple[float, float]:
        """Least and largest count that the registers can hold.

        >>> Encoding(type=ValueType.S16, resolution=8).limits
        (-32768, 32760)
        """
        if self.type is ValueType.F32:
            return -inf, inf
        low, high = LIMITS[self.type]
        return low, high - high % self.resolution

    def encode(self, count: float) -> tuple[int, ...]:
        """Registers of a count, in the order of their addresses.

        >>> wago = Encoding(type=ValueType.S16, resolution=8)
        >>> wago.encode(13718.25)
        (13720,)
        """
        if self.type is ValueType.F32:
            return self._ordered(struct.unpack(">HH", struct.pack(">f", count)))
        return ((round(count / self.resolution) * self.resolution) & 0xFFFF,)

    def decode(self, words: Sequence[int]) -> float:
        """Count that the registers hold; a float may be not a number."""
        if self.type is ValueType.F32:
            pair = struct.pack(">HH", *self._ordered(words))
            return float(struct.unpack(">f", pair)[0])
        count = words[0]
        if self.type is ValueType.S16 and count >= 0x8000:
            count -= 0x10000
        return float(count - count % self.resolution)

    def _ordered(self, words: Sequence[int]) -> tuple[int, ...]:
        return tuple(words if self.word_order is WordOrder.HIGH_FIRST else words[::-1])


@dataclass(frozen=True, slots=True, kw_only=True)
class Range:
    """A range of a channel: a straight line between counts and current."""

    name: str
    current_low: float
    """[A]"""
    current_high: float
    """[A]"""
    count_low: float
    """Count at `current_low`."""
    count_high: float
    """Count at `current_high`."""
    code: int | None = None
    """What the range register says when this range is set."""

    def count(self, current: float) -> float:
        """Count of a current, not rounded."""
        share = (current - self.current_low) / (self.current_high - self.current_low)
        return self.count_low + share * (self.count_high - self.count_low)

    def current(self, count: float) -> float:
        """Current of a count; beyond the range the line goes on. [A]."""
        share = (count - self.count_low) / (self.count_high - self.count_low)
        return self.current_low + share * (self.current_high - self.current_low)

    def check(self, current: float, module: str) -> float:
        """Refuse a current that the range cannot give; it is not clamped. [A].

        Raises
        ------
        InputError
            It is outside, or no number.
        """
        low, high = self.current_low, self.current_high
        if not low - ROUNDING <= current <= high + ROUNDING:
            message = (
                f"{current / MILLI:g} mA is outside {low / MILLI:g} to"
                f" {high / MILLI:g} mA, the range of {module}"
            )
            raise InputError(message, key="current_mA")
        return min(max(current, low), high)

    @property
    def span(self) -> str:
        """As a person would say it."""
        ends = f"{self.current_low / MILLI:g} to {self.current_high / MILLI:g} mA"
        return f"{self.name} ({ends})"
