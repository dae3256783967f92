"""What monitors look at, and what they say."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Protocol

from gripperd.control.monitors.policy import POLICIES, Cause, Policy
from gripperd.control.profile import Profile
from gripperd.control.states import Grip
from gripperd.model import Chain
from gripperd.signals import Measurement


@dataclass(frozen=True, slots=True, kw_only=True)
class Scatter:
    """One sigma of each sensor. SI values."""

    pressure: float
    opening: float
    grip: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Sight:
    """One sample, and what control is doing meanwhile."""

    measured: Measurement
    """As far as it can be believed."""
    scatter: Scatter
    current: float
    """What the module was last told. [A]"""
    chain: Chain
    grip: Grip
    idle: bool
    """Whether no command and no reaction moves the jaws."""
    policies: Mapping[Cause, Policy] = field(default_factory=lambda: POLICIES)
    """What counts for what is held."""
    profile: Profile | None = None
    """Of what is held, if it is known."""

    @property
    def holding(self) -> bool:
        """Whether something is held, and is to stay as it is."""
        return self.idle and self.grip is Grip.HOLDING


@dataclass(frozen=True, slots=True)
class Symptom:
    """Something is wrong at this moment."""

    cause: Cause
    text: str
    """For a person, with the numbers."""
    subject: str = ""
    """Which one, where there are several, such as a channel."""


class Monitor(Protocol):
    """Watches for one thing, or for a family that has to be told apart."""

    def look(self, sight: Sight, dt: float) -> Iterator[Symptom]:
        """Take in one sample; say what is wrong now.

        Parameters
        ----------
        sight
            The sample.
        dt
            Time since the last one. [s]
        """
        ...


class Lasting:
    """How long something has been so without a break."""

    def __init__(self) -> None:
        self._seconds = 0.0
        self._so = False

    def update(self, so: bool, dt: float) -> float:
        """Seconds since it began; below 0 when it is not so."""
        self._seconds = self._seconds + dt if so and self._so else 0.0
        self._so = so
        return self._seconds if so else -1.0


class Smooth:
    """First-order low pass of a value that may be missing."""

    def __init__(self, time_constant: float) -> None:
        self._time_constant = time_constant
        self.value: float | None = None

    def update(self, value: float | None, dt: float) -> float | None:
        """Take in one sample, and give the smoothed value; a gap starts anew."""
        if value is None or self.value is None:
            self.value = value
        else:
            self.value += (value - self.value) * min(dt / self._time_constant, 1.0)
        return self.value
