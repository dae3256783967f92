"""One constant of a model, moved."""

from dataclasses import replace
from typing import TYPE_CHECKING, TypeVar

from gripperd.model.effect import Effect, StaticEffect

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

Part = TypeVar("Part", bound="DataclassInstance")
AnyEffect = TypeVar("AnyEffect", StaticEffect, Effect)


def moved(part: Part, constant: str, by: float) -> Part:
    """Build the same part with one constant moved. [SI]."""
    return replace(part, **{constant: getattr(part, constant) + by})


def moved_among(
    effects: tuple[AnyEffect, ...], path: str, by: float
) -> tuple[AnyEffect, ...]:
    """Build the same effects with the constant ``effects.<name>.<field>`` moved."""
    owner, _, constant = path.rpartition(".")
    return tuple(
        moved(each, constant, by) if owner == f"effects.{each.name}" else each
        for each in effects
    )
