"""Contacts of the simulated rig: what outside allows it to move."""

from collections.abc import Set as AbstractSet
from enum import StrEnum

CLOSED = 20e-3
OPEN = 4e-3
"""What a contact lets through, with a resistor beside it that shows a cut wire. [A]"""


class Contact(StrEnum):
    """Contacts on the channels of the input module that follow the sensors."""

    ENABLE = "enable"
    """Closed: motion is allowed."""
    ESTOP = "estop"
    """Closed: the emergency stop is not pressed."""

    @property
    def channel(self) -> int:
        """Where it is wired to."""
        return {Contact.ENABLE: 3, Contact.ESTOP: 4}[self]


def currents(opened: AbstractSet[Contact]) -> tuple[float, ...]:
    """Loop currents of all contacts, in the order of their channels. [A].

    >>> currents({Contact.ESTOP})
    (0.02, 0.004)
    """
    return tuple(OPEN if each in opened else CLOSED for each in Contact)
