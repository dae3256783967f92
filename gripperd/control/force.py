"""Grip force as far as it can be known: measured, else computed, and its filter."""

from dataclasses import replace

from gripperd.errors import DomainError
from gripperd.model import Chain
from gripperd.signals import Measurement, Quality, Reading

CONTACT_FORCE = 0.4
"""Measured force that counts as contact: 8 sigma of the bench's sensor. [N]"""
CONTACT_FORCE_SUBSTITUTED = 3.0
"""The same where the model stands in for the sensor; it knows friction to that. [N]"""
FROZEN_FOR = 0.2
"""A sensor that says the same for so long may be stuck. [s]"""
DOUBT = 10.0
"""And is, when the model differs by more: 4 sigma of the shipped reference. [N]"""
TIME_CONSTANT = 0.1
"""Of the filter; far above the loop's period, far below a grasp. [s]"""


def grip_force(measured: Measurement, chain: Chain) -> Reading:
    """Grip force per jaw: measured, or computed from pressure and opening. [N]."""
    if measured.grip.value is not None:
        return measured.grip
    pressure, opening = measured.pressure.value, measured.opening.value
    if pressure is None or opening is None:
        return measured.grip
    length = chain.muscle.rest_length
    contraction = float(chain.linkage.contraction(opening, length))
    try:
        tension = chain.static.tension(pressure, contraction)
    except DomainError as error:
        return Reading.bad(str(error))
    force = float(chain.linkage.grip_force(tension, contraction, length))
    return Reading(max(force, 0.0), Quality.SUBSTITUTED, measured.grip.cause)


class ForceSense:
    """Follows the grip force through a grasp."""

    def __init__(self, chain: Chain) -> None:
        self.now = Reading.bad("not measured yet")
        self.filtered: float | None = None
        """None while there is no force to believe. [N]"""
        self._chain = chain
        self._touches = 0
        self._last: float | None = None
        self._frozen = 0.0

    def update(self, measured: Measurement, dt: float) -> None:
        """Take in the newest measurement."""
        self.now = grip_force(self._doubted(measured, dt), self._chain)
        force = self.now.value
        if force is None:
            self.filtered, self._touches = None, 0
            return
        if self.filtered is None:
            self.filtered = force
        self.filtered += (force - self.filtered) * min(dt / TIME_CONSTANT, 1.0)
        self._touches = self._touches + 1 if force > self._threshold() else 0

    @property
    def touching(self) -> bool:
        """Whether the jaws press on something.

        Two samples in a row, so that a single spike is not taken for an object.
        """
        return self._touches >= 2

    @property
    def measured(self) -> bool:
        """Whether the force comes from a sensor."""
        return self.now.quality is Quality.GOOD

    def _doubted(self, measured: Measurement, dt: float) -> Measurement:
        """The measurement without the force sensor, if that is stuck.

        A sensor that repeats itself to the last digit may be at rest; if the model
        says that the jaws press all the same, it is not believed.
        """
        force, self._last = self._last, measured.grip.value
        self._frozen = self._frozen + dt if force == self._last else 0.0
        if force is None or self._frozen < FROZEN_FOR:
            return measured
        stuck = Reading.bad(f"stuck at {force:.2f} N for {self._frozen:.1f} s")
        blind = replace(measured, grip=stuck)
        modelled = grip_force(blind, self._chain).value
        doubtful = modelled is not None and abs(modelled - force) > DOUBT
        return blind if doubtful else measured

    def _threshold(self) -> float:
        return CONTACT_FORCE if self.measured else CONTACT_FORCE_SUBSTITUTED
