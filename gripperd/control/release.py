"""Opening the jaws: the current ramps down to the live zero and the jaws let go."""

from gripperd.control.force import ForceSense
from gripperd.control.setpoint import LONGEST_STEP, Ramp, reached
from gripperd.model import Chain
from gripperd.signals import Measurement

RATE = 20e-3
"""Of the valve current, 0.8 s over the whole span. [A/s]"""
SETTLE = 1.0
"""Longest time for the jaws to let go once the current is down. [s]"""
SLACK_PRESSURE = 10e3
"""Gauge pressure under which the muscle holds nothing. [Pa]"""


class Release:
    """A release from its first step to its end.

    Parameters
    ----------
    chain
        The model of the gripper.
    current
        Valve current at the start. [A]
    rate
        Of the valve current; without bound the air is let out at once. [A/s]
    """

    def __init__(self, chain: Chain, current: float, rate: float = RATE) -> None:
        self.ramp = Ramp(current)
        self._rate = rate
        self._chain = chain
        self._force = ForceSense()
        self._dwell = 0.0

    def step(self, measured: Measurement, dt: float) -> bool | None:
        """Advance by one period; True once released, False when the jaws do not open.

        With neither pressure nor force to go by, the time that it takes is believed.
        """
        self._force.update(measured, dt)
        self.ramp.tick(dt)
        if not self.ramp.towards(self._chain.regulator.current_low, self._rate, dt):
            return None
        self._dwell += min(dt, LONGEST_STEP)
        pressure, force = measured.pressure.value, self._force.now.value
        if pressure is None and force is None:
            return True if self._dwell > SETTLE else None
        vented = pressure is None or pressure < SLACK_PRESSURE
        if vented and not self._force.touching:
            return True
        return False if self._dwell > SETTLE else None

    def rest(self, measured: Measurement) -> None:
        """Let the jaws rest where they are."""
        self.ramp.rest(reached(measured, self._chain))
