"""The sensors: broken, out of range, stuck, full of spikes."""

from collections.abc import Iterator
from types import MappingProxyType

from gripperd.control.monitors.policy import Cause
from gripperd.control.monitors.sight import Lasting, Sight, Symptom
from gripperd.signals import ABSENT, Quality

FAILED = frozenset({Quality.BAD, Quality.SUBSTITUTED})
CHANNELS = ("pressure", "opening", "grip")
LEFT = MappingProxyType(
    {
        "pressure": "the valve is not watched",
        "opening": "size and slip are not seen",
        "grip": "the model stands in for it",
    }
)
"""What remains without each of them."""


class SensorFailed:
    """A sensor that is fitted and cannot be believed."""

    def __init__(self) -> None:
        self._present = {channel: Lasting() for channel in CHANNELS}

    def look(self, sight: Sight, dt: float) -> Iterator[Symptom]:
        """See the sentence in each symptom."""
        measured, policy = sight.measured, sight.policies[Cause.SENSOR_FAILED]
        readings = (measured.pressure, measured.opening, measured.grip)
        for channel, reading in zip(CHANNELS, readings, strict=True):
            failed = reading.quality in FAILED and reading.cause != ABSENT.cause
            if self._present[channel].update(failed, dt) >= policy.after:
                text = f"the {channel} sensor: {reading.cause}; {LEFT[channel]}"
                yield Symptom(Cause.SENSOR_FAILED, text, channel)
