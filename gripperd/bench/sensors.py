"""Transmitters of the simulated rig: physical values to 4-20 mA."""

from collections.abc import Set as AbstractSet
from dataclasses import dataclass
from enum import StrEnum
from random import Random

from gripperd.protocol.live_zero import LoopScale

LOWEST = 3.8e-3
HIGHEST = 20.5e-3
"""Where a healthy transmitter saturates, so that a failed one can be told from it
(NAMUR NE 43). [A]"""
SHORTED = 24e-3
"""What a wire carries that touches the supply: above 21 mA, and little enough for a
module to survive. [A]"""
SPIKING = 0.1
"""How likely a sample of a spiking sensor is wild. [-]"""


class Channel(StrEnum):
    """Channels of the analog-input module, in order."""

    PRESSURE = "pressure"
    OPENING = "opening"
    GRIP = "grip"


@dataclass(frozen=True, slots=True)
class Sensor:
    """A transmitter: a straight line, and the noise around it."""

    scale: LoopScale
    noise: float = 1e-3
    """One sigma relative to the span. [-]"""

    def current(self, value: float, rng: Random) -> float:
        """Loop current at a value, to the microampere. [A]."""
        span = self.scale.current_high - self.scale.current_low
        current = self.scale.current(value) + span * rng.gauss(0.0, self.noise)
        return round(min(max(current, LOWEST), HIGHEST), 6)


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorSettings:
    """The three transmitters of the rig."""

    pressure: Sensor = Sensor(LoopScale(value_low=0.0, value_high=600e3))
    """Gauge pressure in the muscle. [Pa]"""
    opening: Sensor = Sensor(LoopScale(value_low=0.0, value_high=0.1))
    """Distance between the jaws. [m]"""
    grip: Sensor = Sensor(LoopScale(value_low=0.0, value_high=250.0))
    """Grip force per jaw. [N]"""


class Sensors:
    """The transmitters at work, with their noise and their faults.

    Parameters
    ----------
    settings
        Ranges and noise.
    rng
        Where the noise comes from.
    """

    def __init__(self, settings: SensorSettings, rng: Random) -> None:
        self._sensors = {
            Channel.PRESSURE: settings.pressure,
            Channel.OPENING: settings.opening,
            Channel.GRIP: settings.grip,
        }
        self._rng = rng
        self._wild = _apart(rng)
        self._last: dict[Channel, float] = {}

    def read(
        self,
        values: dict[Channel, float],
        *,
        broken: AbstractSet[Channel] = frozenset(),
        shorted: AbstractSet[Channel] = frozenset(),
        frozen: AbstractSet[Channel] = frozenset(),
        spiking: AbstractSet[Channel] = frozenset(),
    ) -> tuple[float, float, float]:
        """Sample every channel once.

        Parameters
        ----------
        values
            True values. [SI]
        broken
            Channels that give 0 mA, whatever else is wrong with them.
        shorted
            Channels that give 24 mA.
        frozen
            Channels that repeat what they gave last.
        spiking
            Channels that give any current between these now and then.

        Returns
        -------
        Loop currents in the order of :class:`Channel`. [A]
        """
        for channel, sensor in self._sensors.items():
            # Drawn for every channel: a fault leaves the noise of the others alone.
            fresh = sensor.current(values[channel], self._rng)
            if channel not in frozen or channel not in self._last:
                self._last[channel] = fresh
        shown = {
            **self._last,
            **self._spikes(spiking),
            **dict.fromkeys(shorted, SHORTED),
            **dict.fromkeys(broken, 0.0),
        }
        pressure, opening, grip = (shown[channel] for channel in Channel)
        return pressure, opening, grip

    def _spikes(self, spiking: AbstractSet[Channel]) -> dict[Channel, float]:
        """Wild currents of this sample. [A]."""
        drawn = {
            channel: (self._wild.random(), self._wild.uniform(0.0, SHORTED))
            for channel in Channel
        }
        return {
            channel: round(current, 6)
            for channel, (chance, current) in drawn.items()
            if channel in spiking and chance < SPIKING
        }


def _apart(rng: Random) -> Random:
    """A generator as fixed as another, which is left as it is."""
    twin = Random()
    twin.setstate(rng.getstate())
    return Random(twin.getrandbits(64))
