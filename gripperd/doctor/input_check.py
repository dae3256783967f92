"""Checks of the module that the sensors are on. Only reads."""

from collections.abc import Iterator
from dataclasses import replace

from gripperd.doctor.finding import Finding, Result
from gripperd.drivers.inputs import AsciiInputs, ModbusInputs
from gripperd.drivers.wiring import InputWiring
from gripperd.errors import ModuleMismatch
from gripperd.protocol.live_zero import LoopScale
from gripperd.signals import Reading
from gripperd.units import MILLI

AS_CURRENT = LoopScale(value_low=4e-3, value_high=20e-3)
"""Reads a loop as its own current, so that only the live zero is judged. [A]"""
LOWEST, HIGHEST = 3.8e-3, 20.5e-3
"""Between these a working transmitter measures (NAMUR NE 43). [A]"""


def as_currents(wiring: InputWiring) -> InputWiring:
    """The same sensors, read as currents, with nothing to be set on the module."""
    sensors = {
        name: replace(sensor, scale=AS_CURRENT)
        for name, sensor in wiring.sensors.items()
    }
    return replace(wiring, sensors=sensors, set_range=False)


class InputCheck:
    """What can be asked of an input module.

    Parameters
    ----------
    inputs
        Wired :func:`as_currents`.
    wiring
        As the settings have it.
    """

    def __init__(self, inputs: ModbusInputs | AsciiInputs, wiring: InputWiring) -> None:
        self._inputs = inputs
        self._wiring = wiring

    async def range(self) -> Result:
        """Compare the range codes of all channels in use."""
        try:
            await self._inputs.attach()
        except ModuleMismatch as error:
            remedy = "change the module or the settings until they agree"
            return Result.failed(str(error), remedy)
        if self._inputs.range_verified:
            return Result.ok(self._wiring.range.span)
        said = f"{self._wiring.module.name} does not tell which range it has"
        return Result.not_possible(said, "compare one reading with a meter")

    async def loops(self, subject: str) -> Iterator[Finding]:
        """Judge the current of every sensor."""
        readings = await self._inputs.read()
        return (
            Finding(subject, f"loop of {name}", self._loop(name, reading))
            for name, reading in readings.items()
        )

    def _loop(self, name: str, reading: Reading) -> Result:
        channel = self._wiring.sensors[name].channel
        remedy = (
            f"see to wires, supply and current jumper of channel {channel}: below"
            " 3.6 mA a wire is broken, above 21 mA there is a short"
        )
        if reading.value is None:
            return Result.failed(reading.cause, remedy)
        said = f"{reading.value / MILLI:.3f} mA"
        if LOWEST <= reading.value <= HIGHEST:
            return Result.ok(said)
        beyond = f"{said} is beyond 3.8 to 20.5 mA, where transmitters measure"
        return Result.warning(beyond, "compare the sensor's span with what it measures")
