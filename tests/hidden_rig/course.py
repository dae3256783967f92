"""What the rig was told and what surrounded it, 100 times a second."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tests.hidden_rig.compiled import compiled

Array = NDArray[np.float64]

STEP = 0.01
"""Of the integration. [s]"""


class Course(NamedTuple):
    """One value a step; the runs stand one after the other."""

    clock: Array
    """Since the start of the recording, rests included. [s]"""
    starts: NDArray[np.bool_]
    """The first step of each run."""
    run: NDArray[np.int64]
    """Number of the run, in the order of the recording."""
    current: Array
    """Commanded. [mA]"""
    contraction: Array
    """Imposed by the rig; NaN where the gripper finds its own."""
    object_size: Array
    """Of what stands between the jaws; NaN for nothing. [m]"""
    object_stiffness: Array
    """[N/m]"""
    temperature: Array
    """[degree Celsius]"""
    supply: Array
    """Gauge pressure before the regulator. [Pa]"""
    ambient: Array
    """Absolute. [Pa]"""


class Response(NamedTuple):
    """What truly happened, one value a step."""

    pressure: Array
    contraction: Array
    force: Array
    opening: Array
    grip: Array


class Point(NamedTuple):
    """One instant of a muscle."""

    pressure: float
    contraction: float
    rate: float
    temperature: float
    supply: float
    clock: float
    run: int


@compiled
def shortened(here: Point, contraction: float) -> Point:
    """The same instant of a muscle that has contracted further."""
    return Point(
        here.pressure,
        here.contraction + contraction,
        here.rate,
        here.temperature,
        here.supply,
        here.clock,
        here.run,
    )


# Where each memory of the muscle stands in the row of memories.
LENGTH, PRESSURE, FORCE, DRY, SLIDING, LINKAGE, PLAY = range(7)
IN_LENGTH, IN_PRESSURE, INFLATIONS, WARM, STRAINS = range(7, 12)
RELAYS_IN_LENGTH = 16
RELAYS = 240
RELAYS_IN_PRESSURE = RELAYS_IN_LENGTH + RELAYS
MEMORIES = RELAYS_IN_PRESSURE + RELAYS
