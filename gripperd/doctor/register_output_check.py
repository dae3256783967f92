"""Checks of a Modbus module that drives the valve. Only reads."""

from gripperd.doctor.finding import Result
from gripperd.doctor.output_check import OutputCheck, mismatched, tripped
from gripperd.drivers.bus import ModbusBus
from gripperd.drivers.registers import Unit, check_setup
from gripperd.drivers.wiring import OutputWiring
from gripperd.errors import ModuleMismatch
from gripperd.protocol.encoding import Registers
from gripperd.protocol.modbus import Table
from gripperd.protocol.modules import OutputMap
from gripperd.protocol.watchdog import RESET, RegisterWatchdog


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
            return mismatched(str(error), set_range=wiring.set_range)
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
                return tripped(watchdog.remedy if watchdog else RESET)
            if watchdog is None:
                return Result.ok("not tripped; it is armed with the maker's utility")
        if watchdog is None:
            return await super().watchdog()
        return await self._registered(watchdog)

    async def _registered(self, watchdog: RegisterWatchdog) -> Result:
        if watchdog.tripped is not None and await self._unit.holds(watchdog.tripped):
            return tripped(watchdog.remedy)
        if watchdog.armed is None:
            return self.silent("whether its watchdog is armed")
        place = Registers(Table.HOLDING, watchdog.time)
        timeout = await self._unit.one(place) * watchdog.step
        result = self.armed(armed=await self._unit.holds(watchdog.armed))
        return Result(result.verdict, f"{result.said}, {timeout:g} s", result.remedy)

    async def safe_value(self) -> Result:
        """Read it where it has a register."""
        if self._map.safe is None:
            return await super().safe_value()
        return self.compared(await self._read(self._map.safe))

    async def current(self) -> float:
        """The current that is set. [A]."""
        return await self._read(self._map.read_back)

    async def _read(self, place: Registers) -> float:
        channel, encoding = self.wiring.channel, self._map.encoding
        words = await self._unit.fetch(place, (channel,), encoding.words)
        return self.wiring.range.current(encoding.decode(words[channel]))
