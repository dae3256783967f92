from dataclasses import replace

import numpy as np
import pytest

from gripperd.diagnose.readings.recording import Contradiction, Run
from gripperd.diagnose.readings.repeats import contradictions
from tests.diagnose.sweep import noise, pulled, run, triangle


def _repeats(*gains: float) -> list[Run]:
    return [
        pulled(f"{index}", gain=gain, seed=10 * index)
        for index, gain in enumerate(gains)
    ]


def _names(found: Contradiction) -> tuple[str, str]:
    return "".join(found.runs), "".join(found.others)


def test_alternating_groups_that_do_not_agree_contradict_each_other() -> None:
    (found,) = contradictions(_repeats(1.0, 0.7, 1.0, 0.7, 1.0, 0.7))
    assert _names(found) == ("024", "135")
    assert (found.column, found.unit) == ("force_N", "N")
    # The gains differ by 0.3 of 2 N/kPa over 50 to 500 kPa: 183 N root mean square.
    assert found.difference == pytest.approx(183.0, rel=0.05)
    assert found.spread < 5.0


def test_two_against_two_are_enough_when_they_alternate() -> None:
    (found,) = contradictions(_repeats(0.7, 1.0, 0.7, 1.0))
    assert _names(found) == ("02", "13")
    assert found.difference < 0


def test_a_slip_between_two_rows_of_repeats_is_a_contradiction() -> None:
    (found,) = contradictions(_repeats(1.0, 1.0, 1.0, 0.7, 0.7, 0.7))
    assert _names(found) == ("012", "345")


def test_a_pause_with_other_runs_between_may_have_worn_the_muscle() -> None:
    repeats = _repeats(1.0, 1.0, 1.0, 0.7, 0.7, 0.7)
    repeats[3:3] = [pulled("other", contraction=0.2)]
    assert contradictions(repeats) == ()


@pytest.mark.parametrize(
    "gains",
    [
        pytest.param((1.0,) * 8, id="repeats that agree"),
        pytest.param((1.0, 1.0, 1.15, 1.15, 1.0, 1.0), id="too little"),
        pytest.param((1.3, 1.0, 1.0, 1.0, 1.0, 1.0), id="first cycle"),
        pytest.param(tuple(1.0 - 0.05 * n for n in range(10)), id="fatigue"),
        pytest.param(tuple(0.5 + 0.5 * 0.6**n for n in range(10)), id="settling"),
        pytest.param((1.3, 0.6, 1.0, 0.75, 1.2, 0.7, 0.85, 1.05), id="scatter"),
        pytest.param((1.0, 0.95, 0.95, 0.95, 0.65, 0.65, 0.65, 0.6), id="uneven wear"),
        pytest.param((1.3, 1.3, 1.0, 1.0, 1.0, 1.0), id="two first cycles"),
        pytest.param((1.0, 0.7), id="one against one"),
        pytest.param((1.0, 1.0, 1.0, 0.7), id="one that differs"),
        pytest.param((1.05, 1.0) * 4, id="first after each rest"),
    ],
)
def test_physics_is_no_contradiction(gains: tuple[float, ...]) -> None:
    assert contradictions(_repeats(*gains)) == ()


def test_other_conditions_make_another_sweep() -> None:
    repeats = _repeats(1.0, 0.7, 1.0, 0.7, 1.0, 0.7)
    warmed = [
        replace(
            sweep,
            columns={**sweep.columns, "temperature": np.full(400, 295.0 + 8 * (n % 2))},
        )
        for n, sweep in enumerate(repeats)
    ]
    assert contradictions(warmed) == ()


def test_another_length_makes_another_sweep() -> None:
    runs = [
        pulled(f"{n}", contraction=0.1 + 0.02 * (n % 2), gain=1.0 - 0.3 * (n % 2))
        for n in range(6)
    ]
    assert contradictions(runs) == ()


def test_another_range_of_pressure_makes_another_sweep() -> None:
    low, high = triangle(400, 50e3, 150e3), triangle(400, 300e3, 600e3)
    runs = [
        run(
            f"{n}",
            pressure=pressure,
            contraction=np.full(400, 0.1),
            force=noise(400, 1.0, n) + (0.0 if pressure is low else 500.0),
        )
        for n, pressure in enumerate((low, high) * 3)
    ]
    assert contradictions(runs) == ()


def test_isobaric_sweeps_of_length_are_compared_too() -> None:
    runs = [
        run(
            f"{n}",
            pressure=300e3 + noise(400, 500.0, n),
            contraction=0.2 * triangle() / 500e3,
            force=900.0 - 1.5e-3 * triangle() + 200 * (n % 2) + noise(400, 3.0, n),
        )
        for n in range(4)
    ]
    (found,) = contradictions(runs)
    assert _names(found) == ("02", "13")
    assert found.difference == pytest.approx(-200.0, rel=0.03)


def test_exact_copies_agree() -> None:
    assert contradictions([pulled(f"{n}") for n in range(5)]) == ()


def test_length_and_contraction_find_one_contradiction_once() -> None:
    repeats = [
        replace(sweep, columns={**sweep.columns, "length": np.full(400, 0.225)})
        for sweep in _repeats(1.0, 0.7, 1.0, 0.7)
    ]
    assert len(contradictions(repeats)) == 1


def test_sweeps_without_a_reading_in_common_are_not_compared() -> None:
    runs = [
        replace(sweep, columns={**sweep.columns, "force": force, "pressure": pressure})
        for sweep, force, pressure in zip(
            _repeats(1.0, 1.0, 1.0, 1.0),
            [np.tile([1.0, np.nan], 200)] * 4,
            [np.tile([np.nan, 2e5], 200)] * 4,
            strict=True,
        )
    ]
    assert contradictions(runs) == ()


def test_inflating_and_deflating_are_two_sweeps() -> None:
    up = np.linspace(50e3, 500e3, 200)
    runs = [
        run(
            f"{n}",
            pressure=up[:: -1 if n % 2 else 1],
            contraction=np.full(200, 0.1),
            force=2e-3 * up[:: -1 if n % 2 else 1] + 250.0 * (n % 2),
        )
        for n in range(6)
    ]
    assert contradictions(runs) == ()
