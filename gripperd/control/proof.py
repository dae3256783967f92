"""A grip that proves itself: kept for a while, watched for slip."""

from statistics import fmean

from gripperd.signals import Measurement

DURATION = 0.7
"""How long a grip must prove itself: a slipping object falls 20 mm meanwhile. [s]"""
DROP = 0.5
"""Share of the force that may vanish meanwhile. [-]"""
TRAVEL = 2e-3
"""Closing of the jaws that tells of a lost object. [m]"""


class Proof:
    """The grip from the moment its target is reached.

    Parameters
    ----------
    force
        Filtered force at that moment. [N]
    opening
        Opening at that moment, if known. [m]
    """

    def __init__(self, force: float, opening: float | None) -> None:
        self._force = force
        self._opening = opening
        self._forces: list[float] = []

    def add(self, force: float) -> None:
        """Take in one more force. [N]."""
        self._forces.append(force)

    @property
    def force(self) -> float | None:
        """Mean force so far. [N]."""
        return fmean(self._forces) if self._forces else None

    def slipped(self, filtered: float, measured: Measurement) -> bool:
        """Whether the object is on its way out."""
        if filtered < DROP * self._force:
            return True
        now = measured.opening.value
        if now is None or self._opening is None:
            return False
        return now < self._opening - TRAVEL
