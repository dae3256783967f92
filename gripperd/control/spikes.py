"""A sensor with wild samples: one that leaps away is doubted, many make it bad."""

from collections import deque
from math import copysign

LEAST = 0.05
"""Share of its span that a sensor must leap by; less is left to the median. [-]"""
CERTAIN = 10.0
"""And so many sigma of its noise, which no two good samples differ by. [-]"""
SLOWEST = 0.05
"""Samples farther apart than this may differ by anything. [s]"""
LONGEST = 2
"""So many samples without a value are a spike; more are a failure of their own."""
MANY = 3
"""Spikes that make a sensor bad, and within what time. One in a while, from a contactor
that switches, is no fault. [-], [s]"""
WITHIN = 1.0


class Spikes:
    """Finds the samples that leave what came before, until the next one confirms them.

    Parameters
    ----------
    span
        Of the sensor, in its unit.
    """

    def __init__(self, span: float) -> None:
        self.many = False
        """Whether there are so many that the sensor cannot be believed; over after a
        time without any."""
        self._least = LEAST * abs(span)
        self._believed: float | None = None
        self._side = 0.0
        self._doubted = False
        self._gap = 0
        self._since: deque[float] = deque(maxlen=MANY)

    def update(self, value: float | None, sigma: float, dt: float) -> bool:
        """Take in a sample; True while it stands alone, and should not be used.

        One that goes on in the direction of the sample before is a motion, and stands
        alone no more.

        Parameters
        ----------
        value
            As it came from the module, None where it had none.
        sigma
            Noise of the sensor, in its unit.
        dt
            Time since the last sample. [s]
        """
        self._grow_old(dt)
        if value is None:
            self._gap += 1
            return False
        gap, self._gap = self._gap, 0
        if self._believed is None or gap > LONGEST or dt > SLOWEST:
            self._believed, self._side, self._doubted = value, 0.0, False
            return False
        change = value - self._believed
        away = abs(change) > max(self._least, CERTAIN * sigma)
        side, before = copysign(1.0, change) if away else 0.0, self._side
        if gap or (self._doubted and side != before):
            self._count()
        self._side, self._doubted = side, away and side != before
        if not self._doubted:
            self._believed = value
        return self._doubted

    def _count(self) -> None:
        self._since.append(0.0)
        self.many = self.many or len(self._since) == MANY

    def _grow_old(self, dt: float) -> None:
        self._since = deque(
            (age + dt for age in self._since if age + dt <= WITHIN), maxlen=MANY
        )
        self.many = self.many and bool(self._since)
