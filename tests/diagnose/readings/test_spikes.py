from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gripperd.diagnose.readings.recording import Run
from gripperd.diagnose.readings.spikes import spikes
from gripperd.model.track import Array
from tests.diagnose.sweep import noise, pulled, run, triangle


def _rows(*runs: Run) -> dict[str, list[int]]:
    return {
        fault.quantity: np.flatnonzero(fault.rows).tolist()
        for fault in spikes(runs)
        if fault.rows.any()
    }


def _with(sweep: Run, quantity: str, rows: slice, change: float) -> Run:
    values = sweep.columns[quantity].copy()
    values[rows] += change
    return replace(sweep, columns={**sweep.columns, quantity: values})


@pytest.mark.parametrize("width", [1, 2, 3])
@pytest.mark.parametrize(("quantity", "height"), [("force", 300), ("pressure", -90e3)])
def test_a_spike_of_up_to_three_samples_is_found(
    quantity: str, height: float, width: int
) -> None:
    sweep = _with(pulled(), quantity, slice(120, 120 + width), height)
    assert _rows(sweep) == {quantity: list(range(120, 120 + width))}


def test_neighbouring_spikes_do_not_hide_each_other() -> None:
    sweep = _with(pulled(), "force", slice(120, 121), 400)
    sweep = _with(sweep, "force", slice(125, 126), -350)
    assert _rows(sweep) == {"force": [120, 125]}


def test_a_higher_spike_does_not_hide_a_lower_one() -> None:
    sweep = _with(pulled(), "force", slice(120, 121), 400)
    sweep = _with(sweep, "force", slice(126, 127), 150)
    assert _rows(sweep) == {"force": [120, 126]}


def test_a_quick_way_to_where_nothing_is_read_is_not_eaten_up() -> None:
    """Jaws that close within five samples, to less than their sensor reads."""
    opening = np.r_[np.full(60, 23.0), 19.7, 12.2, 2.9, np.full(60, np.nan)]
    opening = np.r_[opening, 2.1, 11.4, 19.2, np.full(60, 23.0)] * 1e-3
    rows = _rows(run(opening=opening + noise(opening.size, 5e-5)))
    assert len(rows.get("opening", [])) <= 2


def test_a_spike_on_a_staircase_is_found() -> None:
    """Four samples of each ten go up, by 20 N a sample."""
    step = np.tile([20.0] * 4 + [0.0] * 6, 20)
    sweep = run(force=np.cumsum(step) + noise(200, 2.0))
    assert _rows(sweep) == {}
    assert _rows(_with(sweep, "force", slice(107, 108), 120)) == {"force": [107]}


def test_a_spike_on_a_locked_length_is_found() -> None:
    sweep = _with(pulled(), "contraction", slice(50, 51), 0.5)
    assert _rows(sweep) == {"contraction": [50]}


def test_missing_samples_around_a_spike_do_not_hide_it() -> None:
    sweep = _with(pulled(), "force", slice(120, 121), 400)
    sweep = _with(sweep, "force", slice(121, 123), np.nan)
    assert _rows(sweep) == {"force": [120]}


def test_an_overshoot_of_one_sample_after_a_step_stays() -> None:
    force = np.r_[np.full(50, 100.0), 250.0, np.full(50, 200.0)]
    assert _rows(run(force=force)) == {}


def test_one_of_many_large_swings_stays() -> None:
    force = np.r_[np.full(300, 100.0), np.tile([50.0, 150.0], 20), np.full(300, 100.0)]
    force[321] = 300.0
    assert _rows(run(force=force)) == {}


def test_four_samples_are_not_isolated() -> None:
    assert _rows(_with(pulled(), "force", slice(120, 124), 300)) == {}


def test_a_movement_that_another_column_shares_stays() -> None:
    sweep = _with(pulled(), "force", slice(120, 122), 300)
    assert _rows(_with(sweep, "pressure", slice(120, 122), 150e3)) == {}


def test_a_pulse_of_the_command_is_no_spike() -> None:
    current = np.full(100, 8e-3)
    current[40:42] = 16e-3
    assert _rows(run(current=current)) == {}


def test_many_excursions_are_the_signal() -> None:
    force = 300 + noise(200, 1.0)
    force[::10] += 200
    assert _rows(run(force=force)) == {}


@pytest.mark.parametrize("std", [0.0, 1.0, 20.0])
def test_turning_points_are_no_spikes(std: float) -> None:
    saw = np.tile(triangle(40), 10)
    assert _rows(run(pressure=saw + noise(400, std))) == {}


def test_a_map_measured_in_random_order_has_no_spikes() -> None:
    pressure = np.random.default_rng(3).permutation(np.linspace(50e3, 600e3, 200))
    assert _rows(run(pressure=pressure, force=2e-3 * pressure)) == {}


def _response(at: int, height: float, damping: float, delay: float) -> Array:
    """Second-order response to a step, as a regulator gives it."""
    time = np.maximum(np.arange(200) - at, 0.0) / delay
    ringing = np.sqrt(1.0 - damping**2)
    decay = np.exp(-damping * time)
    wave = np.cos(ringing * time) + damping / ringing * np.sin(ringing * time)
    return np.asarray(height * (1.0 - decay * wave))


@given(
    at=st.integers(10, 190),
    height=st.floats(-500e3, 500e3),
    damping=st.floats(0.2, 0.95),
    delay=st.floats(0.7, 20.0),
    std=st.sampled_from([0.0, 10.0, 1e3]),
)
@settings(max_examples=200, deadline=None, derandomize=True)
def test_a_step_and_its_overshoot_are_never_spikes(
    at: int, height: float, damping: float, delay: float, std: float
) -> None:
    pressure = 250e3 + _response(at, height, damping, delay) + noise(200, std)
    assert _rows(run(pressure=pressure)) == {}


@given(at=st.integers(1, 198), height=st.floats(-500.0, 500.0), std=st.floats(0.0, 5.0))
@settings(max_examples=100, deadline=None, derandomize=True)
def test_a_sudden_step_is_never_a_spike(at: int, height: float, std: float) -> None:
    force = 300 + np.where(np.arange(200) >= at, height, 0.0) + noise(200, std)
    assert _rows(run(force=force)) == {}


def test_what_both_cells_of_a_gripper_feel_stays() -> None:
    felt = {"grip": pulled(seed=5).columns["force"]}
    sweep = replace(pulled(), columns={**pulled().columns, **felt})
    bumped = _with(
        _with(sweep, "force", slice(120, 122), 300.0), "grip", slice(120, 122), 300.0
    )
    assert _rows(bumped) == {}
