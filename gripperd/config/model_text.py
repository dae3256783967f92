"""Models to model files, the way :func:`gripperd.config.load_model` reads them."""

from collections.abc import Mapping
from enum import Enum

from gripperd.config.effect import AnyEffect, keys_of_effect
from gripperd.config.model import ModelFile
from gripperd.config.model_parts import PARTS
from gripperd.config.number import written
from gripperd.config.section import ENDS, Section, key_of
from gripperd.config.text import yaml_text
from gripperd.model.parameter import parameters
from gripperd.units import split

Document = dict[str, object]


def model_text(model: ModelFile) -> str:
    """Write a model file.

    Reading it gives the model again, except where no number of the file's unit has
    exactly the value in SI: there the last bit may differ. Read it back before use.
    """
    return yaml_text(model_document(model))


def model_document(model: ModelFile) -> Document:
    """Write a model the way files and replies have it, in the units of the keys."""
    owners: Mapping[str, object] = {
        "muscle": model.static.muscle,
        "valve": model.regulator,
        "gripper": model.linkage,
    }
    effects: tuple[AnyEffect, ...] = (*model.static.effects, *model.effects)
    document: Document = {"name": model.name}
    for part, schema in PARTS.items():
        if (owner := owners[part]) is not None:
            document[part] = _part(schema, owner, part, model.tolerances)
    document["effects"] = [_effect(each, model.tolerances) for each in effects]
    if model.lineage is not None:
        document |= model.lineage.model_dump(mode="json", exclude_defaults=True)
    return document


def _part(
    schema: type[Section], owner: object, part: str, sigmas: Mapping[str, float]
) -> Document:
    document: Document = {}
    for field in schema.model_fields:
        name, unit = split(field)
        ends = [f"{name}_{end}" for end in ENDS]
        is_pair = hasattr(owner, ends[0])
        values = [
            _number(getattr(owner, each), unit, sigmas.get(f"{part}.{each}"))
            for each in (ends if is_pair else [name])
        ]
        document[key_of(schema, field)] = values if is_pair else values[0]
    return document


def _effect(effect: AnyEffect, sigmas: Mapping[str, float]) -> str | Document:
    known = parameters(effect)
    document: Document = {"name": effect.name}
    for name, key in keys_of_effect(effect).items():
        value = getattr(effect, name)
        if isinstance(value, float) and name in known:
            sigma = sigmas.get(f"effects.{effect.name}.{name}")
            document[key] = _number(value, known[name].unit, sigma)
        else:
            document[key] = value.value if isinstance(value, Enum) else value
    return document if len(document) > 1 else effect.name


def _number(value: float, unit: str | None, sigma: float | None) -> float | Document:
    number = written(value, unit)
    if sigma is None:
        return number
    return {"value": number, "tolerance": written(sigma, unit)}
