"""Family B: the statics by virtual work on one strand, second forms of the effects.

Dry friction follows a hyperbolic tangent, hysteresis a bank of relays, creep Eyring's
law of thermally activated flow.
"""

import math

import numpy as np

from tests.hidden_rig.compiled import compiled
from tests.hidden_rig.course import (
    DRY,
    FORCE,
    INFLATIONS,
    LENGTH,
    LINKAGE,
    PLAY,
    PRESSURE,
    SLIDING,
    STEP,
    STRAINS,
    Array,
    Point,
    shortened,
)
from tests.hidden_rig.hidden import Hidden
from tests.hidden_rig.outside import outside_force
from tests.hidden_rig.relays import hysteresis
from tests.hidden_rig.rig import Rig


@compiled
def ideal(rig: Rig, hidden: Hidden, pressure: float, contraction: float) -> float:
    """Give p dV/d(shortening) of the cylinder a strand winds, less that of its ends."""
    felt = pressure
    if hidden.threshold_pressure > 0:
        # The bladder meets the braid bit by bit.
        scale = 1.5 * hidden.threshold_pressure
        lost = math.tanh(max(pressure, 0.0) / scale)
        felt -= hidden.threshold_pressure * lost
    strand = rig.rest_length / math.cos(rig.braid_angle)
    turns = strand * math.sin(rig.braid_angle) / (math.pi * rig.diameter)
    # Crimp comes out first, then the fibre itself hardly gives.
    bar = max(pressure, 0.0) / 500e3
    strand *= 1 + hidden.braid_extensibility * bar**1.4
    length = rig.rest_length * (1 - contraction)
    winding = math.sqrt(strand**2 - length**2)
    diameter = winding / (math.pi * turns)
    force = felt * (2 * length**2 - winding**2) / (4 * math.pi * turns**2)
    # Two round shoulders: the volume they lack grows with the square of the bulge.
    bulge = max(diameter - rig.diameter, 0.0)
    widening = length / (math.pi * turns * winding)
    lacking = 2 * bulge * diameter + bulge**2
    return force - felt * hidden.tapered_ends * lacking * widening


@compiled
def rubber(rig: Rig, hidden: Hidden, contraction: float, temperature: float) -> float:
    """Axial and hoop stress of a thin tube by virtual work, or an early plateau."""
    angle = math.acos((1 - contraction) * math.cos(rig.braid_angle))
    hoop = math.sin(angle) / math.sin(rig.braid_angle) - 1
    axial = math.pi * rig.diameter * (1 + hoop) * contraction
    lever = math.pi * rig.diameter / math.tan(rig.braid_angle)
    around = hoop * lever * (1 - contraction) / math.tan(angle)
    linear = rig.modulus * rig.wall * (axial + around)
    plateau = rig.modulus / 1.3e6 * 260.0 * -math.expm1(-contraction / 0.033)
    if hidden.rubber_elasticity < 0:
        linear = 0.0
    elif hidden.rubber_elasticity > 0:
        linear = plateau
    warm = temperature - 20.0
    linear *= 1 - hidden.temperature_stiffness * warm * (1 + 0.02 * warm)
    early = contraction / (0.04 + abs(contraction)) * 1.2
    return linear + hidden.nonlinear_elasticity * early


@compiled
def braid_friction(
    rig: Rig, hidden: Hidden, pressure: float, contraction: float
) -> float:
    """Friction coefficient x contact pressure x area of contact."""
    angle = math.acos((1 - contraction) * math.cos(rig.braid_angle))
    s = math.sin(angle) / math.sin(rig.braid_angle)
    support = 2 * rig.wall * rig.modulus * (s - 1) / (rig.diameter * s)
    area = math.pi * rig.diameter * s * rig.rest_length * (1 - contraction)
    if hidden.braid_friction > 0:
        # Strand on strand (Davis and Caldwell): the crossings open up as it shortens.
        first = math.sin(rig.braid_angle) * math.cos(rig.braid_angle)
        area = math.pi * rig.diameter * rig.rest_length
        area *= first / (math.sin(angle) * math.cos(angle))
    return rig.friction * area * max(pressure - support, 0.0)


@compiled
def friction(rig: Rig, hidden: Hidden, old: Array, new: Array, here: Point) -> float:
    """All that opposes the motion, and its memories."""
    moved = here.contraction - old[LENGTH]
    # Both keep at rest what the last motion left.
    toward = np.sign(moved)
    new[DRY] = toward + (old[DRY] - toward) * math.exp(-abs(moved) / 5e-4)
    rushing = math.tanh(here.rate / 4e-3)
    new[SLIDING] = rushing + (old[SLIDING] - rushing) * math.exp(-abs(moved) / 5e-4)
    bar = max(here.pressure, 0.0) / 300e3
    crossing = 1 + 1.5 * max(here.contraction, 0.0)
    damping = here.rate * (0.4 + 0.6 * bar)
    opposing: float = (
        braid_friction(rig, hidden, here.pressure, here.contraction)
        * (1 + min(hidden.braid_friction, 0.0))
        * new[DRY]
        + hidden.coulomb_friction * new[SLIDING]
        + hidden.pressure_friction * bar**1.2 * crossing * new[SLIDING]
        + hysteresis(hidden, old, new, here)
        + hidden.viscous_friction * damping
    )
    return opposing


@compiled
def ageing(hidden: Hidden, old: Array, new: Array, here: Point) -> float:
    """The factor on the force that history leaves."""
    path = abs(here.pressure - old[PRESSURE]) / 800e3
    new[INFLATIONS] = old[INFLATIONS] + path + abs(here.contraction - old[LENGTH]) / 1.0
    # Mullins: stiff until the rubber has been where it is now.
    done: float = new[INFLATIONS]
    virgin = 1 / (1 + (done / 0.7) ** 4) if here.run == 0 else 0.0
    return 1 - hidden.fatigue * math.sqrt(done / 10.0) + hidden.first_cycle * virgin


@compiled
def creep(hidden: Hidden, old: Array, new: Array, here: Point) -> float:
    """The part of the force that flow has not yet given, or not yet taken back."""
    goal = max(here.pressure, 0.0) / 400e3
    last: float = old[STRAINS]
    drive = (goal - last) / 0.12
    now = last + STEP * 1.5e-3 * math.sinh(min(max(drive, -7.0), 7.0))
    new[STRAINS] = now
    return hidden.creep * (now - goal)


@compiled
def pull(rig: Rig, hidden: Hidden, old: Array, new: Array, here: Point) -> float:
    """Signed force of the muscle; leaves its memories in ``new``. [N]."""
    # A rope's extension: steep at first, stiffer under load.
    load = max(old[FORCE], 0.0) / 1000.0
    inside = shortened(here, hidden.series_compliance * load**0.75)
    force = ideal(rig, hidden, inside.pressure, inside.contraction)
    force -= rubber(rig, hidden, inside.contraction, inside.temperature)
    force *= ageing(hidden, old, new, inside)
    force += creep(hidden, old, new, inside)
    force -= friction(rig, hidden, old, new, inside)
    force += outside_force(hidden, old, new, inside)
    new[LENGTH] = inside.contraction
    new[PRESSURE] = inside.pressure
    new[FORCE] = force
    return force


@compiled
def jaws(rig: Rig, hidden: Hidden, old: Array, new: Array, contraction: float) -> float:
    """Opening of the free jaws; leaves play and direction of the linkage. [m]."""
    # Soft play: the pins roll across their holes before they push.
    moved = contraction - old[PLAY]
    slack = 0.5 * hidden.linkage_backlash + 1e-9
    new[PLAY] = old[PLAY]
    if abs(moved) > 0.6 * slack:
        new[PLAY] = contraction - np.sign(moved) * _taken(abs(moved), slack)
    toward = np.sign(new[PLAY] - old[PLAY])
    left = math.exp(-abs(new[PLAY] - old[PLAY]) / 8e-4)
    new[LINKAGE] = toward + (old[LINKAGE] - toward) * left
    opening: float = rig.open_width - rig.ratio * rig.rest_length * new[PLAY]
    return opening


@compiled
def _taken(moved: float, slack: float) -> float:
    return slack - 0.4 * slack * math.exp(-(moved - 0.6 * slack) / (0.4 * slack))


@compiled
def bending(hidden: Hidden, grip: float) -> float:
    """How far the fingers give way; their pads yield most at first. [m]."""
    return hidden.jaw_compliance * 20.0 * math.pow(grip / 20.0, 0.85)
