"""Checks of the module that drives the valve. Only reads."""

from abc import ABC, abstractmethod
from collections.abc import Awaitable, Callable, Mapping
from typing import TypeAlias

from gripperd.doctor.finding import Result
from gripperd.drivers.bus import DconBus, ItvBus, ModbusBus
from gripperd.drivers.facts import KEEPS, watchdog_of
from gripperd.drivers.registers import Unit, check_setup
from gripperd.drivers.wiring import OutputWiring
from gripperd.errors import BadReply, ModuleMismatch
from gripperd.protocol.encoding import Registers
from gripperd.protocol.engineering import from_engineering
from gripperd.protocol.itv import Query
from gripperd.protocol.modbus import Table
from gripperd.protocol.modules import OutputMap, OutputPhrases
from gripperd.protocol.phrase import CURRENT, Phrase
from gripperd.protocol.watchdog import PhraseWatchdog, RegisterWatchdog
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
        current = await self._current()
        low, high = self.wiring.range.current_low, self.wiring.range.current_high
        said = f"{current / MILLI:.3f} mA"
        if low - SAME <= current <= high + SAME:
            return Result.ok(said)
        span = f"{low / MILLI:g} to {high / MILLI:g} mA"
        return Result.failed(f"{said} is outside {span}", RIGHT_MODULE)

    async def range(self) -> Result:
        """Whether the module has the range that is expected."""
        return self._silent("which range it has")

    async def status(self) -> Result:
        """What the module says against its output, such as an open loop."""
        return self._silent("whether its loop is open")

    async def watchdog(self) -> Result:
        """Whether it acts when the daemon falls silent, and whether it has."""
        remedy = "expect the last current to stay when the daemon or the bus dies"
        return Result.warning(f"none: {KEEPS}", remedy)

    async def safe_value(self) -> Result:
        """What it puts out on time-out."""
        watchdog = watchdog_of(self.wiring)
        if watchdog is not None and watchdog.safe_current is not None:
            return Result.ok(f"always {watchdog.safe_current / MILLI:g} mA")
        return self._silent("its safe value")

    @abstractmethod
    async def _current(self) -> float:
        """The current that is set. [A]."""

    def _silent(self, what: str) -> Result:
        said = f"{self.wiring.module.name} does not tell {what}"
        return Result.not_possible(said, "see it on the module, or measure it")

    def _compared(self, found: float) -> Result:
        """Result for a safe value, against what is asked for. [A]."""
        asked = self.wiring.watchdog.safe_current if self.wiring.watchdog else None
        said = f"{found / MILLI:.3f} mA"
        if asked is None or abs(found - asked) <= SAME:
            return Result.ok(said)
        remedy = "let the daemon set it, or set it with the maker's utility"
        return Result.warning(f"{said}, the settings want {asked / MILLI:g} mA", remedy)

    def _armed(self, *, armed: bool) -> Result:
        """Result for a watchdog that has not tripped."""
        asked = self.wiring.watchdog.timeout if self.wiring.watchdog else None
        if armed:
            return Result.ok("armed")
        if asked is not None:
            return Result.ok(f"not armed yet; the daemon arms it with {asked:g} s")
        return Result.warning(f"not armed: {KEEPS}", ARM_IT)


class RegisterOutputCheck(OutputCheck):
    """Of a Modbus module."""

    def __init__(self, bus: ModbusBus, wiring: OutputWiring, map_: OutputMap) -> None:
        super().__init__(wiring)
        self._unit = Unit(bus, wiring.unit)
        self._map = map_

    async def range(self) -> Result:
        """Compare the code of the channel."""
        wiring = self.wiring
        try:
            told = await check_setup(
                self._unit,
                wiring.module,
                self._map,
                wiring.range,
                (wiring.channel,),
                set_range=False,
            )
        except ModuleMismatch as error:
            return _mismatched(str(error), set_range=wiring.set_range)
        return Result.ok(wiring.range.span) if told else await super().range()

    async def status(self) -> Result:
        """Read its status bits."""
        status, channel = self._map.status, self.wiring.channel
        if status is None or status.registers is None:
            return await super().status()
        words = await self._unit.fetch(status.registers, (channel,), status.words)
        causes = status.causes(words[channel])
        if causes:
            return Result.failed("; ".join(causes), "see to the wires of the valve")
        return Result.ok("nothing against it")

    async def watchdog(self) -> Result:
        """Look whether it has tripped, then whether it is armed."""
        watchdog, status = self._map.watchdog, self._map.status
        if status is not None and status.registers and status.fail_safe is not None:
            channel = self.wiring.channel
            words = await self._unit.fetch(status.registers, (channel,), status.words)
            if status.tripped(words[channel]):
                return _tripped(watchdog.clear if watchdog else "switch it off and on")
            if watchdog is None:
                return Result.ok("not tripped; it is armed with the maker's utility")
        if watchdog is None:
            return await super().watchdog()
        return await self._registered(watchdog)

    async def _registered(self, watchdog: RegisterWatchdog) -> Result:
        if watchdog.tripped is not None and await self._unit.holds(watchdog.tripped):
            return _tripped(watchdog.clear)
        if watchdog.armed is None:
            return self._silent("whether its watchdog is armed")
        place = Registers(Table.HOLDING, watchdog.time)
        timeout = await self._unit.one(place) * watchdog.step
        result = self._armed(armed=await self._unit.holds(watchdog.armed))
        return Result(result.verdict, f"{result.said}, {timeout:g} s", result.remedy)

    async def safe_value(self) -> Result:
        """Read it where it has a register."""
        if self._map.safe is None:
            return await super().safe_value()
        return self._compared(await self._read(self._map.safe))

    async def _current(self) -> float:
        return await self._read(self._map.read_back)

    async def _read(self, place: Registers) -> float:
        channel, encoding = self.wiring.channel, self._map.encoding
        words = await self._unit.fetch(place, (channel,), encoding.words)
        return self.wiring.range.current(encoding.decode(words[channel]))


class PhraseOutputCheck(OutputCheck):
    """Of a module that speaks lines of text."""

    def __init__(
        self, bus: DconBus, wiring: OutputWiring, phrases: OutputPhrases
    ) -> None:
        super().__init__(wiring)
        self._bus = bus
        self._phrases = phrases
        self._filled = {
            "unit": f"{wiring.unit:02X}",
            "channel": f"{wiring.channel:X}",
        }

    async def watchdog(self) -> Result:
        """Look whether it has tripped, then whether it is armed as asked."""
        watchdog = self._phrases.watchdog
        if watchdog is None:
            return await super().watchdog()
        if watchdog.status is not None:
            said = await self._ask(watchdog.status, 2)
            try:
                status = int(said, 16)
            except ValueError:
                message = f'"{said}" is not a status'
                raise BadReply(message) from None
            if status & watchdog.tripped:
                return _tripped(watchdog.clear)
        return await self._asked(watchdog)

    async def _asked(self, watchdog: PhraseWatchdog) -> Result:
        asked = self.wiring.watchdog.timeout if self.wiring.watchdog else None
        if asked is None or watchdog.armed is None:
            return self._armed(armed=False)
        try:
            await self._ask(watchdog.armed, 0, time=watchdog.time_text(asked))
        except BadReply:
            return self._armed(armed=False)
        return self._armed(armed=True)

    async def safe_value(self) -> Result:
        """Ask for it where there is a line for that."""
        if self._phrases.safe is None:
            return await super().safe_value()
        said = await self._ask(self._phrases.safe, CURRENT)
        return self._compared(from_engineering(said))

    async def _current(self) -> float:
        return from_engineering(await self._ask(self._phrases.read_back, CURRENT))

    async def _ask(self, phrase: Phrase, length: int, **more: str) -> str:
        filled = {**self._filled, **more}
        question = phrase.question(self.wiring.unit, filled, length)
        return phrase.value(await self._bus.ask(question), filled)


class ItvOutputCheck(OutputCheck):
    """Of a regulator that takes its pressure as a number."""

    def __init__(self, bus: ItvBus, wiring: OutputWiring) -> None:
        super().__init__(wiring)
        self._bus = bus

    async def _current(self) -> float:
        return self.wiring.range.current(await self._bus.ask(Query.SET_POINT))


def _mismatched(said: str, *, set_range: bool) -> Result:
    if set_range:
        remedy = "nothing: the daemon sets it, since the settings say set_range"
        return Result.warning(said, remedy)
    return Result.failed(said, "change the module or the settings until they agree")


def _tripped(clear: str) -> Result:
    said = "tripped: the output is at its safe value, and nothing is written"
    return Result.failed(said, f"see why the host was silent, then clear it: {clear}")
