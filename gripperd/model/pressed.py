"""What the jaws press on."""

from dataclasses import dataclass

RIGID = float("inf")
"""Stiffness of an object that does not yield. [N/m]"""


@dataclass(frozen=True, slots=True)
class PressedObject:
    """What stands between the jaws."""

    diameter: float
    """Distance between the jaws at first contact. [m]"""
    stiffness: float = RIGID
    """Grip force per jaw for a metre of yielding. [N/m]"""
