"""What the textbook leaves out, one phenomenon a file.

To add an effect, write a file with a frozen dataclass that satisfies the port of its
stage in :mod:`gripperd.model.effect`, and name it in :data:`EFFECTS`.
"""

from collections.abc import Mapping
from types import MappingProxyType

from gripperd.effects.ambient_pressure import AmbientPressure
from gripperd.effects.braid_extensibility import BraidExtensibility
from gripperd.effects.braid_friction import BraidFriction
from gripperd.effects.channel_delay import ChannelDelay
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.creep import Creep
from gripperd.effects.fatigue import Fatigue
from gripperd.effects.first_cycle import FirstCycle
from gripperd.effects.force_sensor_bias import ForceSensorBias
from gripperd.effects.force_sensor_drift import ForceSensorDrift
from gripperd.effects.force_sensor_gain import ForceSensorGain
from gripperd.effects.jaw_compliance import JawCompliance
from gripperd.effects.leak import Leak
from gripperd.effects.length_datum import LengthDatum
from gripperd.effects.linkage_backlash import LinkageBacklash
from gripperd.effects.linkage_friction import LinkageFriction
from gripperd.effects.nonlinear_elasticity import NonlinearElasticity
from gripperd.effects.presliding_hysteresis import PreslidingHysteresis
from gripperd.effects.pressure_friction import PressureFriction
from gripperd.effects.pressure_hysteresis import PressureHysteresis
from gripperd.effects.pressure_sensor_bias import PressureSensorBias
from gripperd.effects.pressure_sensor_gain import PressureSensorGain
from gripperd.effects.rubber_elasticity import RubberElasticity
from gripperd.effects.series_compliance import SeriesCompliance
from gripperd.effects.supply_saturation import SupplySaturation
from gripperd.effects.tapered_ends import TaperedEnds
from gripperd.effects.temperature_stiffness import TemperatureStiffness
from gripperd.effects.threshold_pressure import ThresholdPressure
from gripperd.effects.valve_dead_band import ValveDeadBand
from gripperd.effects.valve_gain import ValveGain
from gripperd.effects.valve_lag import ValveLag
from gripperd.effects.valve_nonlinearity import ValveNonlinearity
from gripperd.effects.valve_offset import ValveOffset
from gripperd.effects.viscous_friction import ViscousFriction
from gripperd.model.effect import Effect

_MUSCLE: tuple[type[Effect], ...] = (
    RubberElasticity,
    BraidFriction,
    ThresholdPressure,
    TaperedEnds,
    BraidExtensibility,
    NonlinearElasticity,
    TemperatureStiffness,
    CoulombFriction,
    PressureFriction,
    PreslidingHysteresis,
    PressureHysteresis,
    ViscousFriction,
    Creep,
    Fatigue,
    FirstCycle,
)
_VALVE: tuple[type[Effect], ...] = (
    ValveOffset,
    ValveGain,
    ValveNonlinearity,
    ValveDeadBand,
    ValveLag,
    SupplySaturation,
    Leak,
)
_GRIPPER: tuple[type[Effect], ...] = (
    LinkageFriction,
    LinkageBacklash,
    JawCompliance,
    SeriesCompliance,
)
_SENSOR: tuple[type[Effect], ...] = (
    PressureSensorBias,
    PressureSensorGain,
    ForceSensorBias,
    ForceSensorGain,
    ForceSensorDrift,
    LengthDatum,
    ChannelDelay,
    AmbientPressure,
)

EFFECTS: Mapping[str, type[Effect]] = MappingProxyType(
    {effect.name: effect for effect in (*_MUSCLE, *_VALVE, *_GRIPPER, *_SENSOR)}
)
"""Every effect by the name that model files use."""
