"""Registers of a communication watchdog."""

from collections.abc import Iterator

from gripperd.bench.banks import Bank, Place, Words
from gripperd.bench.host_watchdog import HostWatchdog
from gripperd.protocol.modbus import Refusal, Table
from gripperd.protocol.watchdog import RegisterWatchdog, Setting


class WatchdogBank(Bank):
    """Time-out, arming, keeping, signs and clearing of one watchdog.

    Parameters
    ----------
    described
        Where all that stands.
    clock
        What trips.
    """

    def __init__(self, described: RegisterWatchdog, clock: HostWatchdog) -> None:
        self._described = described
        self._clock = clock
        self._clear = described.clear
        self._time: Place = (Table.HOLDING, described.time)
        self._written = dict.fromkeys(map(_place, described.arm), 0)
        self._steps = 0
        self._kept = dict.fromkeys(map(_place, described.keep), 0)
        self.places = list(dict.fromkeys(self._all()))

    def read(self) -> Words:
        """What can be read of them."""
        found = dict.fromkeys(self.places, 0) | self._kept
        found |= {self._time: self._steps}
        if self._clock.timeout is not None:
            found |= self._written | _said(self._described.armed)
        if self._clock.tripped:
            found |= _said(self._described.tripped)
        return found

    def check(self, news: Words) -> Refusal | None:
        """The time-out of a running watchdog stays, as on a WAGO coupler."""
        if self._time in news and self._clock.timeout is not None:
            return Refusal.ILLEGAL_VALUE
        writable = {self._time, *self._written, *self._kept, *_said(self._clear)}
        return None if news.keys() <= writable else Refusal.ILLEGAL_ADDRESS

    def write(self, news: Words) -> None:
        """Take what was checked."""
        self._steps = news.get(self._time, self._steps)
        if _said(self._clear).items() & news.items():
            self._clock.clear()
        if self._kept.keys() & news.keys():
            self._kept |= {p: news[p] for p in self._kept if p in news}
            self._clock.hear()
        if self._written.keys() & news.keys():
            self._written |= {p: news[p] for p in self._written if p in news}
            self._arm()

    def _arm(self) -> None:
        wanted = {_place(setting): setting.value for setting in self._described.arm}
        if self._written == wanted and self._steps:
            self._clock.arm(self._steps * self._described.step)
        else:
            self._clock.disarm()

    def _all(self) -> Iterator[Place]:
        yield self._time
        yield from self._written
        yield from self._kept
        for setting in (self._described.armed, self._described.tripped, self._clear):
            yield from _said(setting)


def _place(setting: Setting) -> Place:
    return setting.table, setting.address


def _said(setting: Setting | None) -> dict[Place, int]:
    return {} if setting is None else {_place(setting): setting.value}
