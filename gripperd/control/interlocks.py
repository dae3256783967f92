"""What from outside forbids to move: an enable contact, an emergency-stop contact.

A contact counts as closed only while its loop says so: a cut wire, a dead module and a
reading that cannot be believed are open. gripperd is no safety function: what protects
people acts on the valve's supply, these only let the program know.
"""

from gripperd.signals import Measurement, Quality, Reading

CLOSED = 0.5
"""Share of the live span that is closed: 12 mA of 4-20 mA. [-]"""
SAMPLES = 2
"""Samples in a row until a contact is believed to have changed."""


def closed(reading: Reading) -> bool:
    """Whether one sample of a contact forbids nothing."""
    return reading.quality is Quality.ABSENT or (
        reading.value is not None and reading.value > CLOSED
    )


class Interlocks:
    """The two contacts of one gripper; one that is not fitted forbids nothing."""

    def __init__(self) -> None:
        self._enable = _Contact()
        self._estop = _Contact()

    def update(self, measured: Measurement) -> None:
        """Take in the newest measurement."""
        self._enable.update(measured.enable)
        self._estop.update(measured.estop)

    @property
    def enabled(self) -> bool:
        """Whether a motion may begin or go on."""
        return self._enable.closed

    @property
    def estopped(self) -> bool:
        """Whether the emergency stop is pressed, or its wire is cut."""
        return not self._estop.closed


class _Contact:
    """One contact, debounced."""

    def __init__(self) -> None:
        self.closed = True
        self._differs = 0

    def update(self, reading: Reading) -> None:
        now = closed(reading)
        self._differs = self._differs + 1 if now is not self.closed else 0
        if self._differs >= SAMPLES:
            self.closed, self._differs = now, 0
