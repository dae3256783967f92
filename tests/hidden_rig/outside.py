"""Effects that no library holds: forces with a shape of their own."""

import math

from tests.hidden_rig.compiled import compiled
from tests.hidden_rig.course import DRY, WARM, Array, Point
from tests.hidden_rig.hidden import Hidden


@compiled
def outside_force(hidden: Hidden, old: Array, new: Array, here: Point) -> float:
    """Sum of those forces that a muscle feels. [N]."""
    h, p, t = here.contraction, here.pressure, here.clock
    # A relay in temperature, smoothed over half a kelvin.
    goal = math.tanh((here.temperature - 24.0 - 1.5 * old[WARM]) / 0.5)
    new[WARM] = old[WARM] + 0.002 * (goal - old[WARM])
    loaded = min(max(p, 0.0) / 300e3, 1.0)
    snapped = 1 / (1 + math.exp(-(h - 0.093) / 8e-4))
    force: float = (
        hidden.ripple_in_length * math.sin(2 * math.pi * h / 0.031) * loaded
        + hidden.ripple_in_pressure * math.sin(2 * math.pi * p / 61e3)
        + hidden.local_bump
        * math.exp(-(((h - 0.11) / 0.03) ** 2) - ((p - 260e3) / 60e3) ** 2)
        + hidden.supply_ripple * (here.supply - 620e3) / 20e3 * loaded
        + hidden.resonance * math.sin(2 * math.pi * 2.3 * t) * loaded
        - hidden.side_load_friction * (h / 0.2) ** 2 * new[DRY]
        + hidden.thermal_hysteresis * new[WARM] * loaded
        + hidden.humidity * math.sin(2 * math.pi * t / 310.0) * loaded
        - hidden.braid_snap * snapped * math.exp(-(h - 0.093) / 0.05) * loaded
    )
    return force


@compiled
def magnet(hidden: Hidden, opening: float) -> float:
    """Pull between the jaws, which grows as they close. [N]."""
    return hidden.jaw_magnet * math.exp(-opening / 0.02)
