"""Family A: the regulator and the air behind it."""

import math

import numpy as np

from tests.hidden_rig.compiled import compiled
from tests.hidden_rig.course import STEP, Array, Course
from tests.hidden_rig.hidden import Hidden
from tests.hidden_rig.rig import Rig


@compiled
def valve(rig: Rig, hidden: Hidden, course: Course) -> Array:
    """Gauge pressure in the muscle. [Pa]."""
    out = np.zeros(course.clock.size)
    dead_time = int(0.3 * hidden.valve_lag / STEP)
    begun, held, first, level, sag, still = 0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(out.size):
        if course.starts[i]:
            begun, still, sag = i, 0.0, 0.0
        seen = course.current[max(i - dead_time, begun)]
        goal = _curve(rig, hidden, (seen - 4.0) / 16.0, course.supply[i])
        goal += hidden.limit_cycle * _chatter(course.clock[i], goal)
        held = min(
            max(held, goal - hidden.valve_dead_band), goal + hidden.valve_dead_band
        )
        if course.starts[i]:
            first = level = held
        # Two equal lags in a row, beside the ordinary one of 10 ms.
        share = 1 - math.exp(-STEP / (0.005 + 0.5 * hidden.valve_lag))
        first += share * (held - first)
        level += share * (first - level)
        moves = abs(course.current[i] - course.current[max(i - 1, begun)]) > 1e-6
        still = 0.0 if moves else still + STEP
        # A regulator that was told to move stays awake for a second, then shuts.
        if still > 1.0:
            sag += STEP * hidden.leak * max(level - sag, 0.0)
        else:
            sag *= math.exp(-STEP / 0.3)
        out[i] = max(level - sag, 0.0)
    return out


@compiled
def _curve(rig: Rig, hidden: Hidden, share: float, supply: float) -> float:
    straight = rig.pressure_span * (1 + hidden.valve_gain) * share
    goal = straight + hidden.valve_offset
    goal += hidden.valve_nonlinearity * math.sin(math.pi * share)
    # Smooth minimum: the poppet starves gradually.
    top, width = supply - 15e3, 6e3
    return goal - width * math.log1p(math.exp((goal - top) / width))


@compiled
def _chatter(clock: float, goal: float) -> float:
    return math.sin(2 * math.pi * 1.7 * clock) if 150e3 < goal < 320e3 else 0.0
