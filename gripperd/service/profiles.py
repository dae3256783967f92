"""Profiles: read, make, change, and try out without moving."""

# ruff: noqa: N815  (names carry units, and units have capitals)

from collections.abc import Sequence
from typing import Annotated, Any

from fastapi import Body, Header, Response
from pydantic import Field

from gripperd.config import parse_profile, profile_document
from gripperd.config.profile import ProfileSection
from gripperd.control.evaluation import Evaluation, evaluate
from gripperd.control.profile import Mode, Profile
from gripperd.errors import InputError, Refused
from gripperd.service.body import router
from gripperd.service.context import Context, Daemon
from gripperd.service.library import tag_of
from gripperd.service.rendering import GIVEN, Document, ratio, to
from gripperd.service.target import Target, order_for

routes = router("profiles")

BY_SERVICE = frozenset({"version", "read_only"})
"""Keys of a profile that the service writes; in a request they mean nothing."""

IfMatch = Annotated[
    list[str] | None, Header(description="The ETag of the version you read.")
]
GivenProfile = Annotated[
    dict[str, Any], Body(description="A profile; its version is the service's to give.")
]
PROFILE_BODY = {
    "requestBody": {
        "required": True,
        "content": {
            "application/json": {
                "schema": {"$ref": "#/components/schemas/ProfileDocument"}
            }
        },
    }
}


class ProfileDocument(ProfileSection):
    """An object's size, weight and limits, and how to grasp it."""

    read_only: bool = False
    """An original: copy it to change it."""


class Profiles(Document):
    """Every profile there is."""

    profiles: tuple[ProfileDocument, ...]


class EvaluationRequest(Target):
    """What is to be different from the profile."""

    gripper: str | None = Field(default=None, description="By default the first.")


class EvaluationDocument(Document):
    """A dry run of a grasp."""

    gripper: str
    model: str
    profile: str
    profile_version: int
    feasible: bool
    reasons: tuple[str, ...] = Field(description="Why not.")
    mode: Mode
    current_mA: float = Field(description="Valve current the grasp would end at.")
    pressure_kPa: float
    opening_mm: float
    force_N: float = Field(description="Predicted grip force per jaw.")
    std_N: float = Field(description="Its standard deviation.")
    slip_force_N: float = Field(description="Under this it slips.")
    damage_force_N: float = Field(description="Over this it is damaged.")
    slip_margin: float | None = Field(description="Force over the slip limit.")
    crush_margin: float | None = Field(description="Damage limit over the force.")
    reaches: bool
    extrapolated: bool


@routes.get("/profiles")
async def list_profiles(daemon: Daemon) -> Profiles:
    """Every profile."""
    found = daemon.library.all()
    return Profiles(profiles=tuple(_document(profile, daemon) for profile in found))


@routes.post("/profiles", status_code=201, openapi_extra=PROFILE_BODY)
async def make_profile(
    daemon: Daemon, given: GivenProfile, response: Response
) -> ProfileDocument:
    """Make a new profile."""
    async with daemon.library.changing:
        profile = _parsed(given, str(given.get("name")), daemon)
        if profile.name in daemon.library:
            message = f"there is a profile {profile.name} already"
            hints = (f"PUT /v1/profiles/{profile.name} changes it",)
            raise Refused(message, code="already-exists", hints=hints)
        return await _saved(profile, daemon, response)


@routes.get("/profiles/{profile}")
async def read_profile(
    daemon: Daemon, profile: str, response: Response
) -> ProfileDocument:
    """One profile, with its ETag."""
    found = daemon.library.get(profile)
    response.headers["etag"] = tag_of(found)
    return _document(found, daemon)


@routes.put("/profiles/{profile}", openapi_extra=PROFILE_BODY)
async def save_profile(
    daemon: Daemon,
    profile: str,
    given: GivenProfile,
    response: Response,
    if_match: IfMatch = None,
) -> ProfileDocument:
    """Save a profile as its next version, or as a new one."""
    async with daemon.library.changing:
        new = profile not in daemon.library
        _check_seen(profile, if_match, daemon)
        named = given.setdefault("name", profile)
        if named != profile:
            message = f"the body names {named!r}, the path {profile!r}"
            raise InputError(message, key="name")
        if new:
            response.status_code = 201
        return await _saved(_parsed(given, profile, daemon), daemon, response)


@routes.delete("/profiles/{profile}", status_code=204)
async def remove_profile(
    daemon: Daemon, profile: str, if_match: IfMatch = None
) -> None:
    """Forget a profile."""
    async with daemon.library.changing:
        found = daemon.library.get(profile)
        daemon.library.check_changeable(profile)
        _check_unchanged(found, if_match)
        await daemon.library.remove(profile)


@routes.post("/profiles/{profile}/evaluate")
async def evaluate_profile(
    daemon: Daemon, profile: str, target: EvaluationRequest | None = None
) -> EvaluationDocument:
    """Say what a grasp would do, and whether it may; nothing moves."""
    daemon.library.get(profile)
    target = target or EvaluationRequest()
    gripper = await daemon.up_to_date(daemon.chosen_gripper(target.gripper))
    order = order_for(profile, target, gripper.chain, daemon.library)
    evaluation = evaluate(order, gripper.chain)
    return EvaluationDocument(
        gripper=gripper.name,
        model=order.model,
        profile=profile,
        profile_version=order.profile.version,
        mode=order.mode,
        **_numbers(evaluation),
    )


def _numbers(evaluation: Evaluation) -> dict[str, Any]:
    prediction = evaluation.prediction
    return {
        "feasible": evaluation.feasible,
        "reasons": evaluation.reasons,
        "current_mA": to("mA", evaluation.current, GIVEN),
        "pressure_kPa": to("kPa", prediction.pressure),
        "opening_mm": to("mm", prediction.opening),
        "force_N": to("N", prediction.grip_force),
        "std_N": to("N", prediction.grip_std),
        "slip_force_N": to("N", evaluation.slip_force),
        "damage_force_N": to("N", evaluation.damage_force),
        "slip_margin": ratio(evaluation.slip_margin),
        "crush_margin": ratio(evaluation.crush_margin),
        "reaches": prediction.reaches,
        "extrapolated": prediction.extrapolated,
    }


def _document(profile: Profile, daemon: Context) -> ProfileDocument:
    return ProfileDocument.model_validate(
        {
            **profile_document(profile),
            "read_only": daemon.library.read_only(profile.name),
        }
    )


def _parsed(given: dict[str, Any], name: str, daemon: Context) -> Profile:
    content = {key: value for key, value in given.items() if key not in BY_SERVICE}
    return parse_profile(content | {"version": daemon.library.next_version(name)})


async def _saved(
    profile: Profile, daemon: Context, response: Response
) -> ProfileDocument:
    await daemon.library.save(profile)
    response.headers["etag"] = tag_of(profile)
    response.headers["location"] = f"/v1/profiles/{profile.name}"
    return _document(profile, daemon)


def _check_seen(name: str, if_match: Sequence[str] | None, daemon: Context) -> None:
    """Refuse to change an original, or what the client has not seen."""
    if name in daemon.library:
        daemon.library.check_changeable(name)
        _check_unchanged(daemon.library.get(name), if_match)
    elif if_match:
        message = f"there is no profile {name} whose version could match"
        raise Refused(message, code="changed-since")


def _check_unchanged(profile: Profile, if_match: Sequence[str] | None) -> None:
    """Refuse to overwrite what the client has not seen (RFC 9110, 13.1.1)."""
    tag = tag_of(profile)
    if not if_match:
        message = f"changing {profile.name} needs the header If-Match with its ETag"
        hints = (f"it is {tag} now; GET it first", "If-Match: * takes any version")
        raise Refused(message, code="if-match-required", hints=hints)
    given = {part.strip() for header in if_match for part in header.split(",")}
    if given.isdisjoint({"*", tag}):
        message = f"{profile.name} is {tag} now, not {', '.join(sorted(given))[:200]}"
        raise Refused(message, code="changed-since", hints=("GET it again",))
