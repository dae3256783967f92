"""Registers of a simulated module that hold currents."""

import math
from collections.abc import Callable, Mapping, Sequence

from gripperd.bench.banks import Bank, Place, Words
from gripperd.bench.channels import Outputs
from gripperd.protocol.encoding import (
    LIMITS,
    ROUNDING,
    Encoding,
    Range,
    Registers,
)
from gripperd.protocol.modbus import Refusal
from gripperd.protocol.modules import Beyond, OutputMap


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
    """

    clamping = False
    """Whether a current outside the range becomes the nearest inside, untold."""

    def __init__(
        self,
        registers: Registers,
        encoding: Encoding,
        ranges: Sequence[Range],
        currents: Callable[[], Sequence[float]],
        put: Callable[[int, float], None],
    ) -> None:
        super().__init__(registers, encoding, ranges, currents)
        self._put = put

    def check(self, news: Words) -> Refusal | None:
        """A float takes both of its registers at once."""
        asked = self._asked(news)
        if not all(map(math.isfinite, asked.values())):
            return Refusal.ILLEGAL_VALUE
        return None if self.clamping else self._beyond(asked)

    def _beyond(self, asked: Mapping[int, float]) -> Refusal | None:
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


class Outlets(SetPoints):
    """Set-points that drive something, and that a tripped watchdog locks.

    Parameters
    ----------
    outputs
        The module.
    described
        Where and how they stand; read back elsewhere, they cannot be read here.
    """

    def __init__(self, outputs: Outputs, described: OutputMap) -> None:
        super().__init__(
            described.values,
            described.encoding,
            outputs.ranges,
            outputs.currents,
            outputs.put_out,
        )
        self.clamping = described.beyond_range is not Beyond.REFUSED
        self._watchdog = outputs.watchdog
        self._readable = described.read_back == described.values

    def read(self) -> Words:
        """What can be read of them."""
        return super().read() if self._readable else {}

    def check(self, news: Words) -> Refusal | None:
        """Nothing is taken until a trip is cleared."""
        if self._watchdog.tripped:
            return Refusal.DEVICE_FAILURE
        return super().check(news)
