"""What clients can ask for besides a grasp and a release, and what comes of it.

They are structs, not dataclasses, because a message tells them apart by their tag.
"""

from typing import TypeAlias

from msgspec import Struct

from gripperd.control.profile import Profile
from gripperd.signals import Quality


class Adjust(Struct, frozen=True, kw_only=True, tag="adjust"):
    """Hold what is held harder or lighter; with neither value as its profile says."""

    force: float | None = None
    """Grip force per jaw. [N]"""
    current: float | None = None
    """Valve current, to be kept as it is. [A]"""


class Adopt(Struct, frozen=True, kw_only=True, tag="hold"):
    """Take over what is held already, under the limits of a profile; nothing moves."""

    profile: Profile


class Move(Struct, frozen=True, kw_only=True, tag="move"):
    """Bring the empty jaws to an opening."""

    opening: float
    """[m]"""


class Vent(Struct, frozen=True, kw_only=True, tag="vent"):
    """Let all the air out at once, whatever is held."""


class Tare(Struct, frozen=True, kw_only=True, tag="tare"):
    """Take what the unloaded force sensor shows for zero."""


class SelfTest(Struct, frozen=True, kw_only=True, tag="self_test"):
    """Try valve, air and sensors by a small step of the pressure, the jaws empty."""


Task: TypeAlias = Adjust | Adopt | Move | Vent | Tare | SelfTest


class Moved(Struct, frozen=True, kw_only=True, tag="moved"):
    """Where the jaws came to rest. SI values, None where unknown."""

    opening: float | None
    """[m]"""
    error: float | None
    """From the opening that was asked for. [m]"""
    current: float
    """[A]"""


class Tared(Struct, frozen=True, kw_only=True, tag="tared"):
    """The zero of the force sensor."""

    zero: float
    """What it shows without a load, per jaw. [N]"""
    noise: float
    """One sigma. [N]"""


class Checked(Struct, frozen=True, kw_only=True, tag="checked"):
    """What the self-test measured. SI values, None where no sensor tells it."""

    valve_error: float | None
    """Pressure less what was asked for, once settled. [Pa]"""
    rise_time: float | None
    """To 63 % of the step. [s]"""
    droop: float | None
    """Fall of the pressure per second while the current stands still. [Pa/s]"""
    pressure_noise: float | None
    """One sigma. [Pa]"""
    force_noise: float | None
    """One sigma. [N]"""
    force_quality: Quality


Finding: TypeAlias = Moved | Tared | Checked
