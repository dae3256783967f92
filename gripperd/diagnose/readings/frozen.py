"""Channels that stopped: the last value is repeated as if it were new."""

from collections.abc import Iterator, Sequence

import numpy as np

from gripperd.diagnose.readings.fault import Fault
from gripperd.diagnose.readings.recording import Run
from gripperd.diagnose.readings.stretches import (
    Stretch,
    resolution,
    roughness,
    stretches,
)
from gripperd.model.track import Array

REASON = "frozen value"
SHORTEST = 10
"""Samples."""
COMMANDED = frozenset({"time", "current", "object"})
"""What is set, not measured, and so may stand still for ever."""

RARE = 0.02
"""Share of equal neighbours up to which a channel is said never to repeat itself."""
ORDER = 4
"""Of the differences that show noise; a vibration leaves less in higher ones."""
ALTERNATING = 0.65
"""Share of these differences that change sign: 0.8 for white noise, hardly less for
first-order autoregressive noise of correlation 0.6, next to none for what is smooth."""
COARSE = 3.0
"""Noise under so many resolutions may be that of rounding alone."""
FEWEST = 20
"""Samples outside that are needed to know how a channel behaves."""

BOUND = (("force", "pressure"), ("pressure", "force"))
"""At constant contraction one of them cannot stand while the other moves."""
TRAVEL = 0.25
"""Share of the range through which the other has to move."""


def frozen(runs: Sequence[Run]) -> Iterator[Fault]:
    """Find channels whose noise stops, or that stand while what drives them moves.

    A channel without noise of its own, such as a locked contraction, a coarse converter
    or a command, is never said to be frozen because it repeats itself.
    """
    for index, run in enumerate(runs):
        for quantity, values in run.columns.items():
            if quantity in COMMANDED:
                continue
            for stretch in _noise_stops(values):
                yield Fault(index, quantity, stretch.mask(len(run)), REASON)
    for quantity, other in BOUND:
        yield from _left_behind(runs, quantity, other)


def _noise_stops(values: Array) -> Iterator[Stretch]:
    long = list(stretches(values, SHORTEST))
    if not long:
        return
    outside = values.copy()
    for stretch in long:
        outside[stretch.rows] = np.nan
    if noisy(outside):
        yield from long


def noisy(values: Array) -> bool:
    """Whether what is known of a column has noise well above its resolution."""
    seen = values[np.isfinite(values)]
    if seen.size < FEWEST:
        return False
    bends = np.diff(seen, ORDER)
    return bool(
        np.mean(np.diff(seen) == 0.0) <= RARE
        and np.mean(bends[1:] * bends[:-1] < 0.0) >= ALTERNATING
        and roughness(seen, ORDER) >= COARSE * resolution(seen)
    )


def _left_behind(runs: Sequence[Run], quantity: str, other: str) -> Iterator[Fault]:
    reached = [run.columns[other] for run in runs if run.has(other)]
    if not reached:
        return
    everywhere = np.concatenate(reached)
    enough = TRAVEL * float(np.nanmax(everywhere) - np.nanmin(everywhere))
    found = [
        Fault(index, quantity, stretch.mask(len(run)), REASON)
        for index, run in enumerate(runs)
        if run.has(quantity)
        for stretch in stretches(run.columns[quantity], SHORTEST)
        if stretch.travel(run, other) >= enough > 0.0 and stretch.held(run)
    ]
    yield from found
    if found and _never_changes(runs, quantity):
        for index, run in enumerate(runs):
            if run.has(quantity):
                read = np.isfinite(run.columns[quantity])
                yield Fault(index, quantity, read, REASON)


def _never_changes(runs: Sequence[Run], quantity: str) -> bool:
    read = np.concatenate([run.columns[quantity] for run in runs if run.has(quantity)])
    return bool(np.ptp(read[np.isfinite(read)]) == 0.0)
