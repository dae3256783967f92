from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.readings.fault import Check, Mask
from gripperd.diagnose.readings.floors import ends_of_pressure, ends_of_scale, slack
from gripperd.diagnose.readings.recording import Run
from gripperd.diagnose.readings.screening import screened
from gripperd.model.track import Array
from tests.diagnose.sweep import noise, pulled, run, triangle


def _rows(check: Check, runs: Sequence[Run]) -> dict[int, Mask]:
    faults = check(runs)
    return {fault.run: fault.rows for fault in faults if fault.rows.any()}


def _with_force(sweep: Run, force: Array) -> Run:
    return replace(sweep, columns={**sweep.columns, "force": force})


def test_exact_zeros_of_a_slack_muscle_are_censored() -> None:
    taut = pulled()
    force = np.maximum(taut.columns["force"] - 300.0, 0.0)
    (rows,) = _rows(slack, [_with_force(taut, force)]).values()
    assert (rows == (force == 0.0)).all()
    assert rows.sum() > 50


def test_a_single_zero_counts_when_other_runs_are_slack_too() -> None:
    high, low = np.arange(30.0), np.maximum(np.arange(30.0) - 10, 0.0)
    rows = _rows(slack, [run("high", force=high), run("low", force=low)])
    assert rows[0].tolist() == [True] + [False] * 29


def test_a_zero_between_pull_and_push_is_a_reading() -> None:
    force = np.tile(np.arange(-5.0, 6.0), 6)
    assert _rows(slack, [run(force=force)]) == {}


def test_two_zeros_are_a_coincidence() -> None:
    force = np.r_[0.0, np.arange(1.0, 30.0), 0.0]
    assert _rows(slack, [run(force=force)]) == {}


def test_a_converter_at_its_floor_is_censored_in_every_run() -> None:
    first, second = pulled("a", contraction=0.3), pulled("b", contraction=0.15, seed=7)
    clipped = [
        _with_force(sweep, np.maximum(sweep.columns["force"], -18.6))
        for sweep in (first, second)
    ]
    rows = _rows(ends_of_scale, clipped)
    for index, sweep in enumerate(clipped):
        assert (rows[index] == (sweep.columns["force"] == -18.6)).all()
        assert rows[index].sum() > 5


def test_a_converter_at_its_ceiling_is_censored() -> None:
    sweep = pulled()
    force = np.minimum(sweep.columns["force"], 700.0)
    (rows,) = _rows(ends_of_scale, [_with_force(sweep, force)]).values()
    assert (rows == (force == 700.0)).all()


def test_the_flat_top_of_a_coarse_channel_at_constant_pressure_is_a_reading() -> None:
    pressure = np.minimum(triangle(400, high=700e3), 500e3) + np.linspace(0, 5e3, 400)
    force = np.round(2e-3 * pressure / 20.0) * 20.0
    for std in (0.0, 1e3):
        sweep = run(
            pressure=pressure + noise(400, std),
            contraction=np.full(400, 0.1),
            force=force,
        )
        assert _rows(ends_of_scale, [sweep]) == {}


def test_two_weights_lifted_are_neither_floor_nor_ceiling() -> None:
    free = 0.2 * triangle() / 500e3
    runs = [
        run(name, pressure=triangle(), contraction=free, force=np.full(400, force))
        for name, force in (("light", -10.0), ("heavy", 2e3))
    ]
    assert _rows(ends_of_scale, [*runs, pulled(contraction=0.0)]) == {}


def test_a_weight_that_pulls_with_one_force_is_a_reading() -> None:
    sweep = run(pressure=triangle(), force=np.full(400, 68.7))
    assert _rows(ends_of_scale, [sweep]) == {}


def _capped(step: float = 0.0, current: float = 20e-3) -> Run:
    """A transmitter of up to 400 kPa on a regulator that gives up to 500."""
    pressure = triangle() + noise(400, 1.5e3)
    if step:
        pressure = np.round(pressure / step) * step
    command = np.minimum(4e-3 + 16e-3 * triangle() / 500e3, current)
    return run(pressure=np.minimum(pressure, 400e3), current=command)


def test_a_pressure_at_the_ceiling_of_its_channel_is_censored() -> None:
    capped = _capped()
    (rows,) = _rows(ends_of_pressure, [capped]).values()
    assert (rows == (capped.columns["pressure"] == 400e3)).all()
    assert rows.sum() > 80


@pytest.mark.parametrize(("end", "seen"), [(150e3, True), (3e3, False)])
def test_a_pressure_at_the_floor_of_its_channel_is_censored(
    end: float, *, seen: bool
) -> None:
    """One that shows nothing below 1.5 bar; but a vented muscle is read as it is."""
    vented = np.zeros(100)
    asked = np.concatenate([vented, triangle(low=0.0)])
    told = run(
        pressure=np.maximum(asked + noise(500, 1e3), end),
        current=4e-3 + 16e-3 * asked / 500e3,
        contraction=np.concatenate([np.linspace(0.2, 0.0, 100), np.zeros(400)]),
    )
    at_end = told.columns["pressure"] == end
    assert at_end.sum() > 90
    found = list(_rows(ends_of_pressure, [told]).values())
    assert [rows.tolist() for rows in found] == [at_end.tolist()] * seen


def test_a_pressure_that_is_asked_to_stay_is_no_ceiling() -> None:
    # 400 kPa is what 16.8 mA ask for.
    assert _rows(ends_of_pressure, [_capped(current=16.8e-3)]) == {}


def test_of_a_coarse_converter_nobody_can_tell_its_ceiling_from_a_supply() -> None:
    assert _rows(ends_of_pressure, [_capped(step=8e3)]) == {}


def test_screening_looks_for_ceilings() -> None:
    (believed,), rejected = screened([_capped()])
    assert np.isnan(believed.columns["pressure"]).sum() > 80
    assert {entry.reason for entry in rejected} == {
        "at the ceiling of the channel, 400 kPa"
    }


def test_the_ceiling_is_that_of_all_runs() -> None:
    low = run(
        "low",
        pressure=triangle(high=390e3) + noise(400, 1.5e3, 5),
        current=4e-3 + 16e-3 * triangle(high=390e3) / 500e3,
    )
    rows = _rows(ends_of_pressure, [low, _capped()])
    # Of the lower sweep a few noisy readings may have been cut.
    assert rows[1].sum() > 80
    assert rows.get(0, np.zeros(1)).sum() < 5


@pytest.mark.parametrize(
    "pressure",
    [
        pytest.param(np.full(400, 300e3), id="an isobar without noise"),
        pytest.param(np.minimum(triangle(), 400e3), id="a transmitter without noise"),
        pytest.param(
            np.round((np.minimum(triangle(), 400e3) + noise(400, 30.0)) / 250) * 250,
            id="noise under the resolution",
        ),
    ],
)
def test_of_a_channel_without_noise_nobody_can_tell_its_ceiling(
    pressure: Array,
) -> None:
    current = 4e-3 + 16e-3 * triangle() / 500e3
    assert _rows(ends_of_pressure, [run(pressure=pressure, current=current)]) == {}


def test_what_creeps_at_the_highest_pressure_is_no_ceiling() -> None:
    capped = _capped(current=16.8e-3)
    creeping = np.where(capped.columns["pressure"] == 400e3, 1.0, 0.0)
    force = 1000.0 * triangle() / 500e3
    held = np.minimum(force, 800.0) + 0.04 * np.cumsum(creeping) + noise(400, 0.3, 9)
    told = replace(capped, columns={**capped.columns, "force": held})
    assert _rows(ends_of_pressure, [told]) == {}


def test_a_supply_that_gives_no_more_gives_it_with_its_noise() -> None:
    supply = np.minimum(triangle(), 400e3) + noise(400, 1.5e3)
    sweep = run(pressure=supply, current=4e-3 + 16e-3 * triangle() / 500e3)
    assert _rows(ends_of_pressure, [sweep]) == {}


def test_noise_around_the_least_force_is_no_floor() -> None:
    assert _rows(ends_of_scale, [pulled(seed=seed) for seed in range(5)]) == {}
