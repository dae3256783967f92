"""The constants of a rig: as drawn, and as built."""

from typing import NamedTuple

import numpy as np


class Rig(NamedTuple):
    """Muscle, regulator and gripper in SI. The defaults are the reference rig."""

    rest_length: float = 0.250
    diameter: float = 0.020
    braid_angle: float = float(np.deg2rad(25.0))
    wall: float = 0.002
    modulus: float = 1.3e6
    friction: float = 0.002
    pressure_span: float = 500e3
    open_width: float = 0.085
    ratio: float = 4.0
    preload: float = 240.0
    spring_rate: float = 1000.0


def built(drawn: Rig, spread: float, random: np.random.Generator) -> Rig:
    """Give a rig whose every constant is off by up to ``spread`` (a fraction)."""
    errors = 1 + random.uniform(-spread, spread, len(drawn))
    return Rig(*(float(c * e) for c, e in zip(drawn, errors, strict=True)))


def off_by(drawn: Rig, error: float, random: np.random.Generator) -> Rig:
    """Give a rig whose every constant is off by just ``error`` (a fraction)."""
    signs = random.choice([-1.0, 1.0], len(drawn))
    return Rig(*(float(c * (1 + error * s)) for c, s in zip(drawn, signs, strict=True)))
