"""What can go wrong, from when on it counts, and what is done about it."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from types import MappingProxyType


class Cause(StrEnum):
    """What can go wrong with a gripper that has a link."""

    PART_LOST = "part_lost"
    SLIP = "slip"
    FORCE_DRIFT = "force_drift"
    OVER_FORCE = "over_force"
    SUPPLY_SAG = "supply_sag"
    LEAK = "leak"
    BURST = "burst"
    VALVE_NOT_FOLLOWING = "valve_not_following"
    JAW_BLOCKED = "jaw_blocked"
    SENSOR_FAILED = "sensor_failed"
    OUTPUT_CHANGED = "output_changed"
    """Somebody else wrote the valve current."""
    MODULE_RESTARTED = "module_restarted"
    """The output module is back at the value it has after power-on."""
    NOT_ENABLED = "not_enabled"
    """The contact of the external enable is open."""
    ESTOPPED = "estopped"
    """That of the emergency stop is; who closes it again need not acknowledge it."""


class Reaction(StrEnum):
    """What is done about it, from the mildest to the strongest."""

    HOLD = "hold"
    """Keep the grip as it is."""
    FREEZE = "freeze"
    """Bring the jaws to rest where they are, and keep the current."""
    REDUCE = "reduce"
    """Lower the force to the safe side of the damage limit."""
    CONTROLLED_RELEASE = "controlled_release"
    """Ramp down to the live zero."""
    VENT = "vent"
    """Go to the live zero at once."""


OPENING = frozenset({Reaction.CONTROLLED_RELEASE, Reaction.VENT})
"""Reactions that let go."""
STRENGTH = MappingProxyType({each: rank for rank, each in enumerate(Reaction)})
"""Rank of each reaction: of two the stronger one is carried out."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Policy:
    """When a cause counts, and what follows."""

    after: float
    """How long it has to last. [s]"""
    limit: float | None = None
    """From where on it counts; what it means, and its unit, depend on the cause."""
    reaction: Reaction = Reaction.HOLD
    latched: bool = False
    """Whether it stops the gripper until somebody acknowledges and resets it."""


POLICIES: Mapping[Cause, Policy] = MappingProxyType(
    {
        Cause.PART_LOST: Policy(after=0.05),
        # Closing at an unchanged or falling force. [m]
        Cause.SLIP: Policy(limit=0.4e-3, after=0.02),
        # Share of the force at the beginning of the hold. [-]
        Cause.FORCE_DRIFT: Policy(limit=0.10, after=2.0),
        # Share of the damage limit; a grasp is cut short at the same. [-]
        Cause.OVER_FORCE: Policy(
            limit=1 / 1.15, after=0.05, reaction=Reaction.REDUCE, latched=True
        ),
        # Share of the pressure that the current stands for. [-]
        Cause.SUPPLY_SAG: Policy(limit=0.06, after=0.15),
        Cause.LEAK: Policy(limit=0.06, after=0.15),
        Cause.BURST: Policy(limit=0.30, after=0.06, latched=True),
        # Share of the span of the regulator. [-]
        Cause.VALVE_NOT_FOLLOWING: Policy(limit=0.06, after=0.2, latched=True),
        # Grip force that the model misses, far beyond what it may be wrong by. [N]
        Cause.JAW_BLOCKED: Policy(
            limit=15.0, after=0.3, reaction=Reaction.CONTROLLED_RELEASE, latched=True
        ),
        Cause.SENSOR_FAILED: Policy(after=0.1),
        Cause.OUTPUT_CHANGED: Policy(after=0.0),
        Cause.MODULE_RESTARTED: Policy(after=0.0, latched=True),
        Cause.NOT_ENABLED: Policy(after=0.0, reaction=Reaction.FREEZE),
        Cause.ESTOPPED: Policy(after=0.0, reaction=Reaction.FREEZE, latched=True),
    }
)
"""What applies unless the settings say otherwise."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Monitoring:
    """How one gripper is watched."""

    policies: Mapping[Cause, Policy] = field(default_factory=lambda: POLICIES)
    spans: Mapping[str, float] = field(default_factory=dict)
    """Span of each sensor, by its name in a measurement; as shipped if unknown. [SI]"""


AS_SHIPPED = Monitoring()
"""What a gripper does that is told nothing else."""

DETECTION: Mapping[Cause, float] = MappingProxyType(
    {
        Cause.PART_LOST: 0.15,
        Cause.SLIP: 0.15,
        Cause.FORCE_DRIFT: 6.0,
        Cause.OVER_FORCE: 0.25,
        Cause.SUPPLY_SAG: 0.5,
        Cause.LEAK: 0.5,
        Cause.BURST: 0.25,
        Cause.VALVE_NOT_FOLLOWING: 1.0,
        Cause.JAW_BLOCKED: 0.5,
        Cause.SENSOR_FAILED: 0.6,
        Cause.OUTPUT_CHANGED: 0.05,
        Cause.MODULE_RESTARTED: 0.05,
        Cause.NOT_ENABLED: 0.05,
        Cause.ESTOPPED: 0.05,
    }
)
"""Promise at 100 Hz and with the policies above: longest time from a change that is
twice as large as the limit to the notice; for a valve, from the current it does not
follow; for a blocked jaw, from the pressure that ought to press with the limit. [s]"""
