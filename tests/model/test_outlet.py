"""Current to pressure and back, with effects in the valve."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gripperd.effects.supply_saturation import SupplySaturation
from gripperd.effects.valve_gain import ValveGain
from gripperd.effects.valve_nonlinearity import ValveNonlinearity
from gripperd.effects.valve_offset import ValveOffset, Zero
from gripperd.errors import DomainError
from gripperd.model import Chain
from gripperd.model.outlet import Outlet

BENT = (ValveOffset(offset=4e3), ValveGain(error=0.03), ValveNonlinearity(bow=8e3))


def test_offset_and_span_errors_make_another_line(chain: Chain) -> None:
    outlet = Outlet(chain.regulator, (ValveOffset(offset=4e3), ValveGain(error=0.1)))
    # 12 mA is 250 kPa on the line, 254 shifted, 279.4 turned.
    assert outlet.pressure(0.012) == pytest.approx(279.4e3)
    assert outlet.current(279.4e3) == pytest.approx(0.012, rel=1e-12)


@given(current=st.floats(0.002, 0.022))
def test_the_current_for_a_pressure_gives_that_pressure(
    chain: Chain, current: float
) -> None:
    outlet = Outlet(chain.regulator, BENT)
    assert outlet.current(outlet.pressure(current)) == pytest.approx(current, rel=1e-9)


def test_many_pressures_at_once_equal_one_by_one(chain: Chain) -> None:
    outlet = Outlet(chain.regulator, BENT)
    pressures = np.linspace(20e3, 480e3, 24).reshape(2, 12)
    currents = np.asarray(outlet.current(pressures))
    alone = [outlet.current(float(pressure)) for pressure in pressures.flat]
    assert currents.ravel() == pytest.approx(alone, rel=1e-12)
    assert currents.shape == pressures.shape


def test_a_pressure_that_no_current_gives_has_that_of_the_leap(chain: Chain) -> None:
    suppressed = ValveOffset(offset=15e3, zero=Zero.SUPPRESSED)
    outlet = Outlet(chain.regulator, (suppressed,))
    # It leaps from 5 to 20 kPa at 1 % of 16 mA.
    for pressure in (6e3, 10e3, 19e3):
        assert outlet.current(pressure) == pytest.approx(0.00416, abs=1e-9)
    assert outlet.current(20.5e3) > 0.00416
    assert outlet.pressure(0.004) == 0.0


@pytest.mark.parametrize("share", [1.0, 1.2])
def test_under_a_ceiling_the_rising_side_answers(chain: Chain, share: float) -> None:
    outlet = Outlet(chain.regulator, (SupplySaturation(share=share, limit=0.8),))
    assert outlet.current(300e3) == pytest.approx(0.004 + 0.016 * 0.6, rel=1e-9)


def test_a_pressure_above_the_ceiling_is_refused(chain: Chain) -> None:
    outlet = Outlet(chain.regulator, (SupplySaturation(share=1.0, limit=0.8),))
    said = r"does not reach 450 kPa: with supply_saturation it gives -500 to 400 kPa"
    with pytest.raises(DomainError, match=said) as refused:
        outlet.current(450e3)
    assert refused.value.key == "pressure_kPa"


def test_of_many_pressures_the_worst_is_named(chain: Chain) -> None:
    outlet = Outlet(chain.regulator, (SupplySaturation(share=1.0, limit=0.8),))
    with pytest.raises(DomainError, match="does not reach 480 kPa"):
        outlet.current(np.array([100e3, 450e3, 480e3]))


def test_what_is_no_number_is_refused(chain: Chain) -> None:
    with pytest.raises(DomainError, match="nan kPa"):
        Outlet(chain.regulator, BENT).current(float("nan"))
