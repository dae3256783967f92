"""The zero of the force sensor, taken while it is known to be unloaded."""

from dataclasses import replace
from statistics import fmean, stdev

from gripperd.control.command import Failure
from gripperd.control.ending import Ending
from gripperd.control.release import SLACK_PRESSURE
from gripperd.control.setpoint import Ramp
from gripperd.control.states import Grip
from gripperd.control.task import Tared
from gripperd.errors import Refused
from gripperd.model import Chain
from gripperd.signals import Measurement, Quality

SAMPLES = 50
"""That are averaged: a seventh of the noise of one is left."""
WITHIN = 2.0
"""Longest time for them to come. [s]"""
MOST = 5.0
"""A sensor that is off by more is not to be tared but to be looked after. [N]"""


def check_unloaded(measured: Measurement, chain: Chain, current: float) -> None:
    """Refuse to take a zero unless the jaws cannot press on anything.

    Raises
    ------
    Refused
        With what would have to be different.
    """
    pressure = measured.pressure.value
    slack = pressure is None or pressure < SLACK_PRESSURE
    if current <= chain.regulator.current_low and slack:
        return
    message = "the force sensor may be loaded: the muscle is not vented"
    raise Refused(message, code="wrong-state", hints=("release or vent first",))


def tared(raw: Measurement, zero: float) -> Measurement:
    """A sample with the zero of the force sensor taken off. [N]."""
    if not zero or raw.grip.value is None:
        return raw
    return replace(raw, grip=replace(raw.grip, value=raw.grip.value - zero))


class Zeroing:
    """From the first sample to the zero.

    Parameters
    ----------
    zero
        That is taken off already. [N]
    current
        Valve current, which stays. [A]
    """

    def __init__(self, zero: float, current: float) -> None:
        self.ramp = Ramp(current)
        self._zero = zero
        self._forces: list[float] = []
        self._elapsed = 0.0

    def step(self, measured: Measurement, dt: float) -> Ending | None:
        """Take in one sample."""
        self._elapsed += dt
        if measured.grip.quality is Quality.GOOD and measured.grip.value is not None:
            self._forces.append(measured.grip.value)
        if len(self._forces) >= SAMPLES:
            return self._ended()
        if self._elapsed <= WITHIN:
            return None
        return _failed("no_force", "the force sensor gives nothing to be tared")

    def rest(self, measured: Measurement) -> None:
        """Stay; nothing moves."""

    def _ended(self) -> Ending:
        zero = self._zero + fmean(self._forces)
        if abs(zero) > MOST:
            message = f"it shows {zero:.2f} N without a load, more than {MOST:g} N"
            return _failed("zero_too_large", message)
        found = Tared(zero=zero, noise=stdev(self._forces))
        return Ending(Grip.RELEASED, finding=found)


def _failed(code: str, message: str) -> Ending:
    failure = Failure(category="outcome", code=code, message=message)
    return Ending(Grip.UNKNOWN, failure=failure)
