"""The valve current that is asked for: a ramp that ends exactly at its goal."""

from gripperd.model import Chain, Regulator
from gripperd.signals import Measurement


def within(regulator: Regulator, current: float) -> float:
    """Nearest current that the valve can follow. [A]."""
    return min(max(current, regulator.current_low), regulator.current_high)


def ramped(current: float, goal: float, step: float) -> float:
    """Current one step closer to a goal, or the goal itself. [A].

    >>> ramped(0.010, 0.004, 0.001)
    0.009
    >>> ramped(0.0043, 0.004, 0.001)
    0.004
    """
    gap = goal - current
    if abs(gap) <= step:
        return goal
    return current + step if gap > 0 else current - step


def at_rest(measured: Measurement, chain: Chain, current: float) -> float:
    """Current at which the pressure stays where it is now. [A].

    The pressure lags behind a ramp, so keeping the current would let the jaws travel
    on. Without a pressure reading there is nothing better than to keep it.
    """
    if measured.pressure.value is None:
        return current
    held = float(chain.regulator.current(measured.pressure.value))
    return within(chain.regulator, held)
