"""The sensors of a gripper, on whatever input module."""

from collections.abc import Mapping, Sequence

from gripperd.drivers.bus import Bus, ModbusBus
from gripperd.drivers.range_line import check_range
from gripperd.drivers.registers import Unit, check_setup
from gripperd.drivers.wiring import InputWiring, SensorWiring
from gripperd.errors import BadReply
from gripperd.protocol.dcon import Ask
from gripperd.protocol.engineering import from_engineering
from gripperd.protocol.modules import InputPhrases, RegisterMap
from gripperd.protocol.phrase import CURRENT
from gripperd.signals import Reading
from gripperd.units import MILLI


class ModbusInputs:
    """Currents in registers."""

    def __init__(self, bus: ModbusBus, wiring: InputWiring, map_: RegisterMap) -> None:
        self.range_verified = False
        self._unit = Unit(bus, wiring.unit)
        self._wiring = wiring
        self._map = map_
        self._range = wiring.range
        self._channels = _channels(wiring)

    async def attach(self) -> None:
        """Check how the module is set up.

        Raises
        ------
        ModuleMismatch
            It is set up otherwise.
        LinkError
            No trustworthy answer came.
        """
        self.range_verified = await check_setup(
            self._unit,
            self._wiring.module,
            self._map,
            self._range,
            self._channels,
            set_range=self._wiring.set_range,
        )

    async def read(self) -> Mapping[str, Reading]:
        """Every sensor: one request for the values, one for their status if any.

        Raises
        ------
        LinkError
            No trustworthy answer came.
        """
        width = self._map.encoding.words
        words = await self._unit.fetch(self._map.values, self._channels, width)
        causes = await self._causes(words)
        return {
            name: self._reading(sensor, words[sensor.channel], causes[sensor.channel])
            for name, sensor in self._wiring.sensors.items()
        }

    async def _causes(
        self, words: Mapping[int, Sequence[int]]
    ) -> Mapping[int, Sequence[str]]:
        """What the module says against each channel."""
        status = self._map.status
        if status is None:
            return dict.fromkeys(self._channels, ())
        if status.registers is not None:
            words = await self._unit.fetch(
                status.registers, self._channels, status.words
            )
        return {channel: status.causes(words[channel]) for channel in self._channels}

    def _reading(
        self, sensor: SensorWiring, words: Sequence[int], causes: Sequence[str]
    ) -> Reading:
        if causes:
            return Reading.bad(_said(self._wiring, sensor, "; ".join(causes)))
        count = self._map.encoding.decode(words)
        current = self._range.current(count)
        if count == self._map.encoding.limits[1]:
            said = f"{current / MILLI:.3f} mA or more, the most that it can say"
            return Reading.bad(_said(self._wiring, sensor, said))
        return sensor.scale.reading(current)


class AsciiInputs:
    """Currents in lines of text; all channels come in one."""

    def __init__(
        self, bus: Bus[Ask, str], wiring: InputWiring, phrases: InputPhrases
    ) -> None:
        self.range_verified = False
        self._bus = bus
        self._wiring = wiring
        self._read = phrases.read
        self._range_code = phrases.range_code

    async def attach(self) -> None:
        """Check the ranges, see :meth:`ModbusInputs.attach`."""
        self.range_verified = await check_range(
            self._bus, self._wiring, _channels(self._wiring), self._range_code
        )

    async def read(self) -> Mapping[str, Reading]:
        """Every sensor, in one request.

        Raises
        ------
        LinkError
            No trustworthy answer came.
        """
        filled = {"unit": f"{self._wiring.unit:02X}"}
        question = self._read.question(self._wiring.unit, filled, None)
        text = self._read.value(await self._bus.ask(question), filled)
        return {
            name: self._reading(sensor, text)
            for name, sensor in self._wiring.sensors.items()
        }

    def _reading(self, sensor: SensorWiring, text: str) -> Reading:
        start = CURRENT * sensor.channel
        try:
            current = from_engineering(text[start : start + CURRENT])
        except BadReply as error:
            return Reading.bad(_said(self._wiring, sensor, str(error)))
        return sensor.scale.reading(current)


def _channels(wiring: InputWiring) -> tuple[int, ...]:
    return tuple(sorted(sensor.channel for sensor in wiring.sensors.values()))


def _said(wiring: InputWiring, sensor: SensorWiring, what: str) -> str:
    return f"{wiring.module.name} says of channel {sensor.channel}: {what}"
