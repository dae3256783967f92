"""What is assumed of an object that only its size and a target are given of.

The choices are on the careful side, and the reply shows them. They are no measurement:
who knows the object makes a profile.
"""

from dataclasses import replace
from math import pi

from gripperd.control.held import Held
from gripperd.control.profile import Mode, Profile
from gripperd.model import Chain, PressedObject
from gripperd.units import STANDARD_GRAVITY

NAME = "unnamed"
VERSION = 0
"""No profile of a file or a client has it."""
SOURCE = "Assumed, as no profile was named: the force asked for does no harm."

DENSITY = 1000.0
"""A ball of water: fruit floats or nearly so. [kg/m³]"""
FRICTION = 0.4
"""The slipperiest of the shipped objects, an egg on rubber. [-]"""
ACCELERATION = 5.0
"""A brisk pick and place, as in the shipped profiles. [m/s²]"""
STIFFNESS = 100e3
"""An eggshell: hard objects feel every error of the current at once. [N/m]"""
SIZE_SHARE = 0.1
SIZE_LEAST = 2e-3
"""How far the size may be off: a share of it, at least this. [m]"""
SLIP_MARGIN = 1.5
CRUSH_MARGIN = 1.3
"""As in the shipped profiles. [-]"""
DAMAGE_FACTOR = 1.5
"""Force that counts as damage, relative to what was asked for. [-]"""
SIGMAS = 2.0
"""A current is taken to ask for any force within this of the predicted one. [-]"""
APPROACH = 8e-3
"""As in the shipped profiles. [A/s]"""
RAMP = 1.5e-3
"""As for a raw egg. [A/s]"""


def assumed_profile(
    diameter: float, *, current: float | None, force: float | None, chain: Chain
) -> Profile:
    """Make up a profile around a target; one of `current` and `force` is given.

    Parameters
    ----------
    diameter
        Size of the object. [m]
    current
        Valve current asked for. [A]
    force
        Grip force per jaw asked for. [N]
    chain
        The model of the gripper.

    Raises
    ------
    DomainError
        When the object does not fit between the jaws.
    """
    pressed = PressedObject(diameter, STIFFNESS)
    chain.check_fits(diameter)
    if force is None:
        prediction = chain.predict(current or 0.0, pressed)
        bearable = prediction.grip_force + SIGMAS * prediction.grip_std
        force = prediction.grip_force
    else:
        bearable = force
    mode = Mode.FORCE if current is None else Mode.CURRENT
    tolerance = max(SIZE_SHARE * diameter, min(SIZE_LEAST, diameter / 2))
    return Profile(
        name=NAME,
        version=VERSION,
        diameter=diameter,
        smaller=tolerance,
        larger=tolerance,
        mass=DENSITY * pi / 6 * diameter**3,
        stiffness=STIFFNESS,
        pad_friction=FRICTION,
        acceleration=ACCELERATION,
        damage_force=DAMAGE_FACTOR * bearable,
        source=SOURCE,
        slip_margin=SLIP_MARGIN,
        crush_margin=CRUSH_MARGIN,
        mode=mode,
        current=chain.current_for(force, pressed) if current is None else current,
        force=force,
        approach=APPROACH,
        ramp=RAMP,
    )


def unnamed_held(opening: float | None, strongest: float, chain: Chain) -> Held | None:
    """Make up what is held from how it is held; None without an opening.

    It may weigh anything. Who closed the jaws on it wanted the slip margin at least, so
    it is as heavy as the highest force allows.

    Parameters
    ----------
    opening
        Of the jaws now. [m]
    strongest
        Highest force per jaw so far. [N]
    chain
        The model of the gripper.

    Raises
    ------
    DomainError
        When the model has no answer there.
    """
    if opening is None:
        return None
    size = opening + strongest / STIFFNESS
    profile = assumed_profile(size, current=None, force=strongest, chain=chain)
    carried = 2 * FRICTION * strongest / SLIP_MARGIN
    mass = carried / (STANDARD_GRAVITY + ACCELERATION)
    return Held(profile=replace(profile, mass=mass), size=size)
