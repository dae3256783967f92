"""Readings that a check does not believe."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from gripperd.diagnose.readings.recording import Run

Mask: TypeAlias = NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Fault:
    """Readings of one column of one run, and why they are not believed."""

    run: int
    """Position of the run in the recording."""
    quantity: str
    """Column of the run, such as ``force``."""
    rows: Mask
    """Shape ``(n,)``."""
    reason: str


Check: TypeAlias = Callable[[Sequence[Run]], Iterator[Fault]]
"""Looks at all runs of a recording, because a floor shows in many of them."""
