import numpy as np
import pytest

from gripperd.bench.active import ActiveEffects
from gripperd.effects.pressure_sensor_bias import PressureSensorBias
from gripperd.effects.pressure_sensor_gain import PressureSensorGain
from gripperd.effects.valve_lag import ValveLag
from gripperd.model import Muscle
from tests.effects.tracks import track_of


def test_effects_act_one_after_the_other(muscle: Muscle) -> None:
    now = track_of(muscle, time=np.zeros(1))
    gain, bias = PressureSensorGain(error=0.1), PressureSensorBias(bias=1e3)
    assert ActiveEffects((gain, bias)).along(100e3, now) == pytest.approx(111e3)
    assert ActiveEffects((bias, gain)).along(100e3, now) == pytest.approx(111.1e3)


def test_what_is_asked_ahead_is_not_remembered(muscle: Muscle) -> None:
    lagging = ActiveEffects((ValveLag(share=1.0, time=0.5),))
    now = track_of(muscle, step=np.array([0.5]))
    lagging.along(0.0, now)
    ahead = lagging.ahead(100e3, now)
    assert ahead == pytest.approx(100e3 * (1 - np.exp(-1)))
    assert lagging.along(100e3, now) == ahead
    assert lagging.along(100e3, now) == pytest.approx(100e3 * (1 - np.exp(-2)))


def test_it_is_false_without_effects() -> None:
    assert not ActiveEffects(())
    assert ActiveEffects((ValveLag(),))
