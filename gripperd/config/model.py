"""Model files: muscle, valve, gripper and effects, to a chain in SI."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import cast

from gripperd.config.complaint import Complaint, KeyPath
from gripperd.config.correlation import correlations
from gripperd.config.document import Document, read_document
from gripperd.config.effect import AnyEffect, Effects, Library, keys_of_effect
from gripperd.config.lineage import Lineage
from gripperd.config.location import shipped
from gripperd.config.model_parts import GripperSection, MuscleSection, ValveSection
from gripperd.config.number import factor_of
from gripperd.config.sealed import check_seal
from gripperd.config.section import ENDS, Name, Section, key_of, numbers
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

    @property
    def correlations(self) -> Mapping[tuple[str, str], float]:
        """How numbers that were fitted together go together, as a chain has it."""
        fitted = self.lineage and self.lineage.provenance.covariance
        effects: tuple[AnyEffect, ...] = (*self.static.effects, *self.effects)
        return correlations(fitted, effects) if fitted else {}

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
            correlations=self.correlations,
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
