"""Readings at the ends of runs, which have but one neighbour."""

import numpy as np
import pytest

from gripperd.diagnose.readings.edge import edges
from gripperd.diagnose.readings.recording import Run
from gripperd.model.track import Array
from tests.diagnose.sweep import noise, run, triangle


def _found(told: Run) -> dict[str, list[int]]:
    return {one.quantity: np.flatnonzero(one.rows).tolist() for one in edges([told])}


def _pressure() -> Array:
    return triangle() + noise(400, 1e3)


@pytest.mark.parametrize("row", [0, 399])
def test_what_a_buffer_held_is_no_reading_of_the_run(row: int) -> None:
    pressure = _pressure()
    pressure[row] = 480e3
    force = 2e-3 * triangle() + noise(400, 2.0, 2)
    assert _found(run(pressure=pressure, force=force)) == {"pressure": [row]}


def test_a_run_that_begins_and_ends_as_it_goes_is_believed() -> None:
    assert _found(run(pressure=_pressure(), force=noise(400, 2.0, 2))) == {}


def test_a_command_may_step_at_once() -> None:
    pressure, current = np.full(400, 3e5) + noise(400, 1e3), np.full(400, 12e-3)
    pressure[0], current[0] = 0.0, 4e-3
    assert _found(run(pressure=pressure, current=current)) == {}
    assert _found(run(pressure=pressure)) == {"pressure": [0]}


def test_a_slow_channel_may_go_on_at_once() -> None:
    supply = np.full(400, 7.00e5)
    supply[0], supply[300:] = 7.01e5, 6.99e5
    assert _found(run(supply=supply)) == {}


def test_a_few_readings_do_not_tell() -> None:
    few = np.array([0.0, 1e5, 1.01e5, 1.02e5, 1.03e5])
    assert _found(run(pressure=few)) == {}
