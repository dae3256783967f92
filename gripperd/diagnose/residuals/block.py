"""One signal in one sweep, by which residuals are kept, and sweeps of one kind."""

from typing import NamedTuple

from gripperd.diagnose.noise.model import Noise
from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.readings.fault import Mask
from gripperd.model.effect import Signal
from gripperd.model.track import Array


class Block(NamedTuple):
    """One signal in one sweep."""

    course: int
    signal: Signal
    good: Mask
    """Samples to explain, shape ``(n,)``."""
    noise: Noise | None = None
    """Its own; none for that of the signal. [SI]"""
    ages: Array | None = None
    """Memories that its drift has been through, shape ``(n,)``; none for its clock."""


class Group(NamedTuple):
    """All sweeps that explain some signals, end to end."""

    places: tuple[int, ...]
    """Of each sweep in the recording."""
    signals: tuple[Signal, ...]
    whole: Course
