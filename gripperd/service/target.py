"""What a client wants of a grasp, and the order that comes of it."""

# ruff: noqa: N815  (names carry units, and units have capitals)

from dataclasses import replace
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from gripperd.config.section import Section
from gripperd.control.command import GraspOrder
from gripperd.control.profile import Mode, Profile
from gripperd.errors import DomainError, InputError, NotFound
from gripperd.model import Chain
from gripperd.service.assumption import assumed_profile
from gripperd.service.body import disagreement
from gripperd.service.library import ProfileLibrary
from gripperd.units import MILLI

Milliamperes = Annotated[float, Field(ge=0, le=1000)]
Newtons = Annotated[float, Field(gt=0, le=100_000, description="Per jaw.")]
Millimetres = Annotated[float, Field(gt=0, le=1000)]
ENOUGH = "name a profile, or give diameter_mm with either force_N or current_mA"


class Target(Section):
    """What a grasp aims at; what is left out is as the profile says."""

    mode: Literal["current", "force"] | None = None
    current_mA: Milliamperes | None = Field(
        default=None, description="Implies mode current."
    )
    force_N: Newtons | None = Field(default=None, description="Implies mode force.")
    diameter_mm: Millimetres | None = Field(
        default=None, description="Size of the object, instead of the profile's."
    )

    @model_validator(mode="after")
    def _agree(self) -> Self:
        if self.current_mA is not None and self.force_N is not None:
            message = "give current_mA or force_N, not both"
            raise disagreement(message)
        if self.implied and self.mode and self.mode != self.implied:
            given = "current_mA" if self.implied == "current" else "force_N"
            message = (
                f"mode {self.mode} contradicts {given}, which means mode {self.implied}"
            )
            raise disagreement(message)
        return self

    @property
    def implied(self) -> str | None:
        """The mode that the given target means."""
        if self.current_mA is not None:
            return "current"
        return "force" if self.force_N is not None else None


def order_for(
    name: str | None, target: Target, chain: Chain, library: ProfileLibrary
) -> GraspOrder:
    """Resolve what a client wants to an order in SI.

    Parameters
    ----------
    name
        The profile; None to go by the target alone.
    target
        What is to be different from the profile.
    chain
        The model of the gripper.
    library
        The profiles.

    Raises
    ------
    InputError
        There is no such profile, too little is given, or the valve cannot do it.
    """
    check_current(target.current_mA, chain)
    if name is None:
        return _order(_assumed(target, chain), target, chain)
    try:
        profile = library.get(name)
    except NotFound as error:
        raise InputError(str(error), key="profile") from error
    if target.diameter_mm is not None:
        profile = replace(profile, diameter=target.diameter_mm * MILLI)
    return _order(profile, target, chain)


def check_current(current_mA: float | None, chain: Chain) -> None:  # noqa: N803
    """Refuse a current that the valve does not follow.

    Raises
    ------
    InputError
        With the limits.
    """
    low, high = (
        chain.regulator.current_low / MILLI,
        chain.regulator.current_high / MILLI,
    )
    if current_mA is not None and not low <= current_mA <= high:
        message = (
            f"{current_mA:g} mA is outside {low:g} to {high:g} mA, the valve's range"
        )
        raise InputError(message, key="current_mA")


def _order(profile: Profile, target: Target, chain: Chain) -> GraspOrder:
    mode = Mode(target.implied or target.mode or profile.mode)
    aim = profile.current if mode is Mode.CURRENT else profile.force
    if target.current_mA is not None:
        aim = target.current_mA * MILLI
    elif target.force_N is not None:
        aim = target.force_N
    return GraspOrder(profile=profile, mode=mode, target=aim, model=chain.name)


def _assumed(target: Target, chain: Chain) -> Profile:
    if target.diameter_mm is None or target.implied is None:
        raise InputError(ENOUGH, key="profile")
    try:
        return assumed_profile(
            target.diameter_mm * MILLI,
            current=None if target.current_mA is None else target.current_mA * MILLI,
            force=target.force_N,
            chain=chain,
        )
    except DomainError as error:
        raise InputError(str(error), key="diameter_mm") from error
