from gripperd.effects.threshold_pressure import ThresholdPressure
from tests.diagnose.small import (
    MODEL,
)


def test_an_effect_of_the_same_name_is_replaced() -> None:
    once = MODEL.with_effect(ThresholdPressure(pressure=1e3))
    twice = once.with_effect(ThresholdPressure(pressure=2e3))
    assert len(twice.effects) == len(once.effects) == len(MODEL.effects) + 1
    assert twice.effects[-1] == ThresholdPressure(pressure=2e3)
