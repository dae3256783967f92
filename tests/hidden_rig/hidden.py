"""What a rig may hide: every effect, where it shows, and how much of it."""

from typing import NamedTuple


class Hidden(NamedTuple):
    """The amount of each effect, in the unit beside it; zero is none of it.

    The two effects of the textbook are there at zero, absent at -1, and at +1 they
    have the family's own form instead of the printed one.
    """

    # Muscle
    rubber_elasticity: float = 0.0
    braid_friction: float = 0.0
    threshold_pressure: float = 0.0  # Pa
    tapered_ends: float = 0.0  # length of the cones per radial growth
    braid_extensibility: float = 0.0  # strain at 500 kPa
    nonlinear_elasticity: float = 0.0  # N at a contraction of 0.2
    temperature_stiffness: float = 0.0  # 1/K
    coulomb_friction: float = 0.0  # N
    pressure_friction: float = 0.0  # N at 300 kPa
    presliding_hysteresis: float = 0.0  # N
    pressure_hysteresis: float = 0.0  # N
    viscous_friction: float = 0.0  # N per 1/s
    creep: float = 0.0  # N
    fatigue: float = 0.0  # fraction of the force
    first_cycle: float = 0.0  # fraction of the force
    # Valve
    valve_offset: float = 0.0  # Pa
    valve_gain: float = 0.0
    valve_nonlinearity: float = 0.0  # Pa
    valve_dead_band: float = 0.0  # Pa
    valve_lag: float = 0.0  # s
    supply_saturation: float = 0.0  # fraction of the highest command
    leak: float = 0.0  # 1/s
    # Gripper
    linkage_friction: float = 0.0  # fraction of the load
    linkage_backlash: float = 0.0  # of contraction
    jaw_compliance: float = 0.0  # m/N
    series_compliance: float = 0.0  # contraction at 1000 N
    # Sensor
    pressure_sensor_bias: float = 0.0  # Pa
    pressure_sensor_gain: float = 0.0
    force_sensor_bias: float = 0.0  # N
    force_sensor_gain: float = 0.0
    force_sensor_drift: float = 0.0  # N over the recording
    length_datum: float = 0.0  # of contraction
    channel_delay: float = 0.0  # s
    ambient_pressure: float = 0.0  # Pa between sessions
    # Known to no library
    ripple_in_length: float = 0.0  # N
    local_bump: float = 0.0  # N
    jaw_magnet: float = 0.0  # N
    ripple_in_pressure: float = 0.0  # N
    supply_ripple: float = 0.0  # N
    resonance: float = 0.0  # N
    side_load_friction: float = 0.0  # N at a contraction of 0.2
    limit_cycle: float = 0.0  # Pa
    thermal_hysteresis: float = 0.0  # N
    mount_slip: float = 0.0  # N
    humidity: float = 0.0  # N
    braid_snap: float = 0.0  # N


class Place(NamedTuple):
    """Where an effect acts and shows."""

    stage: str
    signal: str
    trial: float
    """Amount to try first."""
    usual: tuple[float, float] = (0.015, 0.06)
    """Range of its peak in the signal, of full scale. What a constant within 2 % could
    pass for is larger, what few rigs have much of is smaller."""


MUSCLE, VALVE, GRIPPER, SENSOR = "muscle", "valve", "gripper", "sensor"
FORCE, PRESSURE = "force_N", "pressure_kPa"
LENGTH, OPENING, GRIP = "contraction", "opening_mm", "grip_N"

PLACES = {
    "rubber_elasticity": Place(MUSCLE, FORCE, 0),
    "braid_friction": Place(MUSCLE, FORCE, 0),
    "threshold_pressure": Place(MUSCLE, FORCE, 20e3),
    "tapered_ends": Place(MUSCLE, FORCE, 0.5),
    "braid_extensibility": Place(MUSCLE, FORCE, 0.01),
    "nonlinear_elasticity": Place(MUSCLE, FORCE, 40),
    "temperature_stiffness": Place(MUSCLE, FORCE, 0.02),
    "coulomb_friction": Place(MUSCLE, FORCE, 30),
    "pressure_friction": Place(MUSCLE, FORCE, 30),
    "presliding_hysteresis": Place(MUSCLE, FORCE, 30),
    "pressure_hysteresis": Place(MUSCLE, FORCE, 30),
    "viscous_friction": Place(MUSCLE, FORCE, 1000),
    "creep": Place(MUSCLE, FORCE, 60),
    "fatigue": Place(MUSCLE, FORCE, 0.04),
    "first_cycle": Place(MUSCLE, FORCE, 0.08, (0.03, 0.1)),
    "valve_offset": Place(VALVE, PRESSURE, 10e3, (0.02, 0.06)),
    "valve_gain": Place(VALVE, PRESSURE, 0.03, (0.03, 0.06)),
    "valve_nonlinearity": Place(VALVE, PRESSURE, 10e3),
    "valve_dead_band": Place(VALVE, PRESSURE, 8e3, (0.01, 0.03)),
    "valve_lag": Place(VALVE, PRESSURE, 0.2),
    "supply_saturation": Place(VALVE, PRESSURE, 0.1),
    "leak": Place(VALVE, PRESSURE, 1e-3),
    "linkage_friction": Place(GRIPPER, GRIP, 0.05),
    "linkage_backlash": Place(GRIPPER, OPENING, 0.003, (0.01, 0.03)),
    "jaw_compliance": Place(GRIPPER, OPENING, 3e-5, (0.01, 0.03)),
    "series_compliance": Place(GRIPPER, FORCE, 0.004),
    "pressure_sensor_bias": Place(SENSOR, PRESSURE, 10e3, (0.02, 0.06)),
    "pressure_sensor_gain": Place(SENSOR, PRESSURE, 0.03, (0.03, 0.06)),
    "force_sensor_bias": Place(SENSOR, FORCE, 30),
    "force_sensor_gain": Place(SENSOR, FORCE, 0.03, (0.03, 0.06)),
    "force_sensor_drift": Place(SENSOR, FORCE, 30),
    "length_datum": Place(SENSOR, LENGTH, 0.005, (0.01, 0.04)),
    "channel_delay": Place(SENSOR, FORCE, 0.1),
    "ambient_pressure": Place(SENSOR, PRESSURE, 5e3, (0.006, 0.02)),
    "ripple_in_length": Place(MUSCLE, FORCE, 30),
    "local_bump": Place(MUSCLE, FORCE, 50),
    "jaw_magnet": Place(GRIPPER, GRIP, 5),
    "ripple_in_pressure": Place(MUSCLE, FORCE, 30),
    "supply_ripple": Place(MUSCLE, FORCE, 30),
    "resonance": Place(MUSCLE, FORCE, 30),
    "side_load_friction": Place(MUSCLE, FORCE, 30),
    "limit_cycle": Place(VALVE, PRESSURE, 8e3, (0.01, 0.03)),
    "thermal_hysteresis": Place(MUSCLE, FORCE, 30),
    "mount_slip": Place(SENSOR, FORCE, 30),
    "humidity": Place(MUSCLE, FORCE, 30),
    "braid_snap": Place(MUSCLE, FORCE, 30),
}

TEXTBOOK = ("rubber_elasticity", "braid_friction")
_FIRST_OUTSIDE = Hidden._fields.index("ripple_in_length")
NAMES = Hidden._fields[:_FIRST_OUTSIDE]
OUTSIDE = Hidden._fields[_FIRST_OUTSIDE:]
