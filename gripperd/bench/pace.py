"""How fast characters travel on a serial line."""

from dataclasses import dataclass

from gripperd.errors import InputError

START_AND_DATA = 9
"""Bits of a character before parity and stop."""
FASTEST = 1_000_000
"""[Bd]"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Pace:
    """Speed of a line, and the silence that parts its frames.

    Raises
    ------
    InputError
        Not 1 to 1,000,000 Bd.
    """

    baud: int = 9600
    """[Bd]"""
    parity: bool = False
    stop_bits: int = 1
    silence: float = 0.0
    """Of a module between a request and its reply. [s]"""

    def __post_init__(self) -> None:
        if not 1 <= self.baud <= FASTEST:
            message = f"baud = {self.baud} Bd: must be 1 to {FASTEST}"
            raise InputError(message, key="baud")

    @property
    def character(self) -> float:
        """Time of one character. [s].

        >>> round(Pace(baud=9600).character, 6)
        0.001042
        """
        return (START_AND_DATA + self.parity + self.stop_bits) / self.baud
