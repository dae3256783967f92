"""What the jaws are seen to hold, whoever moved them."""

from gripperd.control.force import ForceSense
from gripperd.control.release import SLACK_PRESSURE
from gripperd.control.states import Grip
from gripperd.model import Chain
from gripperd.signals import Measurement

LOST_SAMPLES = 5
"""Samples without contact after which a held part counts as lost."""


class GripWatch:
    """Looks at every measurement, also while no command runs."""

    def __init__(self, chain: Chain) -> None:
        self._force = ForceSense(chain)
        self._pressure: float | None = None
        self._contactless = 0

    def update(self, measured: Measurement, dt: float) -> None:
        """Take in the newest measurement."""
        self._force.update(measured, dt)
        self._pressure = measured.pressure.value
        blind = self._force.now.value is None
        self._contactless = 0 if blind or self.touching else self._contactless + 1

    @property
    def touching(self) -> bool:
        """Whether the jaws press on something."""
        return self._force.touching

    @property
    def lost(self) -> bool:
        """Whether a part that was held is gone."""
        return self._contactless >= LOST_SAMPLES

    @property
    def interrupted(self) -> Grip:
        """Grip when a motion was cut short."""
        return Grip.HOLDING if self.touching else Grip.UNKNOWN

    def seen(self) -> Grip:
        """Grip as it looks, without knowing how it came about."""
        if self.touching:
            return Grip.HOLDING
        if self._pressure is not None and self._pressure < SLACK_PRESSURE:
            return Grip.RELEASED
        return Grip.UNKNOWN
