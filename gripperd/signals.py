"""What was measured, and how far it may be believed. SI values."""

from dataclasses import dataclass
from enum import StrEnum


class Quality(StrEnum):
    """How far a value may be believed."""

    GOOD = "good"
    STALE = "stale"
    """Older than it should be; the last value is not repeated as if it were new."""
    BAD = "bad"
    """The sensor or its line says so; there is no value."""
    ABSENT = "absent"
    """No such sensor is fitted."""
    SUBSTITUTED = "substituted"
    """Computed by the model in place of a sensor."""


@dataclass(frozen=True, slots=True)
class Reading:
    """One measured value with its credentials."""

    value: float | None
    """The value in SI, or None unless there is one to believe."""
    quality: Quality = Quality.GOOD
    cause: str = ""
    """Why the quality is not good, for a person."""
    noise: float | None = None
    """One sigma of the sensor in SI, where it is known."""

    @classmethod
    def bad(cls, cause: str) -> "Reading":
        """A reading that must not be used."""
        return cls(None, Quality.BAD, cause)


ABSENT = Reading(None, Quality.ABSENT, "no such sensor is fitted")


@dataclass(frozen=True, slots=True, kw_only=True)
class Measurement:
    """Every channel of one gripper, sampled together."""

    time: float
    """Monotonic time of the sample. [s]"""
    current: Reading
    """Valve current as the output module says it is. [A]"""
    pressure: Reading = ABSENT
    """Gauge pressure in the muscle. [Pa]"""
    opening: Reading = ABSENT
    """Distance between the jaws. [m]"""
    grip: Reading = ABSENT
    """Grip force per jaw. [N]"""
    enable: Reading = ABSENT
    """External enable: 1 while its contact is closed, 0 while it is open. [-]"""
    estop: Reading = ABSENT
    """Emergency stop: 1 while its contact is closed, that is, not pressed. [-]"""
