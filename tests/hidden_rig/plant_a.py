"""Family A: the closed form of the statics, and the first form of each effect.

Dry friction is a play, hysteresis a Bouc-Wen element, creep a Kelvin-Voigt chain.
"""

import math

import numpy as np

from tests.hidden_rig.compiled import compiled
from tests.hidden_rig.course import (
    DRY,
    FORCE,
    IN_LENGTH,
    IN_PRESSURE,
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
from tests.hidden_rig.rig import Rig


@compiled
def ideal(rig: Rig, hidden: Hidden, pressure: float, contraction: float) -> float:
    """Eq. (4), with the three ways in which the shape of the braid may differ."""
    threshold, width = hidden.threshold_pressure, 0.4 * hidden.threshold_pressure + 1.0
    felt = pressure
    if threshold > 0:
        # Softplus: the bladder takes up pressure until it meets the braid.
        bend = (pressure - threshold) / width
        felt = width * (max(bend, 0.0) + math.log1p(math.exp(-abs(bend))))
        felt -= width * math.log1p(math.exp(-threshold / width))
    swelling = _swelling(rig, contraction) - 1
    # The cones take from the middle what they grow in radius (Kothera's arc tips).
    taken = hidden.tapered_ends * swelling * rig.diameter / rig.rest_length
    strand = 1 + hidden.braid_extensibility * max(pressure, 0.0) / 500e3
    area = math.pi * rig.diameter**2 / 4
    long = 3 * (1 - contraction - taken) ** 2 / math.tan(rig.braid_angle) ** 2
    return felt * area * (long - strand**2 / math.sin(rig.braid_angle) ** 2)


@compiled
def _swelling(rig: Rig, contraction: float) -> float:
    cosine = (1 - contraction) * math.cos(rig.braid_angle)
    return math.sqrt(1 - cosine**2) / math.sin(rig.braid_angle)


@compiled
def rubber(rig: Rig, hidden: Hidden, contraction: float, temperature: float) -> float:
    """Eq. (5), softened by warmth (Arrhenius), stiffened by stretch (Fung)."""
    s = _swelling(rig, contraction)
    hoop = (1 - contraction) ** 2 / math.tan(rig.braid_angle) ** 2 * (1 - 1 / s)
    linear = rig.modulus * rig.wall * math.pi * rig.diameter * (hoop + contraction * s)
    if hidden.rubber_elasticity < 0:
        linear = 0.0
    activation = 1 / (temperature + 273.15) - 1 / 293.15
    linear *= math.exp(hidden.temperature_stiffness * 293.15**2 * activation)
    fung = (math.exp(9 * contraction) - 1 - 9 * contraction) / (math.exp(1.8) - 2.8)
    return linear + hidden.nonlinear_elasticity * fung


@compiled
def braid_friction(rig: Rig, pressure: float, contraction: float) -> float:
    """Eq. (6), re-braced, never negative."""
    hoop = 2 * rig.modulus * rig.wall
    contact = (pressure * rig.diameter - hoop) * _swelling(rig, contraction) + hoop
    length = rig.rest_length * (1 - contraction)
    return rig.friction * math.pi * length * max(contact, 0.0)


@compiled
def _bouc_wen(z: float, moved: float) -> float:
    same = 0.5 + math.copysign(0.5, moved * z)
    grown: float = z + moved * (1 - same * abs(z) ** 1.3)
    return min(max(grown, -1.0), 1.0)


@compiled
def friction(rig: Rig, hidden: Hidden, old: Array, new: Array, here: Point) -> float:
    """All that opposes the motion, and its memories."""
    moved = here.contraction - old[LENGTH]
    new[DRY] = min(max(old[DRY] + moved / 4e-4, -1.0), 1.0)
    toward = np.sign(moved)
    new[SLIDING] = toward + (old[SLIDING] - toward) * math.exp(-abs(moved) / 8e-4)
    new[IN_LENGTH] = _bouc_wen(old[IN_LENGTH], moved / 6e-3)
    new[IN_PRESSURE] = _bouc_wen(
        old[IN_PRESSURE], (here.pressure - old[PRESSURE]) / 30e3
    )
    bar = max(here.pressure, 0.0) / 300e3
    printed = braid_friction(rig, here.pressure, here.contraction)
    thinning = here.rate / math.sqrt(1 + (here.rate / 0.1) ** 2)
    opposing: float = (
        printed * (1 + hidden.braid_friction) * new[DRY]
        + hidden.coulomb_friction * new[SLIDING]
        + hidden.pressure_friction * bar**0.72 * new[DRY]
        + hidden.presliding_hysteresis * new[IN_LENGTH]
        + hidden.pressure_hysteresis * new[IN_PRESSURE]
        + hidden.viscous_friction * thinning
    )
    return opposing


@compiled
def ageing(hidden: Hidden, old: Array, new: Array, here: Point) -> float:
    """The factor on the force that history leaves."""
    path = abs(here.pressure - old[PRESSURE]) / 800e3
    new[INFLATIONS] = old[INFLATIONS] + path
    virgin = math.exp(-new[INFLATIONS] / 0.6) if here.run == 0 else 0.0
    worn = 1 - math.exp(-new[INFLATIONS] / 10.0)
    return 1 - hidden.fatigue * worn + hidden.first_cycle * virgin


@compiled
def creep(hidden: Hidden, old: Array, new: Array, here: Point) -> float:
    """The part of the force that a chain of four Kelvin-Voigt elements withholds."""
    goal = max(here.pressure, 0.0) / 400e3
    total, lag = 0.0, 1.5
    for k in range(4):
        last = old[STRAINS + k]
        new[STRAINS + k] = goal + (last - goal) * math.exp(-STEP / lag)
        total += 0.25 * new[STRAINS + k]
        lag *= 4.0
    return hidden.creep * (total - goal)


@compiled
def pull(rig: Rig, hidden: Hidden, old: Array, new: Array, here: Point) -> float:
    """Signed force of the muscle; leaves its memories in ``new``. [N]."""
    # Tendon and frame give way, with a toe, so the muscle is shorter than the rig.
    load = max(old[FORCE], 0.0) / 1000.0
    shorter = hidden.series_compliance * (load + 0.3 * (1 - math.exp(-load / 0.2)))
    inside = shortened(here, shorter)
    elastic = ideal(rig, hidden, inside.pressure, inside.contraction)
    elastic -= rubber(rig, hidden, inside.contraction, inside.temperature)
    force = elastic * ageing(hidden, old, new, inside)
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
    moved = contraction - old[PLAY]
    slack = 0.5 * hidden.linkage_backlash
    new[PLAY] = old[PLAY] + max(moved - slack, 0.0) + min(moved + slack, 0.0)
    turned = (new[PLAY] - old[PLAY]) / 5e-4
    new[LINKAGE] = min(max(old[LINKAGE] + turned, -1.0), 1.0)
    opening: float = rig.open_width - rig.ratio * rig.rest_length * new[PLAY]
    return opening


@compiled
def bending(hidden: Hidden, grip: float) -> float:
    """How far the fingers give way; they stiffen as they close up. [m]."""
    return hidden.jaw_compliance * grip / (1 + grip / 200.0)
