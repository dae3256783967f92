from dataclasses import replace

import pytest

from gripperd.demo.hidden import Hidden
from gripperd.diagnose.verdict.figures import chance, fixed, stopped
from gripperd.diagnose.verdict.named import Estimate
from tests.demonstration import example


@pytest.mark.parametrize(
    ("value", "std", "said"),
    [
        (18.3142, 0.0937, "18.314"),
        (0.02986, 0.014, "0.030"),
        (470.9, 48.0, "471"),
        (224.6, 118.0, "220"),
        (-0.0001, 0.097, "0.000"),
        (61.437, 8.4, "61.4"),
        (-5.945e-6, 1.296e-6, "-0.0000059"),
        (0.15, 1e-14, "0.150000"),
        (61.437, 0.0, "61.44"),
        (61.437, float("inf"), "61.44"),
    ],
)
def test_no_digit_is_told_that_means_nothing(
    value: float, std: float, said: str
) -> None:
    assert fixed(value, std) == said


@pytest.mark.parametrize(
    ("p_value", "said"),
    [(0.0, "< 1e-99"), (7e-264, "< 1e-99"), (4e-30, "4e-30"), (0.034, "0.03")],
)
def test_no_chance_is_called_zero(p_value: float, said: str) -> None:
    assert chance(p_value) == said


def test_what_a_bound_holds_is_known() -> None:
    one = example(Hidden.CREEP)[1].named[0].parameters["fast"]
    # What creeps goes one way.
    assert (one.low, one.high) == (0.0, 0.15)
    assert stopped(replace(one, value=0.15))
    assert not stopped(one)
    assert not stopped(Estimate(0.0, 0.1))
