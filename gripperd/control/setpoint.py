"""The valve current that is asked for: a ramp, and the way back when it must stop."""

from collections import deque

from gripperd.errors import DomainError
from gripperd.model import Chain, Regulator
from gripperd.signals import Measurement

LAG = 0.12
"""The pressure is behind the current by less: regulator and muscle take 60 to 110 ms to
63 % of a step (measured on a 10 mm muscle). [s]"""
LONGEST_STEP = 0.1
"""A ramp does not make up for a stall of the loop in one step, and a dwell does not
count it: the current was written after it. [s]"""


def within(regulator: Regulator, current: float) -> float:
    """Nearest current that the valve can follow. [A]."""
    return min(max(current, regulator.current_low), regulator.current_high)


class Ramp:
    """A current on its way, and where it was a moment ago."""

    def __init__(self, current: float) -> None:
        self.current = current
        """Valve current asked for. [A]"""
        self._past: deque[tuple[float, float]] = deque()

    def tick(self, dt: float) -> None:
        """Let time pass; once in each period, before the current is changed."""
        self._past.append((dt, self.current))
        while sum(spent for spent, _ in self._past) - self._past[0][0] > LAG:
            self._past.popleft()

    def towards(self, goal: float, rate: float, dt: float) -> bool:
        """Go a step closer to a goal; True once it is reached exactly.

        >>> ramp = Ramp(0.0043)
        >>> ramp.towards(0.004, 0.02, 0.01), ramp.current
        (False, 0.0041)
        >>> ramp.towards(0.004, 0.02, 0.01), ramp.current
        (True, 0.004)
        """
        gap, step = goal - self.current, rate * min(dt, LONGEST_STEP)
        if abs(gap) <= step:
            self.current = goal
        else:
            self.current += step if gap > 0 else -step
        return self.current == goal

    def rest(self, reached: float | None) -> None:
        """Go back to what the pressure has reached by now, so that the jaws rest.

        Parameters
        ----------
        reached
            Current that the model has for the measured pressure, None without one.
            It is believed as far as the ramp has been there lately: a valve that is
            off must not turn the stop into a jump. [A]
        """
        lately = [current for _, current in self._past] or [self.current]
        low = min(*lately, self.current)
        high = max(*lately, self.current)
        if reached is None:
            reached = lately[len(lately) // 2]
        self.current = min(max(reached, low), high)


def reached(measured: Measurement, chain: Chain) -> float | None:
    """Current that the model has for the measured pressure, if there is one. [A]."""
    pressure = measured.pressure.value
    if pressure is None:
        return None
    try:
        return float(chain.outlet.current(pressure))
    except DomainError:
        # Noise carries the pressure of a spent supply past what the valve can give.
        return None
