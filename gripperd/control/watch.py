"""What the jaws are seen to hold, whoever moved them."""

from gripperd.control.force import ForceSense
from gripperd.control.release import SLACK_PRESSURE
from gripperd.control.states import Grip
from gripperd.signals import Measurement

LOST_SAMPLES = 5
"""Samples without contact after which a held part counts as lost."""
LOST_TRAVEL = 2e-3
"""Closing of the jaws that tells the same, where no sensor feels the force. [m]"""


class GripWatch:
    """Looks at every measurement, also while no command runs."""

    def __init__(self) -> None:
        self._force = ForceSense()
        self._measured: Measurement | None = None
        self._held_at: float | None = None
        self._missing = 0

    def update(self, measured: Measurement, dt: float) -> None:
        """Take in the newest measurement."""
        self._force.update(measured, dt)
        self._measured = measured
        self._missing = self._missing + 1 if self._misses(measured) else 0

    def hold(self) -> None:
        """From now on there is a part to be lost."""
        self._missing = 0
        self._held_at = None
        if self._measured is not None:
            self._held_at = self._measured.opening.value

    @property
    def touching(self) -> bool:
        """Whether the jaws press on something."""
        return self._force.touching

    @property
    def interrupted(self) -> Grip:
        """Grip when a motion was cut short."""
        if self.touching:
            return Grip.HOLDING
        # Only a sensor can tell that nothing is held; the model misses a light grip.
        return Grip.NO_PART if self._force.measured else Grip.UNKNOWN

    @property
    def unmoved(self) -> bool:
        """Whether the jaws are where they were when there was a part to be lost."""
        opening = None if self._measured is None else self._measured.opening.value
        if opening is None or self._held_at is None:
            return False
        return abs(opening - self._held_at) < LOST_TRAVEL

    @property
    def lost(self) -> bool:
        """Whether the part that was held is gone."""
        return self._missing >= LOST_SAMPLES

    def seen(self) -> Grip:
        """Grip as it looks, without knowing how it came about."""
        pressure = None if self._measured is None else self._measured.pressure.value
        slack = pressure is not None and pressure < SLACK_PRESSURE
        if slack and not self.touching:
            return Grip.RELEASED
        return self.interrupted

    def _misses(self, measured: Measurement) -> bool:
        if self._force.measured:
            return not self.touching
        opening = measured.opening.value
        if opening is None or self._held_at is None:
            return False
        return opening < self._held_at - LOST_TRAVEL
