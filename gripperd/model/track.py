"""What a rig goes through in one run, sample by sample."""

from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from gripperd.model.effect import MuscleState
from gripperd.model.muscle import Muscle

Array: TypeAlias = NDArray[np.float64]


@dataclass(frozen=True)
class Geometry:
    """What a muscle is like as it contracts, sample by sample."""

    muscle: Muscle
    contraction: Array
    """Shortening relative to rest. [-]"""

    @cached_property
    def diameter_ratio(self) -> Array:
        """Diameter of the braid relative to rest. [-]."""
        return np.asarray(self.muscle.diameter_ratio(self.contraction))

    @cached_property
    def pull_area(self) -> Array:
        """Ideal pull per pressure, eq. (4) divided by p. [m²]."""
        return np.asarray(self.muscle.pull_area(self.contraction))


@dataclass(frozen=True, kw_only=True)
class Track:
    """One run: arrays of one shape ``(n,)`` in SI. What is not known is NaN."""

    muscle: Muscle
    time: Array
    """Since the start of the recording. [s]"""
    step: Array
    """Since the sample before; 0 for the first of a run. [s]"""
    command: Array
    """Gauge pressure the textbook regulator gives for the current, in its span. [Pa]"""
    span: tuple[float, float]
    """Gauge pressures at both ends of the regulator's line. [Pa]"""
    still: Array
    """Time since the command last moved. [s]"""
    waiting: Array
    """The same, 0 where a regulator is taken to keep the pressure. [s]"""
    pressure: Array
    """Gauge pressure in the muscle. [Pa]"""
    contraction: Array
    """Shortening relative to rest. [-]"""
    rate: Array
    """Of contraction. [1/s]"""
    direction: Array
    """+1 contracting, -1 extending, kept at rest. [-]"""
    came: Array
    """The same of the travel before a run that has none; else not known. [-]"""
    force: Array
    """Pull of the muscle. [N]"""
    grip: Array
    """Force of each jaw. [N]"""
    temperature: Array
    """Of the muscle. [K]"""
    supply_drop: Array
    """What the supply has lost of its highest; 0 where that is not measured. [Pa]"""
    ambient: Array
    """Absolute pressure of the air around. [Pa]"""
    cycle: Array
    """Inflations since the start of the recording, 0 in the first. [-]"""
    repeat: Array
    """Times that this same sweep was run before in an unbroken row. [-]"""

    @cached_property
    def geometry(self) -> Geometry:
        """That of the muscle."""
        return Geometry(self.muscle, self.contraction)

    @cached_property
    def diameter_ratio(self) -> Array:
        """Diameter of the braid relative to rest. [-]."""
        return self.geometry.diameter_ratio

    @cached_property
    def pull_area(self) -> Array:
        """Ideal pull per pressure, eq. (4) divided by p. [m²]."""
        return self.geometry.pull_area

    @cached_property
    def state(self) -> MuscleState:
        """The same, as static effects see it."""
        return MuscleState(
            pressure=self.pressure,
            contraction=self.contraction,
            diameter_ratio=self.diameter_ratio,
            direction=self.direction,
            rate=self.rate,
            temperature=self.temperature,
            cycle=self.cycle,
        )
