"""What can be made to go wrong on the simulated rig."""

from dataclasses import dataclass
from math import inf

from gripperd.bench.sensors import Channel
from gripperd.errors import InputError
from gripperd.units import KILO


@dataclass(frozen=True, slots=True, kw_only=True)
class BenchFaults:
    """Faults present at one time; by default there are none.

    Raises
    ------
    InputError
        When a value is out of its range; the key carries the unit.
    """

    supply_pressure: float | None = None
    """Gauge pressure left before the regulator, None when it is healthy. [Pa]"""
    valve_offset: float = 0.0
    """Zero error of the regulator. [Pa]"""
    leak_rate: float = 0.0
    """Fall of the muscle pressure per pressure with the tube shut: 1/66 for the worst
    real muscle that was measured, 50 for a burst one. [1/s]"""
    jaw_friction: float = 0.0
    """Dry friction in the linkage, as grip force per jaw. [N]"""
    broken: frozenset[Channel] = frozenset()
    """Sensors whose wire is cut: 0 mA."""
    frozen: frozenset[Channel] = frozenset()
    """Sensors that repeat their last reading."""

    def __post_init__(self) -> None:
        supply = 0.0 if self.supply_pressure is None else self.supply_pressure
        for key, value, least in (
            ("supply_kPa", supply / KILO, 0.0),
            ("valve_offset_kPa", self.valve_offset / KILO, -inf),
            ("leak_per_s", self.leak_rate, 0.0),
            ("jaw_friction_N", self.jaw_friction, 0.0),
        ):
            if not least <= value < inf or value == -inf:
                limit = "finite" if least < 0 else "finite and not below 0"
                message = f"{key} = {value:g}: must be {limit}"
                raise InputError(message, key=key)


HEALTHY = BenchFaults()
"""Nothing is wrong."""
