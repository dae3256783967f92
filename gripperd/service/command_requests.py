"""What clients can ask of a gripper, as they write it."""

# ruff: noqa: N815  (names carry units, and units have capitals)

from collections.abc import Mapping
from typing import Annotated, Literal, Self

from fastapi import Body
from pydantic import Field, model_validator

from gripperd.config.section import Section
from gripperd.control.profile import Profile
from gripperd.control.task import Adjust, Adopt, Move, SelfTest, Tare, Task, Vent
from gripperd.errors import InputError, NotFound
from gripperd.model import Chain
from gripperd.service.body import disagreement
from gripperd.service.library import ProfileLibrary
from gripperd.service.target import (
    Milliamperes,
    Newtons,
    Target,
    check_current,
)
from gripperd.units import MILLI

DEFAULT_DEADLINE = 15.0
"""[s]"""

Seconds = Annotated[float, Field(ge=0.1, le=120)]


class Params(Section):
    """What every command has."""

    deadline_s: Seconds = Field(
        default=DEFAULT_DEADLINE,
        description="The command is over by then, come what may.",
    )


class GraspParams(Target, Params):
    """What to grasp: a profile, or a size with a force or current."""

    profile: str | None = None


class AdjustParams(Params):
    """How hard to hold what is held; with neither value as its profile says."""

    force_N: Newtons | None = None
    current_mA: Milliamperes | None = Field(
        default=None, description="Kept as it is; nothing is corrected any more."
    )

    @model_validator(mode="after")
    def _agree(self) -> Self:
        if self.force_N is not None and self.current_mA is not None:
            message = "give current_mA or force_N, not both"
            raise disagreement(message)
        return self


class HoldParams(Params):
    """Whose limits apply to what is held already."""

    profile: str | None = Field(default=None, description="Needed.")


class MoveParams(Params):
    """Where the empty jaws are to stand."""

    opening_mm: Annotated[float, Field(ge=0, le=1000)] | None = Field(
        default=None, description="Needed."
    )


class InEitherPlace(Section):
    """Params stand beside the type or in an object of their own."""

    @model_validator(mode="after")
    def _in_one_place(self) -> Self:
        given = self.model_fields_set - {"type"}
        if getattr(self, "params", None) is not None and given != {"params"}:
            message = "values stand in params or beside the type, not in both"
            raise disagreement(message)
        return self


class GraspRequest(GraspParams, InEitherPlace):
    """Close the jaws on an object."""

    type: Literal["grasp"]
    params: GraspParams | None = None


class ReleaseRequest(Params, InEitherPlace):
    """Open the jaws."""

    type: Literal["release"]
    params: Params | None = None


class AdjustRequest(AdjustParams, InEitherPlace):
    """Hold what is held harder or lighter, without letting go."""

    type: Literal["adjust"]
    params: AdjustParams | None = None


class HoldRequest(HoldParams, InEitherPlace):
    """Take over what is held already, under a profile; nothing moves."""

    type: Literal["hold"]
    params: HoldParams | None = None


class MoveRequest(MoveParams, InEitherPlace):
    """Bring the empty jaws to an opening."""

    type: Literal["move"]
    params: MoveParams | None = None


class PlainRequest(Params, InEitherPlace):
    """Vent: let all the air out at once, whatever is held. Tare: take what the unloaded
    force sensor shows for zero. Self-test: try valve, air and sensors, the jaws empty.
    """  # noqa: D205

    type: Literal["vent", "tare", "self_test"]
    params: Params | None = None


CommandRequest = Annotated[
    GraspRequest
    | ReleaseRequest
    | AdjustRequest
    | HoldRequest
    | MoveRequest
    | PlainRequest,
    Field(discriminator="type"),
    Body(
        openapi_examples={
            "grasp": {"value": {"type": "grasp", "profile": "raw_egg"}},
            "release": {"value": {"type": "release"}},
            "adjust": {"value": {"type": "adjust", "force_N": 15}},
            "hold": {"value": {"type": "hold", "profile": "raw_egg"}},
            "move": {"value": {"type": "move", "opening_mm": 60}},
            "vent": {"value": {"type": "vent"}},
            "tare": {"value": {"type": "tare"}},
            "self_test": {"value": {"type": "self_test"}},
        }
    ),
]

PLAIN: Mapping[str, type[Vent | Tare | SelfTest]] = {
    "vent": Vent,
    "tare": Tare,
    "self_test": SelfTest,
}
"""Tasks that need nothing more to be said."""


def task_for(
    asked: AdjustRequest | HoldRequest | MoveRequest | PlainRequest,
    chain: Chain,
    library: ProfileLibrary,
) -> Task:
    """Resolve what a client wants to a task in SI.

    Raises
    ------
    InputError
        Too little is given, there is no such profile, or the valve cannot do it.
    """
    params = asked.params or asked
    if isinstance(params, AdjustParams):
        check_current(params.current_mA, chain)
        current = params.current_mA
        return Adjust(
            force=params.force_N, current=None if current is None else current * MILLI
        )
    if isinstance(params, HoldParams):
        return Adopt(profile=_profile(params.profile, library))
    if isinstance(params, MoveParams):
        if params.opening_mm is None:
            message = "say where to: opening_mm"
            raise InputError(message, key="opening_mm")
        return Move(opening=params.opening_mm * MILLI)
    assert isinstance(asked, PlainRequest)
    return PLAIN[asked.type]()


def _profile(name: str | None, library: ProfileLibrary) -> Profile:
    if name is None:
        message = "name the profile whose limits apply"
        raise InputError(message, key="profile")
    try:
        return library.get(name)
    except NotFound as error:
        raise InputError(str(error), key="profile") from error
