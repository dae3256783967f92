"""Registers and coils of a simulated module, in groups of one meaning."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from typing import TypeAlias

from gripperd.protocol.encoding import Range, Registers
from gripperd.protocol.modbus import Refusal, Table
from gripperd.protocol.modules import Module, Required, Status

Place: TypeAlias = tuple[Table, int]
Words: TypeAlias = Mapping[Place, int]
"""What stands, or is to stand, in some places."""


class Bank(ABC):
    """Places with one meaning."""

    places: Sequence[Place]

    @abstractmethod
    def read(self) -> Words:
        """What can be read of them."""

    def check(self, news: Words) -> Refusal | None:
        """Why some of them cannot be written, if so; unless told, none can."""
        return Refusal.ILLEGAL_ADDRESS

    def write(self, news: Words) -> None:  # noqa: B027  (nothing to take)
        """Take what was checked."""


class Fixed(Bank):
    """What never changes, such as the name of the module."""

    def __init__(self, registers: Registers, word: int) -> None:
        self.places = [(registers.table, registers.of(0))]
        self._word = word

    def read(self) -> Words:
        """What can be read of them."""
        return dict.fromkeys(self.places, self._word)


class RangeCodes(Bank):
    """The range of each channel."""

    def __init__(
        self,
        registers: Registers,
        module: Module,
        ranges: Sequence[Range],
        choose: Callable[[int, Range], None],
    ) -> None:
        self.places = [(registers.table, registers.of(c)) for c in range(len(ranges))]
        self._known = {r.code: r for r in module.ranges.values() if r.code is not None}
        self._ranges = ranges
        self._choose = choose

    def read(self) -> Words:
        """What can be read of them."""
        codes = (chosen.code or 0 for chosen in self._ranges)
        return dict(zip(self.places, codes, strict=True))

    def check(self, news: Words) -> Refusal | None:
        """Only ranges that are described."""
        known = all(code in self._known for code in news.values())
        return None if known else Refusal.ILLEGAL_VALUE

    def write(self, news: Words) -> None:
        """Take what was checked."""
        for channel, place in enumerate(self.places):
            if place in news:
                self._choose(channel, self._known[news[place]])


class Format(Fixed):
    """What a description requires; the bench knows the module in no other format."""

    def __init__(self, required: Required) -> None:
        super().__init__(required.registers, required.code)
        self._code = required.code

    def check(self, news: Words) -> Refusal | None:
        """Only what stands there already."""
        same = set(news.values()) == {self._code}
        return None if same else Refusal.ILLEGAL_VALUE


class Statuses(Bank):
    """What each channel says besides its value."""

    def __init__(
        self,
        registers: Registers,
        status: Status,
        channels: int,
        conditions: Callable[[Status], Sequence[int]],
    ) -> None:
        self._status = status
        self._conditions = conditions
        self._of = [
            [(registers.table, registers.of(c) + n) for n in range(status.words)]
            for c in range(channels)
        ]
        self.places = [place for places in self._of for place in places]

    def read(self) -> Words:
        """What can be read of them."""
        found = {}
        values = self._conditions(self._status)
        for value, places in zip(values, self._of, strict=True):
            for n, place in enumerate(places):
                found[place] = value >> 16 * n & 0xFFFF
        return found
