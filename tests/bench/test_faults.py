import pytest

from gripperd.bench.faults import HEALTHY, BenchFaults
from gripperd.errors import InputError


def test_nothing_is_wrong_by_default() -> None:
    assert BenchFaults() == HEALTHY
    assert not HEALTHY.broken
    assert HEALTHY.supply_pressure is None


def test_a_valve_may_err_to_both_sides() -> None:
    assert BenchFaults(valve_offset=-20e3).valve_offset == -20e3


@pytest.mark.parametrize(
    ("values", "key"),
    [
        ({"supply_pressure": -1.0}, "supply_kPa"),
        ({"supply_pressure": float("inf")}, "supply_kPa"),
        ({"valve_offset": float("nan")}, "valve_offset_kPa"),
        ({"valve_offset": float("-inf")}, "valve_offset_kPa"),
        ({"leak_rate": -1.0}, "leak_per_s"),
        ({"jaw_friction": -0.1}, "jaw_friction_N"),
    ],
)
def test_a_fault_that_cannot_be_is_refused(values: dict[str, float], key: str) -> None:
    with pytest.raises(InputError) as refusal:
        BenchFaults(**values)  # type: ignore[arg-type]
    assert refusal.value.key == key
