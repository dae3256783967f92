"""A model on its way from one process to another. SI values."""

from typing import TypeAlias, cast

import msgspec

from gripperd.effects import EFFECTS
from gripperd.errors import InputError
from gripperd.model import Chain, Linkage, Muscle, Regulator, StaticMuscle
from gripperd.model.effect import Effect, StaticEffect, acts_in_muscle

Value: TypeAlias = float | str


class EffectMessage(msgspec.Struct, frozen=True):
    """One effect, by its name and the values of its fields."""

    name: str
    values: dict[str, Value]


class ModelMessage(msgspec.Struct, frozen=True):
    """A whole chain; the far end needs no file to go by it."""

    name: str
    muscle: Muscle
    regulator: Regulator
    linkage: Linkage
    effects: tuple[EffectMessage, ...]
    """In the order of the model, those of the muscle first."""
    tolerances: dict[str, float]
    correlations: dict[tuple[str, str], float]


def model_message(chain: Chain) -> ModelMessage:
    """Write a chain as a message."""
    effects: tuple[Effect | StaticEffect, ...]
    effects = (*chain.static.effects, *chain.effects)
    return ModelMessage(
        name=chain.name,
        muscle=chain.muscle,
        regulator=chain.regulator,
        linkage=chain.linkage,
        effects=tuple(map(_effect_message, effects)),
        tolerances=dict(chain.tolerances),
        correlations=dict(chain.correlations),
    )


def chain_of(message: ModelMessage) -> Chain:
    """Build the chain of a message.

    Raises
    ------
    InputError
        An effect is not known here, or has other values.
    """
    effects = tuple(map(_effect, message.effects))
    return Chain(
        message.name,
        StaticMuscle(message.muscle, tuple(filter(acts_in_muscle, effects))),
        message.regulator,
        message.linkage,
        message.tolerances,
        message.correlations,
        effects=tuple(each for each in effects if not acts_in_muscle(each)),
    )


def _effect_message(effect: Effect | StaticEffect) -> EffectMessage:
    values = cast("dict[str, Value]", msgspec.to_builtins(effect))
    return EffectMessage(effect.name, values)


def _effect(message: EffectMessage) -> Effect:
    try:
        return msgspec.convert(message.values, EFFECTS[message.name])
    except (KeyError, msgspec.ValidationError) as unknown:
        detail = f"the effect {message.name!r} is not one of this process: {unknown}"
        raise InputError(detail, key="effects") from unknown
