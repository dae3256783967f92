"""A sensor that repeats itself: at rest, or stuck."""

from math import log

REMEMBERED = 30.0
"""Over which it is learned how often a sensor repeats itself when it is well; in the
first seconds every sample counts the same. [s]"""
IMPROBABLE = 1e-12
"""A row of equal samples that is less likely is no chance: less than once in 300 years
at 100 Hz. [-]"""
SHORTEST = 20
"""Equal samples that are never too many. [-]"""
DOUBTED = 0.5
"""For so long a sensor counts as one that always repeats itself, before any sample. [s]
"""


class Frozen:
    """Counts equal samples against how common they are for this sensor.

    A sensor without noise repeats itself for ever at rest and is never called stuck by
    this; how common repeats are is therefore learned at rest only.
    """

    def __init__(self) -> None:
        self.seconds = 0.0
        """How long it has said the same. [s]"""
        self._repeats = 1.0
        self._learned = DOUBTED
        self._row = 0
        self._last: float | None = None

    def update(self, value: float | None, dt: float, *, resting: bool) -> bool:
        """Take in a sample; True while it is too often the same.

        Parameters
        ----------
        value
            As it came from the module.
        dt
            Time since the last sample. [s]
        resting
            Whether nothing is meant to move.
        """
        same = value is not None and value == self._last
        self._last = value
        self._row = self._row + 1 if same else 0
        self.seconds = self.seconds + dt if same else 0.0
        stuck = self._row >= SHORTEST and self._row * log(self._repeats) < log(
            IMPROBABLE
        )
        if resting and value is not None and not stuck:
            self._learned += dt
            weight = dt / min(self._learned, REMEMBERED)
            self._repeats += (same - self._repeats) * weight
        return stuck
