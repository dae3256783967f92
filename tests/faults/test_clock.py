"""The clock on the wall steps, and nothing but the time stamps notices."""

from collections.abc import Iterator

import pytest

from tests.faults import clock
from tests.faults.clock import HOUR, Wall
from tests.faults.held import Held


@pytest.fixture(scope="module")
def on_the_wall() -> Iterator[tuple[Held, Wall]]:
    with clock.on_the_wall() as found:
        if found is None:
            pytest.skip("no compiler to make a clock that can be stepped")
        yield found


@pytest.mark.parametrize("seconds", [HOUR, -HOUR, -1])
def test_a_step_changes_neither_control_nor_leases_nor_the_order_of_records(
    on_the_wall: tuple[Held, Wall], seconds: int
) -> None:
    assert clock.stepped(*on_the_wall, f"{seconds} s", seconds).wrong == ()


def test_the_hour_that_is_told_twice_is_recorded_once(
    on_the_wall: tuple[Held, Wall],
) -> None:
    assert clock.told_twice(*on_the_wall).wrong == ()
