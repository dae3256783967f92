"""Follows the grip force: whether the jaws touch, and its slow part."""

from gripperd.signals import Measurement, Quality, Reading

CONTACT_FORCE = 0.4
"""Force that closing on nothing aims at, and contact where the noise is not known: 8
sigma of the bench's sensor. [N]"""
CONTACT_SIGMAS = 8.0
"""Measured force that counts as contact, in sigma of the sensor's noise. [-]"""
CONTACT_FORCE_SUBSTITUTED = 3.0
"""The same where the model stands in for the sensor; it knows friction to that. [N]"""
TIME_CONSTANT = 0.1
"""Of the filter; far above the loop's period, far below a grasp. [s]"""


class ForceSense:
    """The grip force over the last samples."""

    def __init__(self) -> None:
        self.now = Reading.bad("not measured yet")
        self.filtered: float | None = None
        """None while there is no force to believe. [N]"""
        self._touches = 0

    def update(self, measured: Measurement, dt: float) -> None:
        """Take in the newest measurement."""
        self.now = measured.grip
        force = self.now.value
        if force is None:
            self.filtered, self._touches = None, 0
            return
        if self.filtered is None:
            self.filtered = force
        self.filtered += (force - self.filtered) * min(dt / TIME_CONSTANT, 1.0)
        self._touches = self._touches + 1 if force > self._threshold() else 0

    @property
    def touching(self) -> bool:
        """Whether the jaws press on something.

        Two samples in a row, so that a single spike is not taken for an object.
        """
        return self._touches >= 2

    @property
    def measured(self) -> bool:
        """Whether the force comes from a sensor."""
        return self.now.quality is Quality.GOOD

    def _threshold(self) -> float:
        if not self.measured:
            return CONTACT_FORCE_SUBSTITUTED
        noise = self.now.noise
        return CONTACT_FORCE if noise is None else CONTACT_SIGMAS * noise
