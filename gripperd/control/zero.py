"""The zero of the force sensor of one gripper, and since when it counts."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Zero:
    """What the force sensor shows without a load."""

    force: float = 0.0
    """Per jaw. [N]"""
    taken_at: float | None = None
    """Seconds since the epoch; None: it was never tared."""


UNTARED = Zero()
"""The sensor is believed as it is."""
