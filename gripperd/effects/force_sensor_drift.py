"""Zero of the force sensor that drifts with the clock.

References
----------
.. [1] JCGM 200:2012 (VIM), 4.21: instrumental drift.
"""

from dataclasses import dataclass
from typing import ClassVar

from gripperd.model.effect import Signal
from gripperd.model.kinds import InSensor
from gripperd.model.parameter import amplitude
from gripperd.model.track import Array, Track


@dataclass(frozen=True, slots=True)
class ForceSensorDrift(InSensor):
    r"""Every reading is off in proportion to the clock: :math:`F_r = F + r t`."""

    name: ClassVar[str] = "force_sensor_drift"
    needs: ClassVar[frozenset[str]] = frozenset({"force"})
    shows: ClassVar[str] = (
        "the measured force drifts with the clock at the same rate all the time,"
        " whatever the muscle does, also across the rests between runs"
    )
    confused_with: ClassVar[tuple[str, ...]] = (
        "creep", "fatigue", "force_sensor_bias",
    )  # fmt: skip
    remedy: ClassVar[str] = "let the amplifier warm up, and tare before each run"

    rate: float = amplitude(unit="N_per_s", scale=0.01, low=-10.0, high=10.0)
    """Growth of reading minus truth, 0 at the start of the recording. [N/s]"""

    @property
    def signal(self) -> Signal:
        """The pull."""
        return Signal.FORCE

    def along(self, value: Array, track: Track, memory: Array) -> Array:
        """Reading of a pull. [N]."""
        return value + self.rate * track.time

    def truth(self, reading: Array, track: Track) -> Array:
        """Pull behind a reading. [N]."""
        return reading - self.rate * track.time
