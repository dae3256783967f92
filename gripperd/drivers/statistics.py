"""What has happened on a bus since it was opened."""

from bisect import bisect_left
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

LATENCY_BOUNDS = (
    *(0.5e-3, 1e-3, 2e-3, 5e-3, 10e-3, 20e-3, 50e-3),
    *(0.1, 0.2, 0.5, 1.0, 2.0),
)
"""Upper bounds of the classes of latency, from loopback to a slow serial line. [s]"""


class Histogram:
    """How long requests took from the first octet sent to a reply believed."""

    def __init__(self) -> None:
        self.counts = [0] * (len(LATENCY_BOUNDS) + 1)
        """Requests in each class; the last is above every bound."""
        self.total = 0.0
        """Sum of all that was added. [s]"""

    def add(self, duration: float) -> None:
        """Count one duration. [s]."""
        self.counts[bisect_left(LATENCY_BOUNDS, duration)] += 1
        self.total += duration


@dataclass(frozen=True, slots=True, kw_only=True)
class BusSnapshot:
    """The figures at one moment; later ones do not change it."""

    requests: int
    connections: int
    discarded: int
    errors: Mapping[str, int]
    latency_counts: tuple[int, ...]
    """Replies in each class of `LATENCY_BOUNDS`; the last is above every bound."""
    latency_total: float
    """Sum of all latencies. [s]"""


@dataclass(slots=True)
class BusStatistics:
    """Figures of one bus, kept by its owner."""

    requests: int = 0
    """Requests sent."""
    connections: int = 0
    """Times that the line was opened."""
    discarded: int = 0
    """Octets received that belong to no reply that somebody waited for."""
    errors: Counter[str] = field(default_factory=Counter)
    """By the name of the error; ``connect`` is a failed attempt to open the line."""
    latency: Histogram = field(default_factory=Histogram)

    def snapshot(self) -> BusSnapshot:
        """The figures now, to be published."""
        return BusSnapshot(
            requests=self.requests,
            connections=self.connections,
            discarded=self.discarded,
            errors=MappingProxyType(dict(self.errors)),
            latency_counts=tuple(self.latency.counts),
            latency_total=self.latency.total,
        )
