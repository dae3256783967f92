"""Checks of the module that drives the valve. Only reads."""

from abc import ABC, abstractmethod
from collections.abc import Awaitable, Callable, Mapping
from typing import TypeAlias

from gripperd.doctor.finding import Result
from gripperd.drivers.facts import KEEPS, watchdog_of
from gripperd.drivers.wiring import OutputWiring
from gripperd.units import MILLI

Step: TypeAlias = Callable[[], Awaitable[Result]]

SAME = 0.5e-6
"""Half the last digit in which a module tells a current. [A]"""
ARM_IT = "arm it with `watchdog: {timeout_s: ...}` in the settings"
RIGHT_MODULE = "see on the label whether this is the module that the settings name"


class OutputCheck(ABC):
    """What can be asked of an output module; what it does not tell is said so."""

    def __init__(self, wiring: OutputWiring) -> None:
        self.wiring = wiring

    @property
    def steps(self) -> Mapping[str, Step]:
        """Every check by its name; the first tells whether there is a link."""
        return {
            "set-point read-back": self.read_back,
            "output range": self.range,
            "output status": self.status,
            "watchdog": self.watchdog,
            "safe value": self.safe_value,
        }

    async def read_back(self) -> Result:
        """Whether the current that is set can be one of the valve."""
        current = await self.current()
        low, high = self.wiring.range.current_low, self.wiring.range.current_high
        said = f"{current / MILLI:.3f} mA"
        if low - SAME <= current <= high + SAME:
            return Result.ok(said)
        span = f"{low / MILLI:g} to {high / MILLI:g} mA"
        return Result.failed(f"{said} is outside {span}", RIGHT_MODULE)

    async def range(self) -> Result:
        """Whether the module has the range that is expected."""
        return self.silent("which range it has")

    async def status(self) -> Result:
        """What the module says against its output, such as an open loop."""
        return self.silent("whether its loop is open")

    async def watchdog(self) -> Result:
        """Whether it acts when the daemon falls silent, and whether it has."""
        remedy = "expect the last current to stay when the daemon or the bus dies"
        return Result.warning(f"none: {KEEPS}", remedy)

    async def safe_value(self) -> Result:
        """What it puts out on time-out."""
        watchdog = watchdog_of(self.wiring)
        if watchdog is not None and watchdog.safe_current is not None:
            return Result.ok(f"always {watchdog.safe_current / MILLI:g} mA")
        return self.silent("its safe value")

    @abstractmethod
    async def current(self) -> float:
        """The current that is set. [A]."""

    def silent(self, what: str) -> Result:
        """Result for what the module does not tell."""
        said = f"{self.wiring.module.name} does not tell {what}"
        return Result.not_possible(said, "see it on the module, or measure it")

    def compared(self, found: float) -> Result:
        """Result for a safe value, against what is asked for. [A]."""
        asked = self.wiring.watchdog.safe_current if self.wiring.watchdog else None
        said = f"{found / MILLI:.3f} mA"
        if asked is None or abs(found - asked) <= SAME:
            return Result.ok(said)
        remedy = "let the daemon set it, or set it with the maker's utility"
        return Result.warning(f"{said}, the settings want {asked / MILLI:g} mA", remedy)

    def armed(self, *, armed: bool) -> Result:
        """Result for a watchdog that has not tripped."""
        asked = self.wiring.watchdog.timeout if self.wiring.watchdog else None
        if armed:
            return Result.ok("armed")
        if asked is not None:
            return Result.ok(f"not armed yet; the daemon arms it with {asked:g} s")
        return Result.warning(f"not armed: {KEEPS}", ARM_IT)


def mismatched(said: str, *, set_range: bool) -> Result:
    """Result for a module that has another range than the settings say."""
    if set_range:
        remedy = "nothing: the daemon sets it, since the settings say set_range"
        return Result.warning(said, remedy)
    return Result.failed(said, "change the module or the settings until they agree")


def tripped(remedy: str) -> Result:
    """Result for a watchdog that has tripped."""
    said = "tripped: the output is at its safe value, and nothing is written"
    return Result.failed(said, f"see why the host was silent, then clear it: {remedy}")
