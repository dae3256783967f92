"""One signal in one sweep: the piece by which residuals are kept."""

from typing import NamedTuple

from gripperd.diagnose.fault import Mask
from gripperd.model.effect import Signal


class Block(NamedTuple):
    """One signal in one sweep."""

    course: int
    signal: Signal
    good: Mask
    """Samples to explain, shape ``(n,)``."""
