"""Whether the pieces of a recording agree: at one place there is one reading.

Two muscles in one file, a column in another unit for half of it, a cell that came
loose: sweeps fall into camps that agree inside and differ by a factor between, where
pressure and contraction are the same. No effect of a muscle does that.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.polynomial.polynomial import polyvander2d
from scipy.sparse.csgraph import connected_components

from gripperd.diagnose.readings.believed import believed
from gripperd.diagnose.readings.columns import BY_QUANTITY
from gripperd.diagnose.readings.recording import Contradiction, Recording, Run
from gripperd.model.track import Array

PLANS = (("force", ("pressure", "contraction")), ("force", ("pressure", "length")))
"""What is compared, and what has to be the same for it."""
LEVELS = 12
"""Parts of the range of each of those."""
WEAK = 0.1
"""Share of the largest reading below which a place tells nothing. [-]"""
APART = 1.6
"""Factor between camps. Hysteresis, wear and warmth together stay below it. [-]"""
SHARE = 1 / 3
"""Of the sweeps that can be compared, in the smaller camps. [-]"""
FEWEST = 2
"""Sweeps in a camp."""
FLAT = 0.18
"""What one surface leaves of the readings of camps that it reconciles, of their root
mean square: two that differ by :data:`APART` leave a fifth. [-]"""
DEGREES = [2, 4]
"""Of the surface, in pressure and in contraction or length."""
STEEP = 1.7
"""Size of its coefficients over half of each range, of that root mean square: with
steeper ones the offset of a mount would carry any factor. [-]"""
LEFT = 0.5
"""Share of the rows that has to remain when contradicting sweeps are left out. [-]"""


@dataclass(frozen=True, slots=True)
class Atlas:
    """One sweep as mean readings over places."""

    name: str
    readings: Array
    """Shape of the places, NaN where the sweep did not go."""
    stands: Array
    """Where in each place on average, from -1 to 1 over all; shape ``(places, 2)``."""


def beyond_use(recording: Recording) -> tuple[Contradiction, ...]:
    """Give the contradictions no verdict can rest on; none when it can be judged.

    These are camps of sweeps that disagree by a factor at the same places, and repeats
    that contradict each other when too few rows are left without the weaker.
    """
    if camps := tuple(dict.fromkeys(_all_camps(recording.runs))):
        return camps
    rows, left = (
        sum(len(run) for run in one.runs) for one in (recording, believed(recording))
    )
    return recording.contradictions if left < LEFT * rows else ()


def _all_camps(runs: Sequence[Run]) -> Iterator[Contradiction]:
    for outcome, places in PLANS:
        pairs = list(_camps(_atlases(runs, outcome, places)))
        comparable = sum(len(first) + len(second) for first, second in pairs)
        smaller = sum(min(len(first), len(second)) for first, second in pairs)
        if smaller and smaller >= SHARE * comparable:
            for first, second in pairs:
                if first and second and not _reconciled([*first, *second]):
                    yield _contradiction(first, second, outcome)


def _atlases(runs: Sequence[Run], outcome: str, places: tuple[str, ...]) -> list[Atlas]:
    able = [run for run in runs if all(run.has(name) for name in (outcome, *places))]
    if not able:
        return []
    ranges = [_range(able, name) for name in places]
    return [_atlas(run, outcome, places, ranges) for run in able]


def _range(runs: Sequence[Run], name: str) -> tuple[float, float]:
    values = np.concatenate([run.columns[name] for run in runs])
    return float(np.nanmin(values)), float(np.nanmax(values))


def _atlas(
    run: Run,
    outcome: str,
    places: tuple[str, ...],
    ranges: Sequence[tuple[float, float]],
) -> Atlas:
    values = np.column_stack([run.columns[name] for name in (outcome, *places)])
    values = values[np.isfinite(values).all(1)]
    low, high = np.transpose(ranges)
    stands = (values[:, 1:] - low) / np.where(high > low, high - low, 1.0)
    cells = np.minimum((stands * LEVELS).astype(np.intp), LEVELS - 1)
    place = np.ravel_multi_index(tuple(cells.T), (LEVELS,) * len(places))
    counts = np.bincount(place, minlength=LEVELS ** len(places))
    with np.errstate(invalid="ignore"):
        means = [
            np.bincount(place, weights=column, minlength=counts.size) / counts
            for column in (values[:, 0], *(2 * stands.T - 1))
        ]
    return Atlas(run.name, means[0], np.column_stack(means[1:]))


def _camps(atlases: Sequence[Atlas]) -> Iterator[tuple[list[Atlas], list[Atlas]]]:
    """Split sweeps that can be compared, through others if need be, into camps.

    The second camp is empty where they agree.
    """
    if not atlases:
        return
    shared, ratios = _compared(atlases)
    count, labels = connected_components(shared)
    for label in range(count):
        members = np.flatnonzero(labels == label)
        if members.size < 2 * FEWEST:
            continue
        part = np.ix_(members, members)
        gains = _gains(shared[part], ratios[part])
        order = np.argsort(gains)
        gaps = np.diff(gains[order])[FEWEST - 1 : 1 - FEWEST]
        cut = FEWEST + int(np.argmax(gaps)) if gaps.max() > np.log(APART) else 0
        camps = [members[sorted(half)] for half in (order[:cut], order[cut:])]
        first, second = sorted(camps, key=lambda camp: camp.min(initial=len(atlases)))
        yield [atlases[i] for i in first], [atlases[i] for i in second]


def _compared(atlases: Sequence[Atlas]) -> tuple[Array, Array]:
    """Weight of each pair of sweeps, and log of how much larger the first reads.

    Both of shape ``(n, n)``; a pair without places in common has no weight.
    """
    readings = np.array([one.readings for one in atlases])
    loudest = np.max(np.nan_to_num(np.abs(readings)), axis=0)
    readings[:, loudest < WEAK * np.max(loudest)] = np.nan
    seen = np.isfinite(readings).astype(np.float64)
    # Sum of squares of the first of a pair over the places of the second.
    power = np.nan_to_num(readings) ** 2 @ seen.T
    comparable = (power > 0) & (power.T > 0)
    np.fill_diagonal(comparable, val=False)
    shared = np.where(comparable, np.sqrt(power * power.T), 0.0)
    ratios = np.zeros_like(shared)
    ratios[comparable] = 0.5 * np.log(power[comparable] / power.T[comparable])
    return shared, ratios


def _reconciled(atlases: Sequence[Atlas]) -> bool:
    """Whether one smooth surface goes through the readings of all: ridge regression."""
    reading = np.concatenate([one.readings for one in atlases])
    stands = np.concatenate([one.stands for one in atlases])
    seen = np.isfinite(reading)
    surface = polyvander2d(stands[seen, 0], stands[seen, 1], DEGREES)
    held = (FLAT / STEEP) ** 2 * seen.sum() * np.eye(surface.shape[1])
    best = np.linalg.solve(surface.T @ surface + held, surface.T @ reading[seen])
    left = reading[seen] - surface @ best
    return bool(left @ left < FLAT**2 * (reading[seen] @ reading[seen]))


def _gains(shared: Array, ratios: Array) -> Array:
    """Log factor of each sweep that explains the ratios best, by least squares."""
    laplacian = np.diag(shared.sum(1)) - shared
    return np.asarray(np.linalg.lstsq(laplacian, (shared * ratios).sum(1))[0])


def _contradiction(
    first: Sequence[Atlas], second: Sequence[Atlas], outcome: str
) -> Contradiction:
    column = BY_QUANTITY[outcome]
    camps = [np.array([one.readings for one in camp]) for camp in (first, second)]
    seen = np.logical_and(*(np.isfinite(camp).any(0) for camp in camps))
    here, there = (np.nanmean(camp[:, seen], axis=0) for camp in camps)
    off = here - there
    return Contradiction(
        runs=tuple(one.name for one in first),
        others=tuple(one.name for one in second),
        column=column.name,
        difference=float(np.sqrt(np.mean(off**2)) * np.sign(off.mean())) / column.scale,
        unit=column.unit,
        spread=_spread(camps) / column.scale,
    )


def _spread(camps: Sequence[Array]) -> float:
    """How far sweeps of a camp differ where several went, 1 sigma; NaN if none did."""
    squares, again = 0.0, 0
    for camp in camps:
        twice = camp[:, np.isfinite(camp).sum(0) > 1]
        squares += float(np.nansum((twice - np.nanmean(twice, axis=0)) ** 2))
        again += int(np.isfinite(twice).sum()) - twice.shape[1]
    return (squares / again) ** 0.5 if again else np.nan
