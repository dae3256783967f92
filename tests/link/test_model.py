"""A model that travels arrives as it was."""

from dataclasses import fields, replace
from enum import Enum

import msgspec
import pytest

from gripperd.effects import EFFECTS
from gripperd.effects.braid_friction import BraidFriction, Form
from gripperd.effects.creep import Creep
from gripperd.effects.valve_offset import ValveOffset, Zero
from gripperd.errors import InputError
from gripperd.link.frames import decode, encode
from gripperd.link.model import EffectMessage, ModelMessage, chain_of, model_message
from gripperd.model import Chain, PressedObject, StaticMuscle
from gripperd.model.effect import Effect, acts_in_muscle

PRESSED = PressedObject(0.041, 1e5)


def travelled(chain: Chain) -> Chain:
    return chain_of(decode(encode(model_message(chain)), ModelMessage))


def unusual(kind: type[Effect]) -> Effect:
    """An effect of which every number differs from its default."""
    effect = kind()
    numbers = {
        field.name: getattr(effect, field.name) + 0.123
        for field in fields(effect)
        if not isinstance(getattr(effect, field.name), Enum)
    }
    return replace(effect, **numbers)


@pytest.mark.parametrize("name", EFFECTS)
def test_every_effect_arrives_with_its_values(chain: Chain, name: str) -> None:
    effect = unusual(EFFECTS[name])
    if acts_in_muscle(effect):
        sent = replace(chain, static=StaticMuscle(chain.muscle, (effect,)))
    else:
        sent = replace(chain, effects=(effect,))
    assert travelled(sent) == sent


def test_a_whole_model_arrives_with_its_order_and_tolerances(chain: Chain) -> None:
    sent = replace(
        chain,
        name="reference-7",
        static=StaticMuscle(
            chain.muscle, (Creep(slow=0.02), BraidFriction(form=Form.AS_PRINTED))
        ),
        tolerances={"muscle.diameter": 1e-4, "effects.valve_offset.offset": 200.0},
        correlations={("muscle.diameter", "effects.valve_offset.offset"): -0.9},
        effects=(ValveOffset(offset=2e3, zero=Zero.SUPPRESSED),),
    )
    # What was worked out and kept must not travel, or hinder.
    sent.std(0.0107, PRESSED)
    there = travelled(sent)
    assert there == sent
    assert there.std(0.0107, PRESSED) == sent.std(0.0107, PRESSED)


@pytest.mark.parametrize(
    "wrong",
    [
        EffectMessage("magnetism", {}),
        EffectMessage("creep", {"slow": "much"}),
    ],
)
def test_an_effect_of_another_program_is_refused(
    chain: Chain, wrong: EffectMessage
) -> None:
    message = msgspec.structs.replace(model_message(chain), effects=(wrong,))
    with pytest.raises(InputError, match=f"'{wrong.name}' is not one") as refused:
        chain_of(message)
    assert refused.value.key == "effects"
