"""Judges every sample once, before anything is decided on it.

A single spike is taken out, a gap of a sample or two is bridged, and a force sensor
that is broken or stuck is replaced by the model. What comes out is what clients see.
"""

from collections import deque
from dataclasses import replace
from statistics import median

from gripperd.errors import DomainError
from gripperd.model import Chain
from gripperd.signals import Measurement, Quality, Reading

WINDOW = 3
"""Samples whose median is taken: one lie among them does not count."""
BRIDGED = 2
"""Samples without a value that are bridged by the last one, 20 ms at 100 Hz."""
FROZEN_FOR = 0.2
"""A force sensor that says the same to the last digit for so long may be stuck. [s]"""
DOUBT = 10.0
"""And is, when the model differs by more: 4 sigma of the shipped reference. [N]"""


class Senses:
    """The sensors of one gripper, as far as they can be believed."""

    def __init__(self, chain: Chain) -> None:
        self._chain = chain
        # A stop needs the pressure of this moment: a median would be one sample late.
        self._pressure = _Channel(window=1)
        self._opening, self._grip = _Channel(WINDOW), _Channel(WINDOW)
        self._last: float | None = None
        self._frozen = 0.0

    def judge(self, raw: Measurement, dt: float) -> Measurement:
        """The sample as it may be used.

        Parameters
        ----------
        raw
            What the modules said.
        dt
            Time since the last sample. [s]
        """
        # The model needs pressure and opening of the same moment, so before the median.
        force = grip_force(self._doubted(raw, dt), self._chain)
        return replace(
            raw,
            pressure=self._pressure.judge(raw.pressure),
            opening=self._opening.judge(raw.opening),
            grip=self._grip.judge(force),
        )

    def _doubted(self, raw: Measurement, dt: float) -> Measurement:
        """The sample without the force sensor, if that is stuck.

        One that repeats itself may be at rest; if the model says that the jaws press
        all the same, it is stuck.
        """
        force, self._last = self._last, raw.grip.value
        same = force is not None and force == raw.grip.value
        self._frozen = self._frozen + dt if same else 0.0
        if force is None or self._frozen < FROZEN_FOR:
            return raw
        stuck = Reading.bad(f"stuck at {force:.2f} N for {self._frozen:.1f} s")
        blind = replace(raw, grip=stuck)
        modelled = grip_force(blind, self._chain).value
        doubtful = modelled is not None and abs(modelled - force) > DOUBT
        return blind if doubtful else raw


class _Channel:
    """One sensor over its last samples."""

    def __init__(self, window: int) -> None:
        self._values: deque[float] = deque(maxlen=window)
        self._gap = 0
        self._last = Reading.bad("not measured yet")

    def judge(self, reading: Reading) -> Reading:
        if reading.value is not None:
            self._gap = 0
            self._values.append(reading.value)
            self._last = reading
        else:
            self._gap += 1
            if not self._values or self._gap > BRIDGED:
                self._values.clear()
                return reading
        return replace(self._last, value=median(self._values))


def grip_force(measured: Measurement, chain: Chain) -> Reading:
    """Grip force per jaw: measured, or computed from pressure and opening. [N]."""
    if measured.grip.value is not None:
        return measured.grip
    pressure, opening = measured.pressure.value, measured.opening.value
    if pressure is None or opening is None:
        return measured.grip
    try:
        force = float(chain.grip_at(pressure, opening))
    except DomainError as error:
        return Reading.bad(str(error))
    return Reading(max(force, 0.0), Quality.SUBSTITUTED, measured.grip.cause)
