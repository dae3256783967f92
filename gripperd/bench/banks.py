"""Registers and coils of a simulated module, in groups of one meaning."""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from typing import TypeAlias

from gripperd.protocol.encoding import (
    ROUNDING,
    Encoding,
    Range,
    Registers,
    ValueType,
)
from gripperd.protocol.modbus import Refusal, Table
from gripperd.protocol.modules import Module, Required, Status

Place: TypeAlias = tuple[Table, int]
Words: TypeAlias = Mapping[Place, int]
"""What stands, or is to stand, in some places."""

LIMITS = {ValueType.U16: (0, 0xFFFF), ValueType.S16: (-0x8000, 0x7FFF)}
"""Least and largest count of a register."""


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


class Currents(Bank):
    """The current of each channel, to be read.

    Parameters
    ----------
    registers, encoding
        Where and how it stands.
    ranges
        Of the channels; they may change.
    currents
        Gives them. [A]
    mark
        Puts how a channel is into its word, given its number and its current. [A]
    """

    def __init__(
        self,
        registers: Registers,
        encoding: Encoding,
        ranges: Sequence[Range],
        currents: Callable[[], Sequence[float]],
        mark: Callable[[int, float, int], int] | None = None,
    ) -> None:
        self._encoding = encoding
        self._ranges = ranges
        self._currents = currents
        self._mark = mark
        self._of = [
            [(registers.table, registers.of(c) + n) for n in range(encoding.words)]
            for c in range(len(ranges))
        ]
        self.places = [place for places in self._of for place in places]

    def read(self) -> Words:
        """What can be read of them."""
        found: dict[Place, int] = {}
        for channel, current in enumerate(self._currents()):
            words = self._words(channel, current)
            if self._mark is not None:
                words = [self._mark(channel, current, word) for word in words]
            found.update(zip(self._of[channel], words, strict=True))
        return found

    def _words(self, channel: int, current: float) -> Sequence[int]:
        count = self._ranges[channel].count(current)
        if self._encoding.type in LIMITS:
            low, high = LIMITS[self._encoding.type]
            count = min(max(count, low), high)
        return self._encoding.encode(count)


class SetPoints(Currents):
    """The current of each channel, to be written.

    Parameters
    ----------
    registers, encoding, ranges, currents
        As for :class:`Currents`.
    put
        Sets one of them. [A]
    locked
        Tells whether the module ignores its host.
    """

    def __init__(
        self,
        registers: Registers,
        encoding: Encoding,
        ranges: Sequence[Range],
        currents: Callable[[], Sequence[float]],
        put: Callable[[int, float], None],
        locked: Callable[[], bool],
    ) -> None:
        super().__init__(registers, encoding, ranges, currents)
        self._put = put
        self._locked = locked

    def check(self, news: Words) -> Refusal | None:
        """A float takes both of its registers at once; nothing is clamped."""
        if self._locked():
            return Refusal.DEVICE_FAILURE
        asked = self._asked(news)
        if any(math.isnan(current) for current in asked.values()):
            return Refusal.ILLEGAL_VALUE
        for channel, current in asked.items():
            chosen = self._ranges[channel]
            low, high = chosen.current_low - ROUNDING, chosen.current_high + ROUNDING
            if not low <= current <= high:
                return Refusal.ILLEGAL_VALUE
        return None

    def write(self, news: Words) -> None:
        """Take what was checked."""
        for channel, current in self._asked(news).items():
            chosen = self._ranges[channel]
            within = min(max(current, chosen.current_low), chosen.current_high)
            self._put(channel, within)

    def _asked(self, news: Words) -> Mapping[int, float]:
        """Current of each channel that is written, not a number where one is cut."""
        asked = {}
        for channel, places in enumerate(self._of):
            words = [news[place] for place in places if place in news]
            if len(words) == len(places):
                count = self._encoding.decode(words)
                asked[channel] = self._ranges[channel].current(count)
            elif words:
                asked[channel] = math.nan
        return asked


class WriteOnly(SetPoints):
    """Set-points that stand elsewhere when they are read."""

    def read(self) -> Words:
        """Nothing."""
        return {}


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


class Format(Bank):
    """What a description requires; the bench knows the module in no other format."""

    def __init__(self, required: Required) -> None:
        self.places = [(required.registers.table, required.registers.of(0))]
        self._code = required.code

    def read(self) -> Words:
        """What can be read of them."""
        return dict.fromkeys(self.places, self._code)

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
