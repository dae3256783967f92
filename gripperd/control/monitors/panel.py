"""Every monitor of one gripper."""

from gripperd.control.monitors.jaws import JawBlocked
from gripperd.control.monitors.part import ForceDrift, OverForce, PartLost, Slip
from gripperd.control.monitors.pressure import PressureFollows
from gripperd.control.monitors.sensor import SensorFailed
from gripperd.control.monitors.sight import Monitor, Sight, Symptom


class Panel:
    """All monitors at once."""

    def __init__(self) -> None:
        self._monitors: tuple[Monitor, ...] = (
            PartLost(),
            Slip(),
            ForceDrift(),
            OverForce(),
            PressureFollows(),
            JawBlocked(),
            SensorFailed(),
        )

    def look(self, sight: Sight, dt: float) -> tuple[Symptom, ...]:
        """Take in one sample; everything that is wrong now."""
        return tuple(
            symptom for monitor in self._monitors for symptom in monitor.look(sight, dt)
        )
