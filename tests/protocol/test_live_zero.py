from math import nan

import pytest

from gripperd.config.module_library import ModuleLibrary
from gripperd.protocol.live_zero import LoopScale
from gripperd.signals import Quality

GAUGE = LoopScale(
    current_low=0.004, current_high=0.020, value_low=0.0, value_high=600e3
)
RANGE = ModuleLibrary().input("waveshare_ai_8ch").range()


@pytest.mark.parametrize(
    ("current", "pressure"),
    [(0.004, 0.0), (0.012, 300e3), (0.020, 600e3), (0.0038, -7.5e3), (0.0205, 618750)],
)
def test_the_line_goes_through_both_ends_and_on(
    current: float, pressure: float
) -> None:
    reading = GAUGE.reading(current)
    assert reading.quality is Quality.GOOD
    assert reading.value == pytest.approx(pressure)
    assert GAUGE.current(pressure) == pytest.approx(current)


def test_a_span_may_start_above_zero_and_fall() -> None:
    falling = LoopScale(
        current_low=0.004, current_high=0.020, value_low=0.1, value_high=0.02
    )
    assert falling.reading(0.012).value == pytest.approx(0.06)
    assert falling.current(0.02) == pytest.approx(0.020)


@pytest.mark.parametrize("microamperes", [0, 3599, 21_001, 65_535])
def test_outside_3_6_to_21_milliamperes_the_loop_is_broken(microamperes: int) -> None:
    reading = GAUGE.reading(RANGE.current(microamperes))
    assert reading.quality is Quality.BAD
    assert reading.value is None
    assert f"{microamperes / 1000:.3f} mA" in reading.cause


@pytest.mark.parametrize("microamperes", [3600, 21_000])
def test_at_3_6_and_at_21_milliamperes_it_still_speaks(microamperes: int) -> None:
    assert GAUGE.reading(RANGE.current(microamperes)).quality is Quality.GOOD


def test_no_number_is_no_reading() -> None:
    reading = GAUGE.reading(nan)
    assert reading.value is None
    assert reading.cause == "the loop is broken: its current is not a number"


def test_a_current_beyond_all_sense_is_told_in_a_few_digits() -> None:
    cause = "the loop is broken: 3e+38 mA is above 21 mA"
    assert GAUGE.reading(3e35).cause == cause
