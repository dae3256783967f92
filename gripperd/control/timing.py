"""How well a loop keeps its time: distributions that can be kept for years."""

from bisect import bisect_left
from dataclasses import dataclass
from itertools import accumulate

BOUNDS = tuple(10e-6 * 2 ** (step / 4) for step in range(81))
"""Upper ends of the classes, 19 % apart, 10 µs to 10 s; one more class is open. [s]"""


@dataclass(frozen=True, slots=True)
class Distribution:
    """Durations, counted by class."""

    counts: tuple[int, ...]
    """One for each of the bounds, and the open class."""
    total: float
    """Their sum. [s]"""
    largest: float
    """The longest. [s]"""

    @property
    def count(self) -> int:
        """How many there were."""
        return sum(self.counts)

    def quantile(self, share: float) -> float | None:
        """Duration that this share did not exceed, to a class; None without any. [s].

        Parameters
        ----------
        share
            0 to 1.
        """
        if not self.count:
            return None
        reached = share * self.count
        for bound, below in zip(BOUNDS, accumulate(self.counts), strict=False):
            if below >= reached:
                return min(bound, self.largest)
        return self.largest

    def since(self, earlier: "Distribution") -> "Distribution":
        """What has come since an earlier one of the same; the longest to a class."""
        pairs = zip(self.counts, earlier.counts, strict=True)
        counts = tuple(now - before for now, before in pairs)
        highest = max((n for n, count in enumerate(counts) if count), default=0)
        largest = min((*BOUNDS, self.largest)[highest], self.largest)
        return Distribution(counts, self.total - earlier.total, largest)


class Histogram:
    """Counts durations. [s]."""

    def __init__(self) -> None:
        self._counts = [0] * (len(BOUNDS) + 1)
        self._total = self._largest = 0.0

    def add(self, duration: float) -> None:
        """Count one more."""
        self._counts[bisect_left(BOUNDS, duration)] += 1
        self._total += duration
        self._largest = max(self._largest, duration)

    def read(self) -> Distribution:
        """All so far."""
        return Distribution(tuple(self._counts), self._total, self._largest)


@dataclass(frozen=True, slots=True, kw_only=True)
class Timing:
    """How punctual one control loop has been since its start."""

    target: float
    """Period asked for. [s]"""
    period: Distribution
    """Time from one start to the next."""
    lateness: Distribution
    """Time from the deadline of a period to its start."""
    overruns: int
    """Periods that started late because the one before was not over."""
