"""Communication watchdogs: found out, armed, kept quiet, and their trips noticed."""

from gripperd.drivers.bus import Bus
from gripperd.drivers.registers import Unit
from gripperd.drivers.wiring import OutputWiring
from gripperd.errors import BadReply, ModuleMismatch, WatchdogTripped
from gripperd.protocol.dcon import Ask
from gripperd.protocol.modbus import Table
from gripperd.protocol.modules import OutputModule
from gripperd.protocol.phrase import Phrase
from gripperd.protocol.watchdog import (
    PhraseWatchdog,
    RegisterWatchdog,
    Setting,
)

BEATS = 4
"""Times in one time-out that the watchdog is looked after: three may be lost."""
STATUS = 2
"""Characters of a module's status, in hexadecimal."""


class Beat:
    """When it is time to look after a watchdog again."""

    def __init__(self, timeout: float) -> None:
        self._period = timeout / BEATS
        self._last: float | None = None

    def due(self, now: float) -> bool:
        """Whether it is time; then the next time counts from here. [s]."""
        if self._last is not None and now - self._last < self._period:
            return False
        self._last = now
        return True


def tripped(wiring: OutputWiring, clear: str) -> WatchdogTripped:
    """Error of an output that its module has taken to the safe value."""
    message = (
        f"{wiring} is at its safe value: the communication watchdog has tripped."
        f" Nothing is written until a person has cleared it: {clear}"
    )
    return WatchdogTripped(message)


class RegisterGuard:
    """Looks after a watchdog in registers."""

    def __init__(
        self, unit: Unit, wiring: OutputWiring, watchdog: RegisterWatchdog
    ) -> None:
        self._unit = unit
        self._wiring = wiring
        self._watchdog = watchdog
        self._timeout = _timeout(wiring)
        self._beat = Beat(self._timeout or 0.0)

    async def check(self) -> None:
        """Notice a trip.

        Raises
        ------
        WatchdogTripped
            The output is at its safe value.
        """
        sign = self._watchdog.tripped
        if sign is not None and await self._unit.holds(sign):
            raise tripped(self._wiring, self._watchdog.remedy)

    async def arm(self) -> bool:
        """Arm it if the settings ask; tell whether it is.

        Raises
        ------
        ModuleMismatch
            It does not take the time-out, or is not armed afterwards.
        """
        if self._timeout is None:
            return False
        steps = self._watchdog.steps(self._timeout)
        time = Setting(Table.HOLDING, self._watchdog.time, steps)
        armed = self._watchdog.armed
        timed = await self._unit.holds(time)
        # Some refuse a new time-out, even the same one, while they run.
        if timed and armed is not None and await self._unit.holds(armed):
            return True
        if not timed:
            await self._unit.set(time)
        for setting in self._watchdog.arm:
            await self._unit.bus.ask(setting.write(self._unit.number))
        if armed is not None and not await self._unit.holds(armed):
            raise ModuleMismatch(_not_armed(self._wiring.module, str(armed)))
        return True

    async def keep(self, now: float) -> None:
        """Keep it quiet, and notice a trip; only as often as it takes. [s]."""
        if self._timeout is None or not self._beat.due(now):
            return
        await self.check()
        for setting in self._watchdog.keep:
            await self._unit.bus.ask(setting.write(self._unit.number))


class PhraseGuard:
    """Looks after a watchdog in lines of text; the same for :class:`RegisterGuard`."""

    def __init__(
        self, bus: Bus[Ask, str], wiring: OutputWiring, watchdog: PhraseWatchdog
    ) -> None:
        self._bus = bus
        self._wiring = wiring
        self._watchdog = watchdog
        self._timeout = _timeout(wiring)
        self._beat = Beat(self._timeout or 0.0)
        self._filled = {
            "unit": f"{wiring.unit:02X}",
            "time": watchdog.time_text(self._timeout or 0.0),
        }

    async def check(self) -> None:
        """Notice a trip, see :meth:`RegisterGuard.check`."""
        if self._watchdog.status is None:
            return
        said = await self._ask(self._watchdog.status, STATUS)
        try:
            status = int(said, 16)
        except ValueError:
            message = f'"{said}" is not the status of {self._wiring}'
            raise BadReply(message) from None
        if status & self._watchdog.tripped:
            raise tripped(self._wiring, self._watchdog.remedy)

    async def arm(self) -> bool:
        """Arm it if the settings ask, see :meth:`RegisterGuard.arm`."""
        if self._timeout is None:
            return False
        await self._ask(self._watchdog.arm)
        armed = self._watchdog.armed
        if armed is not None:
            answer = await self._answer(armed, 0)
            try:
                armed.value(answer, self._filled)
            except BadReply as error:
                message = _not_armed(self._wiring.module, str(error))
                raise ModuleMismatch(message) from error
        return True

    async def keep(self, now: float) -> None:
        """Keep it quiet, and notice a trip; only as often as it takes. [s]."""
        if self._timeout is None or not self._beat.due(now):
            return
        if self._watchdog.keep is not None:
            await self._ask(self._watchdog.keep)
        await self.check()

    async def _ask(self, phrase: Phrase, length: int = 0) -> str:
        return phrase.value(await self._answer(phrase, length), self._filled)

    async def _answer(self, phrase: Phrase, length: int) -> str:
        question = phrase.question(self._wiring.unit, self._filled, length)
        return await self._bus.ask(question)


def _timeout(wiring: OutputWiring) -> float | None:
    return wiring.watchdog.timeout if wiring.watchdog else None


def _not_armed(module: OutputModule, why: str) -> str:
    return f"the watchdog of {module.name} was armed and does not say so: {why}"
