"""Constants of the simulated rig that the static model does not know."""

from dataclasses import dataclass

from gripperd.model.effect import ROOM


@dataclass(frozen=True, slots=True, kw_only=True)
class PlantSettings:
    """How fast air and jaws move, and how the object is carried. SI values.

    The lags are those measured on a 10 mm muscle behind an E/P regulator: 63 % of a
    rise in 40-60 ms at the outlet, of the travel in 60-110 ms, of a fall to zero in
    100-125 ms; emptying takes 1.3-2.5 times as long as filling.
    """

    supply_pressure: float = 700e3
    """Gauge pressure before the regulator. [Pa]"""
    regulator_lag: float = 0.040
    """Time constant of the regulator outlet when it rises. [s]"""
    chamber_lag: float = 0.020
    """Time constant of tube and muscle when they fill. [s]"""
    exhaust_factor: float = 1.5
    """How much longer both take to empty. [-]"""
    moving_mass: float = 0.5
    """Mass as the muscle feels it: two jaws of 60 g, each at twice its speed. [kg]"""
    damping: float = 300.0
    """Viscous force on the muscle per speed; 25 ms for free jaws. [N s/m]"""
    pad_loss: float = 0.002
    """Retardation time of pad and object, viscous loss per stiffness. [s]"""
    lift_delay: float = 0.25
    """How long the grip has to be steady before the object is lifted. [s]"""
    lift_acceleration: float = 2.0
    """Acceleration of the carried object, on top of gravity. [m/s²]"""
    temperature: float = ROOM
    """Of the muscle. [K]"""
    ambient_pressure: float = 101_325.0
    """Absolute pressure of the air around. [Pa]"""
