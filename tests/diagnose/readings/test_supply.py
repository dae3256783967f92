"""A supply that sinks from sweep to sweep, read with noise."""

import numpy as np

from gripperd.diagnose.readings.cutting import courses
from gripperd.diagnose.readings.recording import Recording, Run
from gripperd.diagnose.readings.supply import supply_drops
from gripperd.model.track import Array
from tests.diagnose.sweep import noise

SIZE = 400
REST_LENGTH = 0.25


def _sweep(name: str, start: float, supply: Array | None) -> Run:
    filled = np.linspace(0.0, 4e5, SIZE)
    columns: dict[str, Array] = {
        "time": start + np.linspace(0.0, 40.0, SIZE),
        "pressure": filled,
        "force": 2e-3 * filled,
    }
    if supply is not None:
        columns["supply"] = supply
    return Run(name, columns)


def test_all_sweeps_are_held_against_the_highest_supply_of_the_recording() -> None:
    runs = [
        _sweep("full", 0.0, 650e3 + noise(SIZE, 4e3, 1)),
        _sweep("low", 1000.0, 600e3 + noise(SIZE, 4e3, 2)),
        _sweep("unknown", 2000.0, None),
    ]
    full, low, unknown = courses(Recording("test", "", tuple(runs)), REST_LENGTH)[0]
    # A constant is known to a tenth of the noise that its readings have.
    np.testing.assert_allclose(full.supply_drop, 0.0, atol=1e3)
    np.testing.assert_allclose(low.supply_drop, 50e3, atol=1.5e3)
    assert not unknown.supply_drop.any()


def test_a_supply_that_nobody_measures_drops_by_nothing() -> None:
    runs = (_sweep("one", 0.0, None), _sweep("two", 1000.0, None))
    sweeps = courses(Recording("test", "", runs), REST_LENGTH)[0]
    assert [drop.tolist() for drop in supply_drops(sweeps)] == [[0.0] * SIZE] * 2
