"""Checks of modules on lines of text that drive the valve. Only reads."""

from gripperd.doctor.finding import Result
from gripperd.doctor.output_check import OutputCheck, mismatched, tripped
from gripperd.drivers.bus import DconBus, ItvBus
from gripperd.drivers.range_line import check_range
from gripperd.drivers.wiring import OutputWiring
from gripperd.errors import BadReply, ModuleMismatch
from gripperd.protocol.engineering import from_engineering
from gripperd.protocol.itv import Query
from gripperd.protocol.modules import OutputPhrases
from gripperd.protocol.phrase import CURRENT, Phrase
from gripperd.protocol.watchdog import PhraseWatchdog


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

    async def range(self) -> Result:
        """Compare the code of the channel, where there is a line for that."""
        wiring = self.wiring
        try:
            told = await check_range(
                self._bus, wiring, (wiring.channel,), self._phrases.range_code
            )
        except ModuleMismatch as error:
            return mismatched(str(error), set_range=False)
        return Result.ok(wiring.range.span) if told else await super().range()

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
                return tripped(watchdog.remedy)
        return await self._asked(watchdog)

    async def _asked(self, watchdog: PhraseWatchdog) -> Result:
        asked = self.wiring.watchdog.timeout if self.wiring.watchdog else None
        if asked is None or watchdog.armed is None:
            return self.armed(armed=False)
        filled = {**self._filled, "time": watchdog.time_text(asked)}
        answer = await self._bus.ask(
            watchdog.armed.question(self.wiring.unit, filled, 0)
        )
        try:
            watchdog.armed.value(answer, filled)
        except BadReply:
            return self.armed(armed=False)
        return self.armed(armed=True)

    async def safe_value(self) -> Result:
        """Ask for it where there is a line for that."""
        if self._phrases.safe is None:
            return await super().safe_value()
        said = await self._ask(self._phrases.safe, CURRENT)
        return self.compared(from_engineering(said))

    async def current(self) -> float:
        """The current that is set. [A]."""
        return from_engineering(await self._ask(self._phrases.read_back, CURRENT))

    async def _ask(self, phrase: Phrase, length: int) -> str:
        question = phrase.question(self.wiring.unit, self._filled, length)
        return phrase.value(await self._bus.ask(question), self._filled)


class ItvOutputCheck(OutputCheck):
    """Of a regulator that takes its pressure as a number."""

    def __init__(self, bus: ItvBus, wiring: OutputWiring) -> None:
        super().__init__(wiring)
        self._bus = bus

    async def current(self) -> float:
        """The current that is set. [A]."""
        return self.wiring.range.current(await self._bus.ask(Query.SET_POINT))
