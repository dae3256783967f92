"""Channels of a module behind whatever it speaks: what it puts out or measures."""

from collections.abc import Callable, Sequence

from gripperd.bench.host_watchdog import HostWatchdog
from gripperd.protocol.encoding import Range
from gripperd.protocol.live_zero import BROKEN_ABOVE, BROKEN_BELOW
from gripperd.protocol.modules import Condition, InputModule, OutputModule, Status
from gripperd.protocol.watchdog import Watchdog


class Outputs:
    """Channels of an output module.

    Parameters
    ----------
    module
        Its description.
    now
        Time of the bench. [s]
    drive
        Told the current of channel 0 whenever it is set. [A]
    range_name
        Range of every channel; None takes the first of the module.
    """

    def __init__(
        self,
        module: OutputModule,
        now: Callable[[], float],
        drive: Callable[[float], None],
        range_name: str | None = None,
    ) -> None:
        chosen, watchdog = module.range(range_name), _watchdog(module)
        safe = watchdog.safe_current if watchdog else None
        # Where a description gives no number: the least current of the range.
        least = max(chosen.current_low, 0.0)
        known = module.power_on_current
        self.module = module
        self.ranges = [chosen] * module.channels
        self.power_on = [least if known is None else known] * module.channels
        """What each channel starts with. [A]"""
        self.safe = [least if safe is None else safe] * module.channels
        """What each channel goes to when the watchdog trips. [A]"""
        self.watchdog = HostWatchdog(now)
        self._trip_lasts = watchdog is not None and watchdog.survives_power_cycle
        self._drive = drive
        self._loop_open = False
        self._currents = list(self.power_on)
        self._drive_valve()

    @property
    def loop_open(self) -> bool:
        """Whether the wire of channel 0 is cut: set, and not delivered."""
        return self._loop_open

    @loop_open.setter
    def loop_open(self, cut: bool) -> None:
        self._loop_open = cut
        self._drive_valve()

    def currents(self) -> Sequence[float]:
        """What each channel is set to. [A]."""
        return self._currents

    def delivered(self) -> Sequence[float]:
        """What each channel gives. [A]."""
        return [0.0 if self._loop_open else self._currents[0], *self._currents[1:]]

    def put_out(self, channel: int, current: float) -> None:
        """Set a channel. [A]."""
        self._currents[channel] = current
        if channel == 0:
            self._drive_valve()

    def choose(self, channel: int, chosen: Range) -> None:
        """Set a range; the count stays what it is, so that the current changes."""
        count = self.ranges[channel].count(self._currents[channel])
        self.ranges[channel] = chosen
        self.put_out(channel, chosen.current(count))

    def trip(self) -> None:
        """Take every channel to its safe value, and latch."""
        self.watchdog.trip()
        self._set_all(self.safe)

    def power_cycle(self) -> None:
        """Lose power and get it back; what was armed is not."""
        self.watchdog.disarm()
        if not self._trip_lasts:
            self.watchdog.clear()
        self._set_all(self.safe if self.watchdog.tripped else self.power_on)

    def conditions(self, status: Status) -> Sequence[int]:
        """Status of each channel."""
        safe = self.watchdog.tripped and status.fail_safe is not None
        common = 1 << (status.fail_safe or 0) if safe else 0
        cut = status.signs.get(Condition.OPEN, 0) if self._loop_open else 0
        return [common | cut, *[common] * (self.module.channels - 1)]

    def _set_all(self, currents: Sequence[float]) -> None:
        self._currents[:] = currents
        self._drive_valve()

    def _drive_valve(self) -> None:
        self._drive(self.delivered()[0])


class Inputs:
    """Channels of an input module.

    Parameters
    ----------
    module
        Its description.
    measure
        Loop currents of its first channels; the others carry nothing. [A]
    range_name
        Range of every channel; None takes the first of the module.
    """

    def __init__(
        self,
        module: InputModule,
        measure: Callable[[], Sequence[float]],
        range_name: str | None = None,
    ) -> None:
        self.module = module
        self.ranges = [module.range(range_name)] * module.channels
        self._measure = measure

    def currents(self) -> Sequence[float]:
        """What each channel measures now. [A]."""
        found = self._measure()[: self.module.channels]
        return [*found, *[0.0] * (self.module.channels - len(found))]

    def choose(self, channel: int, chosen: Range) -> None:
        """Set a range."""
        self.ranges[channel] = chosen

    def power_cycle(self) -> None:
        """Lose power and get it back: a range is kept."""

    def condition(self, status: Status, channel: int, current: float) -> int:
        """Status of a channel at a current; 0 while the loop is sound. [A].

        The limits are those of NAMUR NE 43; modules have limits of their own.
        """
        # A range that begins at 0 mA knows no broken loop.
        if self.ranges[channel].current_low <= 0.0:
            return 0
        if current < BROKEN_BELOW:
            under = status.signs.get(Condition.UNDER, 0)
            return status.signs.get(Condition.OPEN, under)
        return status.signs.get(Condition.OVER, 0) if current > BROKEN_ABOVE else 0

    def conditions(self, status: Status) -> Sequence[int]:
        """Status of each channel now."""
        currents = enumerate(self.currents())
        return [self.condition(status, channel, each) for channel, each in currents]


def _watchdog(module: OutputModule) -> Watchdog | None:
    if module.modbus is not None and module.modbus.watchdog is not None:
        return module.modbus.watchdog
    spoken = (phrases.watchdog for phrases in module.phrases.values())
    return next(filter(None, spoken), None)
