"""What differs between two versions of a model."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import chain
from typing import TypeAlias

from gripperd.config import ModelFile
from gripperd.config.model_text import model_document

Value: TypeAlias = float | str | None

PRESENT = "present"
"""Value of an effect itself, beside those of its parameters."""


@dataclass(frozen=True, slots=True)
class Change:
    """One number, or one effect, that is another."""

    path: str
    """Such as ``muscle.diameter_mm`` or ``effects.creep.fast``."""
    before: Value
    """In the unit of the key; None where there was none."""
    after: Value


def difference(before: ModelFile, after: ModelFile) -> tuple[Change, ...]:
    """Every constant, tolerance and effect that differs, in the order of the file.

    A fitted parameter that one sigma would take past a bound has no tolerance. What is
    known of it stands as ``.std``, from where the model says that it comes from.
    """
    old, new = _values(before), _values(after)
    return tuple(
        Change(path, old.get(path), new.get(path))
        for path in dict.fromkeys([*old, *new])
        if old.get(path) != new.get(path)
    )


def _values(model: ModelFile) -> dict[str, Value]:
    document = model_document(model)
    parts = {part: document.get(part) for part in ("muscle", "valve", "gripper")}
    values = dict(chain(_flat("", parts), _effects(document["effects"])))
    return values | dict(_untold(model, values))


def _untold(model: ModelFile, told: Mapping[str, Value]) -> Iterator[tuple[str, Value]]:
    """Standard deviations of parameters that have no tolerance."""
    named = model.lineage.provenance.effects if model.lineage else ()
    for effect in named:
        for key, std in effect.std.items():
            path = f"effects.{effect.name}.{key}"
            if std > 0 and path in told and f"{path}.tolerance" not in told:
                yield f"{path}.std", std


def _effects(listed: object) -> Iterator[tuple[str, Value]]:
    assert isinstance(listed, list)
    for entry in listed:
        parameters = dict(entry) if isinstance(entry, dict) else {"name": entry}
        path = f"effects.{parameters.pop('name')}"
        yield path, PRESENT
        yield from _flat(f"{path}.", parameters)


def _flat(prefix: str, values: Mapping[str, object]) -> Iterator[tuple[str, Value]]:
    for key, value in values.items():
        path = f"{prefix}{key}"
        match value:
            case {"value": known, "tolerance": tolerance}:
                yield from _flat(prefix, {key: known, f"{key}.tolerance": tolerance})
            case Mapping():
                yield from _flat(f"{path}.", value)
            case [low, high]:
                yield from _flat(path, {"[0]": low, "[1]": high})
            case float() | int() | str():
                yield path, value
            case _:
                pass
