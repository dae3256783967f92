"""Which loops may be closed on what the sensors say."""

from enum import StrEnum

from gripperd.signals import Measurement, Quality

RETURN_AFTER = 1.0
"""How long a sensor must be good again before it is believed again. [s]"""


class Level(StrEnum):
    """What the pressure is corrected by."""

    MANUAL = "manual"
    """Nothing: a client has set the current."""
    MODEL = "model"
    """Nothing: no sensor can be believed, or no correction is allowed."""
    PRESSURE = "pressure"
    """The measured pressure."""
    FORCE = "force"
    """The measured force, and the measured pressure where there is one."""


_ORDER = (Level.MODEL, Level.PRESSURE, Level.FORCE)


class Trust:
    """The highest level that the sensors allow: down at once, up after a while."""

    def __init__(self) -> None:
        self.level: Level | None = None
        self._better = 0.0

    def update(self, measured: Measurement, dt: float) -> Level:
        """Take in the newest measurement; dt is the time since the last. [s]."""
        allowed = _allowed(measured)
        if self.level is None or _ORDER.index(allowed) <= _ORDER.index(self.level):
            self.level, self._better = allowed, 0.0
            return allowed
        self._better += dt
        if self._better >= RETURN_AFTER:
            self.level, self._better = allowed, 0.0
        return self.level


def _allowed(measured: Measurement) -> Level:
    if measured.grip.quality is Quality.GOOD:
        return Level.FORCE
    if measured.pressure.quality is Quality.GOOD:
        return Level.PRESSURE
    return Level.MODEL
