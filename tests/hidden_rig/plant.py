"""The march through time, the same for both families of laws."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from tests.hidden_rig import plant_a, plant_b, valve_a, valve_b
from tests.hidden_rig.compiled import compiled
from tests.hidden_rig.course import (
    INFLATIONS,
    LENGTH,
    LINKAGE,
    MEMORIES,
    PLAY,
    PRESSURE,
    STEP,
    WARM,
    Array,
    Course,
    Point,
    Response,
)
from tests.hidden_rig.hidden import Hidden
from tests.hidden_rig.outside import magnet
from tests.hidden_rig.rig import Rig


class Laws(NamedTuple):
    """What a family of laws must say."""

    valve: Callable[[Rig, Hidden, Course], Array]
    pull: Callable[[Rig, Hidden, Array, Array, Point], float]
    jaws: Callable[[Rig, Hidden, Array, Array, float], float]
    bending: Callable[[Hidden, float], float]


class World(NamedTuple):
    """All that stays the same during the march."""

    laws: Laws
    rig: Rig
    hidden: Hidden
    course: Course


LAWS = {
    "A": Laws(valve_a.valve, plant_a.pull, plant_a.jaws, plant_a.bending),
    "B": Laws(valve_b.valve, plant_b.pull, plant_b.jaws, plant_b.bending),
}

DAMPING = 5.0
"""Of the jaws: what keeps their equilibrium from being a jump. [N s]"""


@compiled
def march(world: World) -> Response:
    """Step through the whole recording."""
    laws, rig, hidden, course = world
    pressure = laws.valve(rig, hidden, course)
    contraction = course.contraction.copy()
    force = np.zeros(pressure.size)
    opening = np.zeros(pressure.size)
    grip = np.zeros(pressure.size)
    old, new = np.zeros(MEMORIES), np.zeros(MEMORIES)
    before = 0.0
    for i in range(pressure.size):
        free = np.isnan(contraction[i])
        if course.starts[i]:
            before = 0.0 if free else contraction[i]
            _rest(old, before, pressure[i])
        here = _point(course, i, pressure[i], before)
        if free:
            contraction[i] = _settled(world, i, here, old, new)
        before = contraction[i]
        force[i] = laws.pull(rig, hidden, old, new, _moved(here, before))
        width = laws.jaws(rig, hidden, old, new, before)
        grip[i] = _squeeze(course, i, width)
        opening[i] = width + laws.bending(hidden, grip[i])
        old, new = new, old
    return Response(pressure, contraction, force, opening, grip)


@compiled
def _rest(row: Array, contraction: float, pressure: float) -> None:
    """Forget all but wear and the relay in temperature."""
    worn, warm = row[INFLATIONS], row[WARM]
    row[:] = 0.0
    row[INFLATIONS], row[WARM] = worn, warm
    row[LENGTH] = row[PLAY] = contraction
    row[PRESSURE] = pressure


@compiled
def _point(course: Course, i: int, pressure: float, contraction: float) -> Point:
    return Point(
        pressure,
        contraction,
        0.0,
        course.temperature[i],
        course.supply[i],
        course.clock[i],
        course.run[i],
    )


@compiled
def _moved(here: Point, contraction: float) -> Point:
    return Point(
        here.pressure,
        contraction,
        (contraction - here.contraction) / STEP,
        here.temperature,
        here.supply,
        here.clock,
        here.run,
    )


@compiled
def _squeeze(course: Course, i: int, opening: float) -> float:
    """Force of the object on each jaw. [N]."""
    overlap: float = course.object_size[i] - opening
    return course.object_stiffness[i] * overlap if overlap > 0 else 0.0


@compiled
def _settled(world: World, i: int, here: Point, old: Array, new: Array) -> float:
    """Contraction that the free jaws reach, by bisection; the open stop is at 0."""
    before = here.contraction
    low, high = max(before - 0.02, 0.0), before + 0.02
    if _excess(world, i, _moved(here, low), old, new) <= 0:
        return low
    while high - low > 1e-8:
        middle = 0.5 * (low + high)
        if _excess(world, i, _moved(here, middle), old, new) > 0:
            low = middle
        else:
            high = middle
    return low


@compiled
def _excess(world: World, i: int, here: Point, old: Array, new: Array) -> float:
    """Force left over to move the jaws inwards. [N]."""
    laws, rig, hidden, course = world
    force = laws.pull(rig, hidden, old, new, here)
    opening = laws.jaws(rig, hidden, old, new, here.contraction)
    grip = _squeeze(course, i, opening) - magnet(hidden, opening)
    spring = rig.preload + rig.spring_rate * rig.rest_length * here.contraction
    passed = force * (1 - hidden.linkage_friction * new[LINKAGE])
    left: float = passed - spring - rig.ratio * grip - DAMPING * here.rate
    return left
