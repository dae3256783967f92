"""A bank of relays: hysteresis after Preisach."""

from tests.hidden_rig.compiled import compiled
from tests.hidden_rig.course import (
    RELAYS,
    RELAYS_IN_LENGTH,
    RELAYS_IN_PRESSURE,
    Array,
    Point,
)
from tests.hidden_rig.hidden import Hidden


@compiled
def _relays(old: Array, new: Array, first: int, share: float, fresh: bool) -> float:
    """How far the relays stay behind the curve they would follow without a loop."""
    total = 0.0
    for k in range(RELAYS):
        # Golden section: centres and widths fill their plane evenly.
        centre = -0.1 + 1.2 * (k + 0.5) / RELAYS
        width = 0.01 + 0.07 * ((k * 0.6180339887) % 1.0)
        state = old[first + k]
        if share > centre + width or (fresh and share > centre):
            state = 1.0
        elif share < centre - width or fresh:
            state = -1.0
        new[first + k] = state
        total += min(max((share - centre) / width, -1.0), 1.0) - state
    # Density of relays per share, times twice the mean width, is half a loop.
    return total / (RELAYS / 1.2 * 0.09)


@compiled
def hysteresis(hidden: Hidden, old: Array, new: Array, here: Point) -> float:
    """Memory of turning points, of contraction and of pressure."""
    force = 0.0
    if hidden.presliding_hysteresis > 0:
        first = RELAYS_IN_LENGTH
        share, fresh = here.contraction / 0.22, old[first] == 0.0
        force += hidden.presliding_hysteresis * _relays(old, new, first, share, fresh)
    if hidden.pressure_hysteresis > 0:
        first = RELAYS_IN_PRESSURE
        share, fresh = here.pressure / 450e3, old[first] == 0.0
        force += hidden.pressure_hysteresis * _relays(old, new, first, share, fresh)
    return force
