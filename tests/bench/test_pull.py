import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gripperd.bench.pull import PullTable
from gripperd.model import Chain, Direction

SHUT = 0.085


@pytest.fixture(scope="module")
def table(chain: Chain) -> PullTable:
    return PullTable(chain.static, 500e3, SHUT)


@given(pressure=st.floats(0.0, 800e3), contraction=st.floats(0.0, SHUT))
@settings(max_examples=300, deadline=None, derandomize=True)
def test_the_table_is_the_model_to_a_twentieth_of_a_newton(
    chain: Chain, table: PullTable, pressure: float, contraction: float
) -> None:
    contracting, extending = table.at(pressure, contraction)
    force = chain.static.force
    assert contracting == pytest.approx(
        force(pressure, contraction, Direction.CONTRACTING), abs=0.05
    )
    assert extending == pytest.approx(
        force(pressure, contraction, Direction.EXTENDING), abs=0.05
    )


@given(contraction=st.floats(0.0, SHUT))
@settings(max_examples=100, deadline=None, derandomize=True)
def test_under_working_pressure_the_table_is_good_to_a_hundredth(
    chain: Chain, table: PullTable, contraction: float
) -> None:
    assert table.at(209_375.0, contraction)[0] == pytest.approx(
        chain.static.force(209_375.0, contraction), abs=0.01
    )


def test_the_table_reaches_to_the_closed_stop(chain: Chain, table: PullTable) -> None:
    assert table.at(500e3, SHUT)[1] == pytest.approx(
        chain.static.force(500e3, SHUT, Direction.EXTENDING), abs=0.01
    )


def test_there_is_no_jump_between_cells(table: PullTable) -> None:
    for corner in (5e-4, 0.01, 0.05):
        below = table.at(150e3 - 1e-6, corner - 1e-12)
        above = table.at(150e3, corner)
        assert below == pytest.approx(above, abs=1e-6)
