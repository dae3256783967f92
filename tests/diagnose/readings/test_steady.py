import numpy as np
import pytest
from scipy.signal import lfilter

from gripperd.diagnose.readings.cutting import courses
from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.diagnose.readings.steady import noise_held
from gripperd.model.track import Array

STD, AGAIN = 1.5e3, 0.4
TIME = np.arange(0.0, 60.0, 0.1)


def _noise(seed: int, size: int = TIME.size, again: float = AGAIN) -> Array:
    """First-order autoregressive, of 1.5 kPa. [Pa]."""
    drawn = np.random.default_rng(seed).normal(0.0, STD, size + 100)
    wanders = lfilter([np.sqrt(1 - again**2)], [1.0, -again], drawn)
    return np.asarray(wanders[100:])


def _stairs() -> Array:
    """40 kPa up in 0.3 s, and half a second of rest; 12 of them, and down again."""
    going = np.clip(TIME % 0.8, 0.0, 0.3) / 0.3 + TIME // 0.8
    return 40e3 * np.abs((going + 12.0) % 24.0 - 12.0)


def test_held_sweeps_tell_the_noise_and_its_memory() -> None:
    told = noise_held([300e3 + _noise(1), 200e3 + _noise(2), _stairs() + _noise(3)])
    assert told is not None
    assert told.std == pytest.approx(STD, rel=0.1)
    assert told.correlation == pytest.approx(AGAIN, abs=0.1)


def test_what_a_pressure_goes_through_to_where_it_is_held_is_none() -> None:
    entry = np.interp(TIME, [0.0, 13.0], [0.0, 300e3])
    told = noise_held([entry + _noise(1)])
    assert told is not None
    assert told.std == pytest.approx(STD, rel=0.15)


@pytest.mark.parametrize(
    "columns",
    [
        pytest.param([], id="no pressure"),
        pytest.param([np.full(600, np.nan)], id="none that is known"),
        pytest.param([np.array([np.nan, 3e5])], id="one reading"),
        pytest.param([_stairs() + _noise(1)], id="none that is held"),
        pytest.param([_noise(1), _stairs() + _noise(2)], id="a vented one"),
        pytest.param([300e3 + _noise(1, 99)], id="too few samples"),
        pytest.param([300e3 + 2e4 * np.sin(TIME)], id="a slow wave"),
        pytest.param([np.full(600, 300e3)], id="one that never changes"),
    ],
)
def test_nothing_else_does(columns: list[Array]) -> None:
    assert noise_held(columns) is None


def test_a_noise_that_wanders_more_is_still_held() -> None:
    told = noise_held([300e3 + _noise(1, again=0.6), 200e3 + _noise(2, again=0.6)])
    assert told is not None
    assert told.correlation == pytest.approx(0.6, abs=0.1)


def _recorded(*, commanded: bool) -> Recording:
    pressures = {"a": _stairs(), "b": _stairs(), "c": 300e3 + 0.0 * TIME}
    runs = []
    for place, (name, pressure) in enumerate(pressures.items()):
        columns = {
            "time": TIME + 90.0 * place,
            "pressure": pressure + _noise(place),
        }
        if commanded:
            columns["current"] = 4e-3 + 16e-3 * pressure / 500e3
        runs.append(Run(name, columns))
    return Recording("stairs", "0" * 64, tuple(runs))


def test_brisk_stairs_are_no_noise() -> None:
    _, noises = courses(_recorded(commanded=False), 0.25)
    assert noises["pressure"].std == pytest.approx(STD, rel=0.15)


def test_a_command_that_rests_tells_before_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gripperd.diagnose.readings.steady.HELD", 0.0)
    _, noises = courses(_recorded(commanded=True), 0.25)
    assert noises["pressure"].std == pytest.approx(STD, rel=0.15)
