"""What can be made to go wrong on the simulated rig."""

from dataclasses import dataclass
from math import inf

from gripperd.bench.contacts import Contact
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
    tube_shut: bool = False
    """A check valve has trapped the air in the muscle, as when air or power is lost."""
    valve_stuck: bool = False
    """The regulator keeps its outlet where it is, whatever the current."""
    jaw_friction: float = 0.0
    """Dry friction in the linkage, as grip force per jaw. [N]"""
    jaws_blocked: bool = False
    """Something is jammed in the linkage; the jaws cannot move either way."""
    pad_friction: float = 1.0
    """Share of the friction between pads and object that is left, 0 for ice. [-]"""
    pull: float = 0.0
    """Downward force on the object, besides its weight. [N]"""
    broken: frozenset[Channel] = frozenset()
    """Sensors whose wire is cut: 0 mA."""
    shorted: frozenset[Channel] = frozenset()
    """Sensors whose wire touches the supply: 24 mA."""
    frozen: frozenset[Channel] = frozenset()
    """Sensors that repeat their last reading."""
    spiking: frozenset[Channel] = frozenset()
    """Sensors with a wild sample now and then, a tenth of them."""
    opened: frozenset[Contact] = frozenset()
    """Contacts that are open: the enable is missing, the emergency stop pressed."""

    def __post_init__(self) -> None:
        supply = 0.0 if self.supply_pressure is None else self.supply_pressure
        for key, value, least in (
            ("supply_kPa", supply / KILO, 0.0),
            ("valve_offset_kPa", self.valve_offset / KILO, -inf),
            ("leak_per_s", self.leak_rate, 0.0),
            ("jaw_friction_N", self.jaw_friction, 0.0),
            ("pad_friction", self.pad_friction, 0.0),
            ("pull_N", self.pull, 0.0),
        ):
            if not least <= value < inf or value == -inf:
                limit = "finite" if least < 0 else "finite and not below 0"
                message = f"{key} = {value:g}: must be {limit}"
                raise InputError(message, key=key)


HEALTHY = BenchFaults()
"""Nothing is wrong."""
