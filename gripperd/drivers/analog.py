"""One gripper on a bus: a valve current out, its sensors' currents in."""

from collections.abc import Mapping
from dataclasses import dataclass

from gripperd.drivers.bus import Bus
from gripperd.errors import DeviceRefused
from gripperd.protocol.live_zero import LoopScale
from gripperd.protocol.modbus import Read, Refusal, Table, Write
from gripperd.protocol.modules import InputModule, OutputModule
from gripperd.signals import Measurement, Reading

PASSING = frozenset({Refusal.ACKNOWLEDGE, Refusal.BUSY, Refusal.NO_RESPONSE})
"""Refusals that may be over a moment later."""


@dataclass(frozen=True, slots=True, kw_only=True)
class OutputWiring:
    """Where the valve is connected."""

    module: OutputModule
    unit: int
    channel: int


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorWiring:
    """Where one sensor is connected, and how its current reads."""

    channel: int
    scale: LoopScale


@dataclass(frozen=True, slots=True, kw_only=True)
class InputWiring:
    """Where the sensors are connected; the keys are names in `Measurement`."""

    module: InputModule
    unit: int
    sensors: Mapping[str, SensorWiring]


class AnalogRig:
    """Valve and sensors of one gripper."""

    def __init__(
        self, bus: Bus, output: OutputWiring, inputs: InputWiring | None
    ) -> None:
        self._bus = bus
        self._output = output
        self._inputs = inputs
        self._register = output.module.register(output.channel)
        self._count = 0

    async def read(self, now: float) -> Measurement:
        """Sample the commanded current and every sensor.

        Raises
        ------
        LinkError
            When no trustworthy answer came.
        """
        unit = self._output.unit
        (count,) = await self._look(Read(unit, Table.HOLDING, self._register))
        current = Reading(self._output.module.decode(count))
        sensors = await self._sensors()
        return Measurement(time=now, current=current, **sensors)

    async def write(self, current: float, *, urgent: bool = False) -> None:
        """Set the valve current; return once the module has confirmed it. [A].

        Raises
        ------
        InputError
            Outside what the module can drive.
        LinkError
            When no trustworthy confirmation came; it may have arrived or not.
        """
        self._count = self._output.module.encode(current)
        await self._bus.ask(self._newest, urgent=urgent)

    def _newest(self) -> Write:
        """The last current asked for: a write that waited must not undo a later one."""
        return Write(self._output.unit, self._register, (self._count,))

    async def _look(self, request: Read) -> tuple[int, ...]:
        """Read, and once more from a busy device; a write is never repeated."""
        try:
            return await self._bus.ask(request)
        except DeviceRefused as error:
            if error.exception_code not in PASSING:
                raise
            return await self._bus.ask(request)

    async def _sensors(self) -> dict[str, Reading]:
        wiring = self._inputs
        if wiring is None or not wiring.sensors:
            return {}
        highest = max(sensor.channel for sensor in wiring.sensors.values())
        request = Read(wiring.unit, Table.INPUT, wiring.module.address, highest + 1)
        try:
            counts = await self._look(request)
        except DeviceRefused as error:
            # The line is sound: without its sensors the valve can still be driven.
            return {name: Reading.bad(str(error)) for name in wiring.sensors}
        return {
            name: sensor.scale.reading(wiring.module.decode(counts[sensor.channel]))
            for name, sensor in wiring.sensors.items()
        }
