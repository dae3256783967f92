"""Valves on serial lines that speak text: DCON, ADAM ASCII and SMC regulators."""

from gripperd.drivers.bus import Bus
from gripperd.drivers.range_line import check_range
from gripperd.drivers.watchdog import PhraseGuard
from gripperd.drivers.wiring import OutputWiring
from gripperd.errors import ModuleMismatch
from gripperd.protocol.dcon import Ask
from gripperd.protocol.engineering import engineering, from_engineering
from gripperd.protocol.itv import Query, Set
from gripperd.protocol.itv import Request as ItvRequest
from gripperd.protocol.modules import OutputPhrases
from gripperd.protocol.phrase import CURRENT, Phrase
from gripperd.signals import Reading
from gripperd.units import MILLI

SAFE_STEP = 0.5e-6
"""Half the last digit in which a module tells its safe value. [A]"""


class AsciiOutput:
    """A current in lines of text; the same as :class:`ModbusOutput` for the rest."""

    def __init__(
        self, bus: Bus[Ask, str], wiring: OutputWiring, phrases: OutputPhrases
    ) -> None:
        self.armed = False
        self.range_verified = False
        self._bus = bus
        self._wiring = wiring
        self._phrases = phrases
        watchdog = phrases.watchdog
        self._guard = PhraseGuard(bus, wiring, watchdog) if watchdog else None
        self._text = ""

    async def attach(self) -> None:
        """Check range and safe value, and arm what the settings ask for."""
        self.armed = False
        if self._guard is not None:
            await self._guard.check()
        self.range_verified = await check_range(
            self._bus, self._wiring, (self._wiring.channel,), self._phrases.range_code
        )
        await self._check_safe_value()
        if self._guard is not None:
            self.armed = await self._guard.arm()

    async def read(self, now: float) -> Reading:
        """Current that the module says it gives. [A]."""
        if self._guard is not None:
            await self._guard.keep(now)
        return self._wiring.reading(await self._current(self._phrases.read_back))

    async def write(self, current: float, *, urgent: bool) -> None:
        """Set the current. [A]."""
        checked = self._wiring.range.check(current, self._wiring.module.name)
        self._text = engineering(checked)
        sent = self._filled(self._text)

        def newest() -> Ask:
            """A write that waited must not undo a later one."""
            sent.update(self._filled(self._text))
            return self._phrases.write.question(self._wiring.unit, sent)

        answer = await self._bus.ask(newest, urgent=urgent)
        self._phrases.write.value(answer, sent)

    async def _current(self, phrase: Phrase) -> float:
        filled = self._filled()
        question = phrase.question(self._wiring.unit, filled, CURRENT)
        return from_engineering(phrase.value(await self._bus.ask(question), filled))

    def _filled(self, value: str | None = None) -> dict[str, str]:
        places = {
            "unit": f"{self._wiring.unit:02X}",
            "channel": f"{self._wiring.channel:X}",
        }
        return places if value is None else {**places, "value": value}

    async def _check_safe_value(self) -> None:
        """Compare it: a line could set it only by driving the output to it."""
        asked, phrase = self._wiring.watchdog, self._phrases.safe
        if asked is None or asked.safe_current is None or phrase is None:
            return
        found = await self._current(phrase)
        if abs(found - asked.safe_current) > SAFE_STEP:
            message = (
                f"{self._wiring} has a safe value of {found / MILLI:g} mA,"
                f" {asked.safe_current / MILLI:g} mA is wanted; set it with the maker's"
                " utility, since that takes driving the output there"
            )
            raise ModuleMismatch(message)


class ItvOutput:
    """A regulator that takes its pressure as a number."""

    range_verified = False
    armed = False

    def __init__(self, bus: Bus[ItvRequest, int], wiring: OutputWiring) -> None:
        self._bus = bus
        self._wiring = wiring
        self._count = 0

    async def attach(self) -> None:
        """Nothing of it can be checked."""

    async def read(self, now: float) -> Reading:
        """Set-point, as the current that stands for it. [A]."""
        return Reading(self._wiring.range.current(await self._bus.ask(Query.SET_POINT)))

    async def write(self, current: float, *, urgent: bool) -> None:
        """Set the pressure, by the current that stands for it. [A]."""
        wiring = self._wiring
        checked = wiring.range.check(current, wiring.module.name)
        self._count = round(wiring.range.count(checked))
        await self._bus.ask(lambda: Set(self._count), urgent=urgent)
