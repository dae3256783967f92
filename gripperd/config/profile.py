"""Profiles of objects, as files and as requests have them."""

# ruff: noqa: N815  (names carry units, and units have capitals)

from collections.abc import Mapping, MutableSequence
from pathlib import Path
from typing import Annotated

from pydantic import Field, ValidationInfo, field_validator

from gripperd.config.complaint import Complaint, gathering
from gripperd.config.document import Document, read_document
from gripperd.config.section import Name, Section, numbers, plain
from gripperd.config.validation import validated
from gripperd.control.grasp import TRIP_MARGIN
from gripperd.control.profile import Mode, Profile
from gripperd.errors import ConfigError

LEAST_CRUSH_MARGIN = 1.2
"""What a grasp aims at must leave room for noise below what ends it."""


class SizeSection(Section):
    """How far the size may be off; the unit is in the key of the section."""

    smaller: float = Field(ge=0, le=1000)
    larger: float = Field(ge=0, le=1000)


class LimitsSection(Section):
    """What the object bears."""

    damage_force_N: float = Field(gt=0, le=100_000, alias="damage_N")
    source: str = Field(min_length=1, max_length=1000)


class MarginsSection(Section):
    """Factors to keep to both limits."""

    slip_margin: float = Field(ge=1, le=100, alias="slip")
    crush_margin: float = Field(le=100, alias="crush")

    @field_validator("crush_margin")
    @classmethod
    def _leave_room(cls, margin: float) -> float:
        if margin < LEAST_CRUSH_MARGIN:
            message = (
                f"{margin:g} is below {LEAST_CRUSH_MARGIN:g}; a grasp is broken off at"
                f" {TRIP_MARGIN:g} and could not get there"
            )
            raise ValueError(message)
        return margin


class GraspSection(Section):
    """How to grasp it."""

    mode: Annotated[Mode, Field(strict=False)]
    current_mA: float = Field(ge=0, le=24)
    force_N: float = Field(gt=0, le=100_000)
    approach_mA_per_s: float = Field(gt=0, le=1000)
    ramp_mA_per_s: float = Field(gt=0, le=1000)


class HoldSection(Section):
    """What may be done about the force while it is held."""

    compensate: bool = False
    most_correction_percent: float = Field(
        default=10.0, gt=0, le=20, alias="most_percent"
    )


UNCORRECTED = HoldSection().model_dump(by_alias=True)
"""What a file that says nothing of it means; so written profiles say nothing either."""


class TighterSection(Section):
    """What is watched more closely than the settings of the gripper say."""

    slip_closing_mm: float | None = Field(default=None, gt=0, le=20)
    force_drift_percent: float | None = Field(default=None, gt=0, le=100)


UNTIGHTENED = TighterSection().model_dump()
"""What a file that says nothing of it means."""


class ProfileSection(Section):
    """The whole file."""

    name: Name
    version: int = Field(ge=1, le=1_000_000)
    diameter_mm: float = Field(gt=0, le=1000)
    size_tolerance_mm: SizeSection
    mass_g: float = Field(gt=0, le=100_000)
    stiffness_N_per_mm: float = Field(gt=0, le=100_000)
    pad_friction: float = Field(gt=0, le=5)
    acceleration_m_per_s2: float = Field(ge=0, le=1000)
    limits: LimitsSection
    margins: MarginsSection
    grasp: GraspSection
    hold: HoldSection = HoldSection()
    monitors: TighterSection = TighterSection()

    @field_validator("size_tolerance_mm")
    @classmethod
    def _leave_something(cls, size: SizeSection, read: ValidationInfo) -> SizeSection:
        diameter = read.data.get("diameter_mm")
        if diameter is not None and size.smaller >= diameter:
            message = (
                f"{size.smaller:g} mm smaller leaves nothing of {diameter:g} mm to hold"
            )
            raise ValueError(message)
        return size


def parse_profile(mapping: object) -> Profile:
    """Build a profile from the plain values of a request.

    Raises
    ------
    ConfigError
        With everything that is wrong; each complaint has a JSON pointer.
    """
    return _profile(Document(mapping))


def load_profile(path: Path) -> Profile:
    """Read the profile of one object.

    Raises
    ------
    ConfigError
        With everything that is wrong with the file.
    """
    return _profile(read_document(path))


def load_profiles(folder: Path) -> Mapping[str, Profile]:
    """Read every profile of a folder; a file is named after the profile in it.

    Raises
    ------
    ConfigError
        With everything that is wrong with any of them.
    """
    if not folder.is_dir():
        raise ConfigError(Complaint("there is no such folder", source=str(folder)))
    complaints: list[str] = []
    profiles = readable_profiles(folder, complaints)
    if complaints:
        raise ConfigError(*complaints)
    return profiles


def readable_profiles(
    folder: Path, complaints: MutableSequence[str]
) -> Mapping[str, Profile]:
    """Read what can be read of a folder; complain about the rest."""
    profiles: dict[str, Profile] = {}
    for path in sorted(folder.glob("[!.]*.y*ml")):
        with gathering(complaints):
            profiles[path.stem] = _named_after(path)
    return profiles


def profile_document(profile: Profile) -> dict[str, object]:
    """Write a profile the way files and requests have it, units restored."""
    written = plain(ProfileSection, profile)
    if written["hold"] == UNCORRECTED:
        del written["hold"]
    if written["monitors"] == UNTIGHTENED:
        del written["monitors"]
    return written


def _profile(document: Document) -> Profile:
    section = validated(ProfileSection, document)
    return Profile(
        name=section.name,
        version=section.version,
        source=section.limits.source,
        mode=section.grasp.mode,
        compensate=section.hold.compensate,
        **numbers(section),
    )


def _named_after(path: Path) -> Profile:
    document = read_document(path)
    profile = _profile(document)
    if path.name != f"{profile.name}.yaml":
        detail = f'the profile "{profile.name}" belongs in a file {profile.name}.yaml'
        raise ConfigError(document.complaint(("name",), detail))
    return profile
