"""The inner loop: the measured pressure follows the wanted one."""

from gripperd.control.pi import PI
from gripperd.control.tuning import CHAMBER_LAG, REGULATOR_LAG, simc

CLOSED = 0.15
"""Time constant of the closed loop: twice the open loop's, since an E/P regulator has a
fast loop of its own and this one only removes what that leaves. [s]"""
DEAD = 1e3
"""Pressure error that is left alone: 3 sigma of the shipped sensor, and well inside the
0.5 % of the span to which E/P regulators repeat. It keeps the valve quiet. [Pa]"""


class PressureLoop:
    """Corrects the pressure that is asked of the regulator.

    The wanted pressure goes to the regulator by itself (feed-forward). What is
    measured is held against what it should be by then, so a valve that does what the
    model says is not corrected at all.

    Parameters
    ----------
    period
        Of the control loop. [s]
    """

    def __init__(self, period: float) -> None:
        self._pi = PI(
            simc(
                slow=REGULATOR_LAG, fast=CHAMBER_LAG, delay=1.5 * period, closed=CLOSED
            )
        )
        self._lag = REGULATOR_LAG + CHAMBER_LAG / 2
        self._expected = self._offset = 0.0

    def begin(self, wanted: float, measured: float) -> None:
        """Start from what is; an error that is there already is accepted. [Pa]."""
        self._offset = measured - wanted
        self._expected = wanted
        self._pi.begin(0.0)

    def follow(self, wanted: float, dt: float) -> None:
        """Let the pressure that is to be expected follow the wanted one. [Pa, s]."""
        self._expected += (wanted - self._expected) * dt / (dt + self._lag)

    def step(self, measured: float, dt: float, low: float, high: float) -> float:
        """Correction after a period. [Pa].

        Parameters
        ----------
        measured
            Gauge pressure. [Pa]
        dt
            Time since the last step. [s]
        low, high
            Bounds of the correction. [Pa]
        """
        error = self._expected + self._offset - measured
        beyond = max(error - DEAD, 0.0) + min(error + DEAD, 0.0)
        return self._pi.step(beyond, dt, low, high)
