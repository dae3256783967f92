"""The channel of a Modbus module that drives the valve."""

from gripperd.drivers.bus import ModbusBus
from gripperd.drivers.registers import Unit, check_setup
from gripperd.drivers.watchdog import RegisterGuard, tripped
from gripperd.drivers.wiring import OutputWiring
from gripperd.errors import ModuleMismatch
from gripperd.protocol.encoding import Registers
from gripperd.protocol.modbus import Write
from gripperd.protocol.modules import OutputMap
from gripperd.protocol.watchdog import RESET
from gripperd.signals import Reading
from gripperd.units import MILLI


class ModbusOutput:
    """A current in registers."""

    def __init__(self, bus: ModbusBus, wiring: OutputWiring, map_: OutputMap) -> None:
        self.range_verified = False
        self.armed = False
        self._unit = Unit(bus, wiring.unit)
        self._wiring = wiring
        self._map = map_
        self._range = wiring.range
        watchdog = map_.watchdog
        self._guard = RegisterGuard(self._unit, wiring, watchdog) if watchdog else None
        self._words: tuple[int, ...] = ()

    async def attach(self) -> None:
        """Check how the module is set up, and arm what the settings ask for.

        Raises
        ------
        ModuleMismatch
            It is set up otherwise.
        WatchdogTripped
            It has missed its host, and a person must look first.
        LinkError
            No trustworthy answer came.
        """
        self.armed = False
        if self._guard is not None:
            await self._guard.check()
        self.range_verified = await check_setup(
            self._unit,
            self._wiring.module,
            self._map,
            self._range,
            (self._wiring.channel,),
            set_range=self._wiring.set_range,
        )
        await self._set_safe_value()
        if self._guard is not None:
            self.armed = await self._guard.arm()

    async def read(self, now: float) -> Reading:
        """Current that the module says it gives. [A].

        Raises
        ------
        WatchdogTripped
            It is the safe value.
        LinkError
            No trustworthy answer came.
        """
        if self._guard is not None:
            await self._guard.keep(now)
        trouble = await self._trouble()
        if trouble:
            return Reading.bad(trouble)
        return self._wiring.reading(await self._current(self._map.read_back))

    async def write(self, current: float, *, urgent: bool) -> None:
        """Set the current; a float goes out in one request. [A].

        Raises
        ------
        InputError
            Outside the range.
        LinkError
            No trustworthy confirmation came; it may have arrived or not.
        """
        self._words = self._encode(current)
        await self._unit.bus.ask(self._newest, urgent=urgent)

    def _newest(self) -> Write:
        """The last current asked for: a write that waited must not undo a later one."""
        address = self._map.values.of(self._wiring.channel)
        return Write(self._wiring.unit, address, self._words)

    def _encode(self, current: float) -> tuple[int, ...]:
        checked = self._range.check(current, self._wiring.module.name)
        return self._map.encoding.encode(self._range.count(checked))

    async def _current(self, place: Registers) -> float:
        channel, encoding = self._wiring.channel, self._map.encoding
        words = await self._unit.fetch(place, (channel,), encoding.words)
        return self._range.current(encoding.decode(words[channel]))

    async def _trouble(self) -> str:
        """What the status says against the output, "" if nothing."""
        status, channel = self._map.status, self._wiring.channel
        if status is None or status.registers is None:
            return ""
        words = await self._unit.fetch(status.registers, (channel,), status.words)
        if status.tripped(words[channel]):
            watchdog = self._map.watchdog
            raise tripped(self._wiring, watchdog.remedy if watchdog else RESET)
        causes = status.causes(words[channel])
        return f"{self._wiring} says: {'; '.join(causes)}" if causes else ""

    async def _set_safe_value(self) -> None:
        """Write the current on time-out where it has a register and is asked for."""
        asked, place = self._wiring.watchdog, self._map.safe
        if asked is None or asked.safe_current is None or place is None:
            return
        words = self._encode(asked.safe_current)
        wanted = self._map.encoding.decode(words)
        channel, width = self._wiring.channel, len(words)
        found = (await self._unit.fetch(place, (channel,), width))[channel]
        if tuple(found) == words:
            return
        await self._unit.bus.ask(Write(self._wiring.unit, place.of(channel), words))
        current = await self._current(place)
        if current != self._range.current(wanted):
            message = (
                f"{self._wiring} was given {asked.safe_current / MILLI:g} mA as its"
                f" safe value and has {current / MILLI:g} mA"
            )
            raise ModuleMismatch(message)
