import pytest
from hypothesis import given
from hypothesis import strategies as st

from gripperd.model import Regulator

REGULATORS = st.builds(
    Regulator,
    current_low=st.floats(0.0, 0.005),
    current_high=st.floats(0.015, 0.025),
    pressure_low=st.floats(-1e5, 1e5),
    pressure_high=st.floats(2e5, 1e6),
)


@pytest.mark.parametrize(
    ("current", "pressure"), [(4, 0.0), (10.7, 209.375), (12, 250.0), (20, 500.0)]
)
def test_the_reference_regulator_gives_500_kpa_over_16_ma(
    current: float, pressure: float
) -> None:
    reference = Regulator(
        current_low=0.004, current_high=0.020, pressure_low=0.0, pressure_high=500e3
    )
    assert reference.pressure(current * 1e-3) == pytest.approx(pressure * 1e3, abs=1e-6)


@given(regulator=REGULATORS, current=st.floats(0.0, 0.025))
def test_the_current_for_a_pressure_gives_that_pressure(
    regulator: Regulator, current: float
) -> None:
    again = regulator.current(regulator.pressure(current))
    assert again == pytest.approx(current, abs=1e-15)


@given(regulator=REGULATORS)
def test_both_ends_of_the_span_lie_on_the_line(regulator: Regulator) -> None:
    low = regulator.pressure(regulator.current_low)
    high = regulator.pressure(regulator.current_high)
    assert low == pytest.approx(regulator.pressure_low, abs=1e-6)
    assert high == pytest.approx(regulator.pressure_high, abs=1e-6)
