"""The outer loop: the measured grip force comes to the wanted one, by pressure."""

from gripperd.control.pi import PI
from gripperd.control.pressure_loop import CLOSED as INNER
from gripperd.control.tuning import CHAMBER_LAG, REGULATOR_LAG, simc

QUICK = 4 * INNER
"""Time constant of the closed loop while the force is being changed: four times the
inner one's, so that they do not fight. [s]"""
SLOW = 5.0
"""The same while an object is only kept: creep takes seconds to minutes, and a slip
must not be hidden by pressing harder. The correction moves by no more than its bound in
this time. [s]"""
MEDIAN_DELAY = 1
"""By how many periods the median of three samples is late."""
DEAD_SHARE, DEAD_LEAST = 0.015, 0.1
"""Force error that is left alone, a share of the wanted force and at least this: half
of what a grasp accepts, so that dry friction starts no hunting. [-], [N]"""
STILL_FOR = 0.2
"""A force that repeats itself to the last digit for so long tells nothing. [s]"""


class ForceLoop:
    """Corrects the pressure until the force is as wanted.

    Parameters
    ----------
    period
        Of the control loop. [s]
    closed
        Time constant of the closed loop: :data:`QUICK` or :data:`SLOW`. [s]
    """

    def __init__(self, period: float, closed: float) -> None:
        delay = (1.5 + MEDIAN_DELAY) * period
        self._pi = PI(
            simc(slow=REGULATOR_LAG, fast=CHAMBER_LAG, delay=delay, closed=closed)
        )
        self._last: float | None = None
        self._still = 0.0

    @property
    def correction(self) -> float:
        """The correction as it is. [Pa]."""
        return self._pi.output

    def begin(self) -> None:
        """Start without a correction."""
        self._pi.begin(0.0)
        self._last, self._still = None, 0.0

    def step(
        self, error: float, measured: float, dt: float, low: float, high: float
    ) -> float:
        """Correction after a period. [Pa].

        Parameters
        ----------
        error
            Pressure that is lacking at the object, by the model. [Pa]
        measured
            The force that tells so, per jaw. [N]
        dt
            Time since the last step. [s]
        low, high
            Bounds of the correction. [Pa]
        """
        self._still = self._still + dt if measured == self._last else 0.0
        self._last = measured
        if self._still > STILL_FOR:
            return self._pi.hold(error, low, high)
        return self._pi.step(error, dt, low, high)


def lacking(wanted: float, measured: float) -> float:
    """Force error without what is left alone. [N].

    >>> lacking(10.0, 9.9), lacking(10.0, 9.0), lacking(100.0, 103.0)
    (0.0, 0.85, -1.5)
    """
    error, dead = wanted - measured, max(DEAD_SHARE * wanted, DEAD_LEAST)
    return max(error - dead, 0.0) + min(error + dead, 0.0)
