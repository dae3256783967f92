"""What a correction without physics can tell: families of effects, by what they follow.

A regression on the residual knows which variables it leans on, not why. So its answer
is a family: all effects whose trace leans on the same. Effects with two traces are in
two families, and an answer with either counts.
"""

from collections.abc import Mapping

FAMILIES: Mapping[str, frozenset[str]] = {
    "pressure": frozenset(
        {
            "threshold_pressure", "tapered_ends", "braid_extensibility",
            "series_compliance", "pressure_sensor_bias", "pressure_sensor_gain",
            "force_sensor_bias", "force_sensor_gain", "ambient_pressure",
        }
    ),
    "length": frozenset(
        {
            "rubber_elasticity", "nonlinear_elasticity", "tapered_ends",
            "series_compliance", "length_datum", "force_sensor_bias",
        }
    ),
    "direction": frozenset(
        {
            "braid_friction", "coulomb_friction", "pressure_friction",
            "presliding_hysteresis", "pressure_hysteresis", "viscous_friction",
            "channel_delay",
        }
    ),
    "temperature": frozenset({"temperature_stiffness"}),
    "time": frozenset(
        {"creep", "fatigue", "first_cycle", "force_sensor_drift", "ambient_pressure"}
    ),
    "valve curve": frozenset(
        {
            "valve_offset", "valve_gain", "valve_nonlinearity", "supply_saturation",
            "pressure_sensor_bias", "pressure_sensor_gain", "ambient_pressure",
        }
    ),
    "valve memory": frozenset({"valve_dead_band", "valve_lag", "leak"}),
    "gripper": frozenset(
        {"linkage_friction", "linkage_backlash", "jaw_compliance", "length_datum"}
    ),
}  # fmt: skip
"""Effects of each family."""

FORCE = {
    "pressure": "pressure",
    "contraction": "length",
    "direction": "direction",
    "temperature": "temperature",
    "time": "time",
}
"""Family for the variable a force residual leans on most."""

VALVE = {"direction": "valve memory", "still": "valve memory", "time": "valve memory"}
"""The same for a pressure residual; any other variable means the curve."""

SPEAKS = 0.25
"""Share of the importance from which direction, temperature or time decide: they are
rarely the largest, since pressure and contraction scale almost any effect."""


def family(signal: str, importance: Mapping[str, float]) -> str:
    """Name a family from the variables that a correction leans on.

    Parameters
    ----------
    signal
        Whose residual was corrected.
    importance
        By variable; only proportions count.
    """
    if signal in ("opening", "grip"):
        return "gripper"
    total = sum(max(value, 0.0) for value in importance.values()) or 1.0
    telling = {
        name: value
        for name, value in importance.items()
        if name in ("direction", "temperature", "time", "still")
        and value >= SPEAKS * total
    }
    leading = max(telling or importance, key=lambda name: importance[name])
    return VALVE.get(leading, "valve curve") if signal == "pressure" else FORCE[leading]


def families(name: str) -> frozenset[str]:
    """Families that an effect belongs to."""
    return frozenset(key for key, effects in FAMILIES.items() if name in effects)
