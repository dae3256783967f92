"""Sweeps that take no part in fitting, on which the gap is judged.

References
----------
.. [1] D. R. Roberts et al., "Cross-validation strategies for data with temporal,
       spatial, hierarchical, or phylogenetic structure", Ecography 40(8), 913-929,
       2017: leave out whole blocks, for neighbours share noise and memory.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from gripperd.diagnose.readings.course import Course
from gripperd.diagnose.readings.cycle import VENTED
from gripperd.diagnose.readings.fault import Mask
from gripperd.diagnose.readings.grasp import PRESSED
from gripperd.diagnose.residuals.problem import Problem
from gripperd.diagnose.residuals.quiet import HELD
from gripperd.model.effect import Signal
from gripperd.model.track import Array

SHARE = 0.2
"""Of the sweeps that can be spared. [-]"""
FEW = 5
"""With fewer sweeps none can be spared: the end of each is left out instead."""
TAIL = 0.25
"""Part of a sweep that is left out then. [-]"""
FEW_JAWS = 3
"""With fewer sweeps of the jaws none of them can be spared."""
PLACES = ("current", "pressure", "contraction", "grip")
"""Inputs that say where a sweep goes."""
CONDITIONS = (*PLACES, "temperature")
"""All inputs. No two sweeps of a day are equally warm: this may be asked too much."""
COMMANDED = ("current", "pressure")
"""Inputs of which one rests in a hold."""
MARGIN = 0.02
"""Share of a range by which a sweep may go further than all others. [-]"""
FASTER = 1.5
"""Times the speed of all others from which a sweep alone shows what speed does. [-]"""
QUICKLY = 0.9
"""Quantile that stands for the speed of a sweep: at a corner any may leap. [-]"""


@dataclass(frozen=True)
class Split:
    """A recording in two parts that share no sweep, or no stretch of one."""

    train: Problem
    test: Problem
    runs: tuple[str, ...]
    """Names of what was left out."""


def split(problem: Problem) -> Split:
    """Leave out every fifth sweep that lies within what the others cover."""
    courses = problem.courses
    if len(courses) < FEW:
        cut = [_tail(course) for course in courses]
        names = tuple(f"{course.run} (last quarter)" for course in courses)
    else:
        out = _spared(problem)
        cut = [
            np.full(len(course), index in out) for index, course in enumerate(courses)
        ]
        names = tuple(courses[index].run for index in sorted(out))
    test = tuple(cut)
    train = tuple(~mask for mask in cut)
    return Split(replace(problem, kept=train), replace(problem, kept=test), names)


def _tail(course: Course) -> Mask:
    mask = np.zeros(len(course), dtype=bool)
    mask[round((1 - TAIL) * len(course)) :] = True
    return mask


def _spared(problem: Problem) -> set[int]:
    """Sweeps whose inputs lie inside the range of the rest, spread over the order.

    The first inflation of a recording stays, and what was before it: only it can show
    what a first one differs in. So does the last that shows a signal, the only one in
    which the muscle is fast, or its pressure: what speed does shows in it alone, the
    only one in which jaws travel, and each of two in which they press: one alone does
    not tell friction from a spring.
    """
    courses, shown = problem.courses, _shown(problem)
    jaws = [index for index in shown if _opens(courses[index])]
    grasps = [index for index in shown if _gripped(courses[index])]
    few = 0 < len(grasps) < FEW_JAWS
    kept = _fastest(courses, "pressure") | set(grasps if few else [])
    first = _first_inflated(courses)
    after = [index for index in shown if index > first]
    later = [index for index in after if index not in kept] or after
    columns, inner = _inner(courses, later)
    # One grasp at most: the constants of the jaws are known from the others alone. Of
    # three it must be one, or no sweep judges the jaws.
    spare = [i for i in inner if i in grasps] or [i for i in later if i in grasps]
    spared = set(spare[-1:])
    rest = [index for index in inner if index not in grasps]
    wanted = max(1, round(SHARE * len(shown)) - len(spared))
    spared |= _chosen(courses, rest, wanted)
    # No other takes its place: what is next to it in kind would go with it.
    alone = _fastest(courses, "contraction")
    alone |= _only([index for index in jaws if _travelled(courses[index])])
    spared -= alone
    if not spared:
        others = [index for index in inner if index not in alone]
        spared.update(_spread(others or inner, 1))
    if len(jaws) >= FEW_JAWS and not spared & set(jaws):
        free = [index for index in jaws if index not in alone | kept]
        # Beside few grasps one must stay that tells how free jaws go.
        spared.update(free[-1:] if len(free) > 1 or not few else [])
    for index in sorted(spared, reverse=True):
        left = [shown[place] for place in shown.keys() - spared]
        if not shown[index] <= set[Signal]().union(*left):
            spared.remove(index)
    return spared - _left_alone(courses, spared & set(inner), columns)


def _inner(
    courses: Sequence[Course], later: Sequence[int]
) -> tuple[Sequence[str], list[int]]:
    """Sweeps that others reach as far as, holds apart, and in which inputs they do."""
    top = {name: _highest(courses, name) for name in (*COMMANDED, "contraction")}
    moved = [index for index in later if not _still(courses[index], top)]
    for columns in (CONDITIONS, PLACES):
        inside = within(courses, columns)
        if inner := [index for index in moved if index in inside]:
            return columns, inner
    return (), moved or list(later)


def _chosen(courses: Sequence[Course], rest: Sequence[int], wanted: int) -> set[int]:
    """So many sweeps, of those that travel and of those that rest in proportion."""
    top = _highest(courses, "contraction")
    resting = [index for index in rest if _stays(courses[index], top)]
    moving = [index for index in rest if index not in resting]
    of_moving = round(wanted * len(moving) / max(len(rest), 1))
    return {*_spread(moving, of_moving), *_spread(resting, wanted - of_moving)}


def _left_alone(
    courses: Sequence[Course], spared: set[int], columns: Sequence[str]
) -> set[int]:
    """Sweeps that were reached as far as by none but others that are spared as well."""
    alone: set[int] = set()
    for index in sorted(spared, reverse=True):
        rest = [i for i in range(len(courses)) if i == index or i not in spared - alone]
        reached = within([courses[place] for place in rest], columns)
        if rest.index(index) not in reached:
            alone.add(index)
    return alone


def _shown(problem: Problem) -> dict[int, set[Signal]]:
    """Signals that each sweep shows, of those that show any, in their order."""
    shown: dict[int, set[Signal]] = {}
    for block in problem.blocks:
        shown.setdefault(block.course, set()).add(block.signal)
    return dict(sorted(shown.items()))


def _first_inflated(courses: Sequence[Course]) -> int:
    """Place of the first sweep with air in the muscle; 0 where no pressure tells."""
    least = VENTED * _highest(courses, "pressure")
    tops = (np.nanmax(one.level("pressure"), initial=0.0) for one in courses)
    return next((place for place, top in enumerate(tops) if top > least), 0)


def _spread(places: Sequence[int], count: int) -> list[int]:
    """So many of a row, evenly, and not its ends."""
    if not places:
        return []
    chosen = np.linspace(0, len(places) - 1, count + 2)[1:-1]
    return [places[round(place)] for place in chosen.tolist()]


def _only(places: Sequence[int]) -> set[int]:
    return set(places) if len(places) == 1 else set()


def _opens(course: Course) -> bool:
    return bool(np.isfinite(course.column("opening")).any())


def _gripped(course: Course) -> bool:
    """Whether jaws press on something."""
    grip = course.column("grip")
    return bool(np.nanmax(grip, initial=0.0) > course.hush("grip") * PRESSED)


def _travelled(course: Course) -> bool:
    return bool(np.ptp(course.direction) == 2)


def _still(course: Course, top: Mapping[str, float]) -> bool:
    """Whether hardly anything moves: a hold is what drift and leaks are known from.

    Most of its samples lie within a small part of what it went through to get there,
    be it at another length. The pressure of a valve that is shut may sink, at a command
    that stays.
    """
    return _stays(course, top["contraction"]) and any(
        _rests(course.level(name), HELD * top[name]) for name in COMMANDED
    )


def _stays(course: Course, highest: float) -> bool:
    """Whether the muscle keeps to a length, be it one that it goes to first."""
    rests = _rests(course.level("contraction"), HELD * highest)
    return rests or not _travelled(course)


def _highest(courses: Sequence[Course], name: str) -> float:
    return max(float(np.nanmax(one.level(name), initial=0.0)) for one in courses)


def _rests(level: Array, most: float) -> bool:
    if not np.isfinite(level).any():
        return False
    low, high = np.nanquantile(level, (0.2, 0.9))
    return bool(high - low <= most)


def within(courses: Sequence[Course], columns: Sequence[str] = CONDITIONS) -> list[int]:
    """Places of the sweeps that others reach as far as, in some inputs.

    What the jaws do grows with the grip, so that it is one.
    """
    covered = np.ones(len(courses), dtype=bool)
    for name in columns:
        levels = [course.level(name) for course in courses]
        known = np.flatnonzero([np.isfinite(level).any() for level in levels])
        low = np.array([np.nanmin(levels[place]) for place in known])
        high = np.array([np.nanmax(levels[place]) for place in known])
        least, most = -_others_most(-low), _others_most(high)
        margin = MARGIN * (most - least)
        covered[known] &= (low >= least - margin) & (high <= most + margin)
    return np.flatnonzero(covered).tolist()


def _fastest(courses: Sequence[Course], name: str) -> set[int]:
    """Give the sweep in which an input is faster than in all others by far, if any."""
    pace = np.array([_pace(course, name) for course in courses])
    others = _others_most(pace)
    alone = (pace > FASTER * others) & (others > 0)
    return set(np.flatnonzero(alone).tolist())


def _pace(course: Course, name: str) -> float:
    """How fast an input is where it is fast; 0 where it does not go. [per s]."""
    rests = name == "contraction" and not _travelled(course)
    return 0.0 if rests else float(np.nanquantile(np.abs(course.rate(name)), QUICKLY))


def _others_most(values: Array) -> Array:
    """Largest of all others, for each of some values; -inf where there are none."""
    if values.size < 2:
        return np.full_like(values, -np.inf)
    second, first = np.sort(values)[-2:]
    others: Array = np.where(values < first, first, second)
    return others
