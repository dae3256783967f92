import numpy as np
import pytest

from gripperd.diagnose.readings.limits import beyond_limits
from gripperd.diagnose.readings.recording import Run


def _found(quantity: str, *values: float) -> dict[str, list[int]]:
    faults = beyond_limits([Run("a", {quantity: np.array(values)})])
    return {
        fault.reason: np.flatnonzero(fault.rows).tolist()
        for fault in faults
        if fault.rows.any()
    }


def test_a_loop_below_or_above_namur_ne_43_is_broken() -> None:
    found = _found("current", 0.0, 3.59e-3, 3.6e-3, 4e-3, 20e-3, 21e-3, 21.1e-3)
    assert found == {"under 3.6 mA": [0, 1], "above 21 mA": [6]}


@pytest.mark.parametrize(
    ("quantity", "possible", "impossible", "reason"),
    [
        ("pressure", -101e3, -102e3, "under -101.33 kPa"),
        ("temperature", 250.0, -1.0, "under -60 °C"),
        ("temperature", 400.0, 295.0 + 273.15, "above 150 °C"),
        ("contraction", 0.9, 6.0, "above 1"),
        ("length", 0.2, -0.2, "under 0 mm"),
        ("ambient", 90e3, -1.0, "under 30 kPa"),
        ("ambient", 90e3, 101e6, "above 120 kPa"),
    ],
)
def test_what_cannot_be_is_found(
    quantity: str, possible: float, impossible: float, reason: str
) -> None:
    assert _found(quantity, possible, impossible) == {reason: [1]}


def test_any_force_may_be_right_if_it_is_a_number() -> None:
    found = _found("force", -1e6, 1e6, np.nan, np.inf, -np.inf)
    assert found == {"not a finite number": [3, 4]}
