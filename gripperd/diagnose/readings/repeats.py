"""Sweeps that were measured several times, and whether the repeats agree."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from gripperd.diagnose.noise.model import CONSISTENT
from gripperd.diagnose.readings.columns import BY_QUANTITY
from gripperd.diagnose.readings.fault import Mask
from gripperd.diagnose.readings.recording import Contradiction, Run
from gripperd.model.track import Array

PLANS = (
    ("force", "contraction", "pressure"),
    ("force", "length", "pressure"),
    ("force", "pressure", "contraction"),
    ("force", "pressure", "length"),
    ("grip", "opening", "pressure"),
)
"""What is compared, what is held in the sweep, what is swept."""
HELD = {"contraction": 0.003, "length": 1e-3, "pressure": 8e3, "opening": 1e-3}
"""Range within which a quantity counts as held, and as the same. [SI]"""
SAME = {"temperature": 3.0, "object": 1e-3, "supply": 50e3}
"""What else has to be the same, to within. [SI]"""
LEVELS = 12
"""Parts of the swept range, up and down apart."""
COMMON = 0.5
"""Share of those parts that two sweeps have in common at least."""
LULL = 9
"""Samples over which the direction of a sweep is judged."""

APART = 6.0
"""Distance of two groups, in standard deviations of the repeats in one."""
MATERIAL = 0.15
"""Distance of two groups, as a share of the range of the sweep. The first inflation
after a rest differs by less, and may well alternate with the second."""
ABRUPT = 10.0
"""Where the groups do not alternate: distance in the largest difference inside one, as
no trend makes it."""
FEWEST_ALTERNATING, FEWEST_IN_ROW = 2, 3
"""Runs in the smaller group."""


@dataclass(frozen=True, slots=True)
class Sweep:
    """One run as a curve over levels of what was swept."""

    order: int
    run: Run
    place: float
    """Value of what was held. [SI]"""
    curve: Array
    """Means of the outcome, NaN where the sweep did not go, shape ``(2 * LEVELS,)``."""


def contradictions(runs: Sequence[Run]) -> tuple[Contradiction, ...]:
    """Find repeats of one sweep that fall into two groups which do not agree.

    A single run that differs (a first cycle) and a slow change (fatigue, drift) are
    physics, and no contradiction: the groups have to alternate in time, or to be
    separated by a jump between two runs that follow each other.
    Sweeps in which nothing is held are not compared.
    """
    found = (
        contradiction
        for outcome, held, swept in PLANS
        for family in _families(_sweeps(runs, outcome, held, swept), HELD[held])
        for contradiction in _split(family, outcome)
    )
    # Contraction and length, where both were measured, find the same.
    return tuple(dict.fromkeys(found))


def _sweeps(
    runs: Sequence[Run], outcome: str, held: str, swept: str
) -> tuple[Sweep, ...]:
    able = [
        (order, run)
        for order, run in enumerate(runs)
        if run.has(outcome) and run.has(swept) and _is_held(run, held)
    ]
    if not able:
        return ()
    reached = np.concatenate([run.columns[swept] for _, run in able])
    edges = np.linspace(np.nanmin(reached), np.nanmax(reached), LEVELS + 1)[1:-1]
    return tuple(
        Sweep(
            order,
            run,
            float(np.nanmedian(run.columns[held])),
            _curve(run.columns[swept], run.columns[outcome], edges),
        )
        for order, run in able
    )


def _is_held(run: Run, held: str) -> bool:
    return run.has(held) and _reach(run.columns[held]) <= HELD[held]


def _reach(values: Array) -> float:
    low, high = np.nanpercentile(values, (1, 99))
    return float(high - low)


def _curve(swept: Array, outcome: Array, edges: Array) -> Array:
    curve = np.full(2 * LEVELS, np.nan)
    believed = np.isfinite(swept) & np.isfinite(outcome)
    swept, outcome = swept[believed], outcome[believed]
    if swept.size < LULL:
        return curve
    part = np.searchsorted(edges, swept) + LEVELS * _falling(swept)
    counts = np.bincount(part, minlength=2 * LEVELS)
    sums = np.bincount(part, weights=outcome, minlength=2 * LEVELS)
    curve[counts > 0] = sums[counts > 0] / counts[counts > 0]
    return curve


def _falling(swept: Array) -> Mask:
    smooth = np.convolve(np.pad(swept, LULL // 2, mode="edge"), np.ones(LULL), "valid")
    return np.gradient(smooth) < 0.0


def _families(sweeps: Sequence[Sweep], tolerance: float) -> Iterator[tuple[Sweep, ...]]:
    """Group sweeps at one place under the same conditions."""
    waiting = sorted(sweeps, key=lambda sweep: (sweep.place, sweep.order))
    while waiting:
        first = waiting[0]
        family = [
            sweep
            for sweep in waiting
            if sweep is first
            or (sweep.place - first.place <= tolerance and _alike(first, sweep))
        ]
        taken = {sweep.order for sweep in family}
        waiting = [sweep for sweep in waiting if sweep.order not in taken]
        yield tuple(sorted(family, key=lambda sweep: sweep.order))


def _alike(one: Sweep, other: Sweep) -> bool:
    for quantity, tolerance in SAME.items():
        if one.run.has(quantity) and other.run.has(quantity):
            here, there = (
                float(np.nanmedian(sweep.run.columns[quantity]))
                for sweep in (one, other)
            )
            if abs(here - there) > tolerance:
                return False
    seen, seen_too = np.isfinite(one.curve), np.isfinite(other.curve)
    return bool((seen & seen_too).sum() >= COMMON * max((seen | seen_too).sum(), 1))


def _split(family: Sequence[Sweep], outcome: str) -> Iterator[Contradiction]:
    if len(family) < 2 * FEWEST_ALTERNATING:
        return
    reach, level = _levels(np.array([sweep.curve for sweep in family]))
    gaps = np.diff(np.sort(level))[FEWEST_ALTERNATING - 1 : 1 - FEWEST_ALTERNATING]
    low = np.zeros(level.size, dtype=np.bool_)
    low[np.argsort(level)[: FEWEST_ALTERNATING + int(np.argmax(gaps))]] = True
    first = low if low[0] else ~low
    middle = np.where(low, np.median(level[low]), np.median(level[~low]))
    spread = CONSISTENT * float(np.median(np.abs(level - middle)))
    difference = float(np.median(level[first]) - np.median(level[~first]))
    apart = max(APART * spread, MATERIAL * reach)
    if abs(difference) > apart and (_alternate(first) or _jump(family, first, level)):
        column = BY_QUANTITY[outcome]
        yield Contradiction(
            runs=tuple(s.run.name for s, one in zip(family, first, strict=True) if one),
            others=tuple(
                s.run.name for s, one in zip(family, first, strict=True) if not one
            ),
            column=column.name,
            difference=difference / column.scale,
            unit=column.unit,
            spread=spread / column.scale,
        )


def _levels(curves: Array) -> tuple[float, Array]:
    """Range of the usual curve, and how far each curve is off it.

    The distance is taken along the one shape that tells the curves apart best, the
    first principal component; it is the root mean square over the levels, with the sign
    of the mean.
    """
    curves = curves[:, np.isfinite(curves).any(axis=0)]
    off = np.nan_to_num(curves - np.nanmean(curves, axis=0))
    shape = np.linalg.svd(off, full_matrices=False)[2][0]
    shape = shape if shape.sum() >= 0.0 else -shape
    reach = float(np.ptp(np.nanmedian(curves, axis=0)))
    return reach, off @ shape / np.sqrt(shape.size)


def _alternate(first: Mask) -> bool:
    return int(np.count_nonzero(first[1:] != first[:-1])) > 1


def _jump(family: Sequence[Sweep], first: Mask, level: Array) -> bool:
    """Whether the groups follow each other with a jump no trend leads to."""
    cut = int(first.sum())
    follows = family[cut].order == family[cut - 1].order + 1
    steps = np.abs(np.diff(level))
    inside = np.delete(steps, cut - 1).max()
    enough = FEWEST_IN_ROW <= cut <= level.size - FEWEST_IN_ROW
    return bool(follows and enough and steps[cut - 1] > ABRUPT * inside)
