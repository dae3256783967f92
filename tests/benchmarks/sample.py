"""Durations and what to say of them."""

import statistics
import time
from collections.abc import Callable, Sequence


def repeated(work: Callable[[], object], times: int) -> list[float]:
    """Durations of a piece of work, done again and again. [s]."""
    durations = []
    for _ in range(times):
        start = time.perf_counter()
        work()
        durations.append(time.perf_counter() - start)
    return durations


def median(durations: Sequence[float]) -> float:
    return statistics.median(durations)


def p99(durations: Sequence[float]) -> float:
    return sorted(durations)[min(int(0.99 * len(durations)), len(durations) - 1)]
