"""Rubber that saturates as an exponential does, and sooner."""

from collections.abc import Callable

import numpy as np
import pytest

from gripperd.diagnose.diagnosis import diagnose
from gripperd.effects import EFFECTS
from gripperd.effects.nonlinear_elasticity import NonlinearElasticity
from gripperd.model.effect import Signal
from gripperd.model.track import Array
from tests.diagnose.small import FORCE_NOISE, MODEL, Moment, recording


@pytest.mark.parametrize(
    ("law", "low", "high"),
    [
        pytest.param(lambda h: np.tanh(h / 0.02), 0.15, 0.6, id="tangent"),
        pytest.param(lambda h: -np.expm1(-h / 0.02), 0.0, 0.0, id="exponential"),
    ],
)
def test_a_knee_is_as_sharp_as_it_is(
    law: Callable[[Array], Array], low: float, high: float
) -> None:
    def pulling_back(moment: Moment) -> Array:
        return -150.0 * law(moment.contraction)

    names = ("nonlinear_elasticity", "threshold_pressure")
    library = {name: EFFECTS[name] for name in names}
    told = diagnose(recording(pulling_back), MODEL, {}, library)
    assert [entry.name for entry in told.named] == ["nonlinear_elasticity"]
    (rubber,) = told.explained.effects
    assert isinstance(rubber, NonlinearElasticity)
    assert low <= rubber.sharpness <= high
    gap = told.gaps[Signal.FORCE]
    assert FORCE_NOISE < gap.after < 1.05 * gap.noise_floor
