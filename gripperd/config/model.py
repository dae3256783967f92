"""Model files: muscle, valve, gripper and effects, to a chain in SI."""

# ruff: noqa: N815  (names carry units, and units have capitals)

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import cast

from pydantic import Field, ValidationInfo, field_validator

from gripperd.config.complaint import Complaint, KeyPath
from gripperd.config.document import Document, read_document
from gripperd.config.effect import Effects, Library, keys_of_effect
from gripperd.config.lineage import Lineage
from gripperd.config.location import shipped
from gripperd.config.number import factor_of
from gripperd.config.sealed import check_seal
from gripperd.config.section import (
    ENDS,
    Kilopascals,
    Milliamperes,
    Name,
    Rising,
    Section,
    key_of,
    numbers,
)
from gripperd.config.tolerance import Sigmas, moved, without_tolerances
from gripperd.config.validation import validated
from gripperd.diagnose.residuals.explanation import Explanation
from gripperd.effects import EFFECTS
from gripperd.errors import ConfigError
from gripperd.model import (
    Chain,
    Linkage,
    Muscle,
    Regulator,
    StaticMuscle,
)
from gripperd.model.effect import Effect, acts_in_muscle
from gripperd.model.parameter import parameters
from gripperd.units import split


class MuscleSection(Section):
    """Constants of the muscle, within what could be made."""

    rest_length_mm: float = Field(ge=10, le=10_000)
    diameter_mm: float = Field(ge=1, le=200)
    # From 54.7 deg on the ideal muscle pushes.
    braid_angle_deg: float = Field(ge=5, le=54)
    wall_thickness_mm: float = Field(gt=0, le=50)
    elastic_modulus_MPa: float = Field(gt=0, le=1000)
    friction_coefficient: float = Field(ge=0, le=2)

    @field_validator("wall_thickness_mm")
    @classmethod
    def _leave_a_bore(cls, wall: float, read: ValidationInfo) -> float:
        diameter = read.data.get("diameter_mm")
        if diameter is not None and 2 * wall >= diameter:
            message = f"two walls of {wall:g} mm leave no bore in {diameter:g} mm"
            raise ValueError(message)
        return wall


class ValveSection(Section):
    """Two points of the regulator's line."""

    current_mA: Rising[Milliamperes]
    pressure_kPa: Rising[Kilopascals]


class GripperSection(Section):
    """Linkage and return spring."""

    open_width_mm: float = Field(gt=0, le=1000)
    ratio: float = Field(ge=0.01, le=100, alias="width_per_contraction")
    spring_preload_N: float = Field(ge=0, le=100_000)
    spring_rate_N_per_mm: float = Field(ge=0, le=10_000)


class ModelSection(Section):
    """The whole file."""

    name: Name
    muscle: MuscleSection
    valve: ValveSection | None = None
    gripper: GripperSection | None = None
    effects: Effects = ()


class VersionSection(Lineage, ModelSection):
    """The file of a version: a model file that says where it comes from."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ModelFile:
    """A model as a file has it: perhaps only a muscle."""

    name: str
    static: StaticMuscle
    """The muscle, with the effects that act in it."""
    regulator: Regulator | None
    linkage: Linkage | None
    effects: tuple[Effect, ...] = ()
    """Those that act elsewhere."""
    tolerances: Mapping[str, float]
    """One sigma by path, as in :class:`gripperd.model.Chain`. [SI]"""
    lineage: Lineage | None = None
    """Where it comes from; None for a model that a person wrote."""
    source: str = field(compare=False)
    """The file it came from."""

    def explanation(self) -> Explanation:
        """Give what a diagnosis starts from: the model at its nominal constants."""
        return Explanation(
            muscle=self.static.muscle,
            regulator=self.regulator,
            linkage=self.linkage,
            effects=(*cast("tuple[Effect, ...]", self.static.effects), *self.effects),
        )

    def chain(self) -> Chain:
        """Build the chain from valve current to grip force.

        Raises
        ------
        ConfigError
            When the file has no valve or no gripper.
        """
        if self.regulator is None or self.linkage is None:
            parts = {"valve": self.regulator, "gripper": self.linkage}
            raise ConfigError(
                *(
                    Complaint(
                        "is missing; without it a current gives no grip force",
                        source=self.source,
                        path=(key,),
                    )
                    for key, part in parts.items()
                    if part is None
                )
            )
        return Chain(
            self.name,
            self.static,
            self.regulator,
            self.linkage,
            self.tolerances,
            effects=self.effects,
        )


def load_model(path: Path, effects: Mapping[str, type[Effect]] = EFFECTS) -> ModelFile:
    """Read a model file.

    Parameters
    ----------
    path
        The file; its format is that of the shipped ``models/reference.yaml``.
    effects
        Effects the file may name.

    Raises
    ------
    ConfigError
        With everything that is wrong with it, or it is not as it was written.
    """
    document, sigmas = without_tolerances(read_document(path))
    check_seal(path, needed=False)
    section = validated(_schema(document), document, Library(document, effects))
    _check_ends(document, sigmas, effects)
    in_muscle = tuple(filter(acts_in_muscle, section.effects))
    elsewhere = (each for each in section.effects if not acts_in_muscle(each))
    return ModelFile(
        name=section.name,
        static=StaticMuscle(Muscle(**numbers(section.muscle)), in_muscle),
        regulator=Regulator(**numbers(section.valve)) if section.valve else None,
        linkage=Linkage(**numbers(section.gripper)) if section.gripper else None,
        effects=tuple(elsewhere),
        tolerances=_constants(section, sigmas),
        lineage=_lineage(section),
        source=str(path),
    )


def load_chain(path: Path) -> Chain:
    """Read a model file that has all parts.

    Raises
    ------
    ConfigError
        With everything that is wrong with it, or missing.
    """
    return load_model(path).chain()


def reference_chain() -> Chain:
    """Give the shipped reference rig."""
    return load_chain(shipped("models/reference.yaml"))


def _schema(document: Document) -> type[ModelSection]:
    value = document.value
    is_version = isinstance(value, dict) and "version" in value
    return VersionSection if is_version else ModelSection


def _lineage(section: ModelSection) -> Lineage | None:
    if not isinstance(section, VersionSection):
        return None
    return Lineage(**{name: getattr(section, name) for name in Lineage.model_fields})


def _check_ends(
    document: Document, sigmas: Sigmas, effects: Mapping[str, type[Effect]]
) -> None:
    """Refuse a tolerance of which one sigma is already impossible."""
    for by, word in ((1, "plus"), (-1, "minus")):
        end = moved(document, sigmas, by)
        try:
            validated(_schema(end), end, Library(end, effects))
        except ConfigError as refused:
            raise ConfigError(
                *(
                    end.complaint(said.path, f"{word} its tolerance, {said.detail}")
                    for said in refused.complaints
                    if isinstance(said, Complaint)
                )
            ) from None


def _constants(section: ModelSection, sigmas: Sigmas) -> dict[str, float]:
    return dict(_constant(section, path, sigmas[path]) for path in sigmas)


def _constant(section: ModelSection, path: KeyPath, sigma: float) -> tuple[str, float]:
    """Path in a chain and sigma in SI, of a number of a file that passed the schema.

    ``("valve", "pressure_kPa", 1)`` gives ``valve.pressure_high``.
    """
    part, step, *rest = path
    if part == "effects":
        effect = section.effects[int(step)]
        names = {key: name for name, key in keys_of_effect(effect).items()}
        name = names[str(rest[0])]
        unit = parameters(effect)[name].unit
        return f"effects.{effect.name}.{name}", sigma * factor_of(unit)
    schema = type(getattr(section, str(part)))
    fields = {key_of(schema, each): each for each in schema.model_fields}
    name, unit = split(fields[str(step)])
    ends = (ENDS[int(end)] for end in rest)
    return "_".join([f"{part}.{name}", *ends]), sigma * factor_of(unit)
