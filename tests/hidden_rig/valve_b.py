"""Family B: the regulator and the air behind it."""

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
    begun, aim, level, lost, still = 0, 0.0, 0.0, 0.0, 0.0
    for i in range(out.size):
        if course.starts[i]:
            begun, still, lost = i, 0.0, 0.0
        goal = _curve(rig, hidden, (course.current[i] - 4.0) / 16.0)
        goal = _starved(goal, course.supply[i] - 15e3)
        goal += hidden.limit_cycle * _chatter(course.clock[i], goal)
        aim = _reluctant(aim, goal, hidden.valve_dead_band)
        if course.starts[i]:
            level = aim = goal
        # Filling is slower the nearer the supply, venting the nearer empty.
        lag = 0.01
        if hidden.valve_lag > 0:
            filling = 0.7 if aim > level else 1.3
            lag += hidden.valve_lag * filling * (0.7 + level / 700e3)
        level += (aim - level) * -math.expm1(-STEP / lag)
        moves = abs(course.current[i] - course.current[max(i - 1, begun)]) > 1e-6
        still = 0.0 if moves else still + STEP
        # Orifice: flow as the root of the pressure; refilled while the piston is awake.
        if still > 0.6:
            lost += STEP * hidden.leak * math.sqrt(250e3 * max(level - lost, 0.0))
        else:
            lost -= lost * STEP / 0.15
        out[i] = max(level - lost, 0.0)
    return out


@compiled
def _curve(rig: Rig, hidden: Hidden, share: float) -> float:
    straight = rig.pressure_span * (1 + hidden.valve_gain) * share
    bow = 6.0 * share * (1 - share) * (0.35 + share) * hidden.valve_nonlinearity
    # Asked for nothing, it vents.
    awake = -math.expm1(-max(share, 0.0) / 0.02)
    return straight + hidden.valve_offset * awake + 0.8 * bow


@compiled
def _starved(goal: float, top: float) -> float:
    """From 90 % of the top, each further pascal yields less."""
    knee = 0.9 * top
    if goal < knee:
        return goal
    return knee + (top - knee) * math.tanh((goal - knee) / (top - knee))


@compiled
def _reluctant(aim: float, goal: float, band: float) -> float:
    """A servo that wakes outside its band and goes back to sleep inside 60 % of it."""
    error = goal - aim
    if abs(error) <= band:
        return aim
    return aim + math.copysign(abs(error) - (0.6 * band), error)


@compiled
def _chatter(clock: float, goal: float) -> float:
    phase = (1.3 * clock) % 1.0
    return 4 * abs(phase - 0.5) - 1 if 120e3 < goal < 280e3 else 0.0
