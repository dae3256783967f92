import pytest
from scipy import signal

from gripperd.control.pi import PI
from gripperd.control.tuning import Gains, simc

DT = 0.01
GAINS = Gains(proportional=0.5, integral_time=0.1)


def test_the_gains_are_those_of_the_rule_worked_by_hand() -> None:
    # Half rule: 60 + 15 = 75 ms and 15 + 15 = 30 ms; K = 75 / (120 + 30).
    gains = simc(slow=0.060, fast=0.030, delay=0.015, closed=0.120)
    assert gains.proportional == pytest.approx(0.5)
    assert gains.integral_time == pytest.approx(0.075)


def test_a_lag_much_longer_than_the_closed_loop_gets_a_shorter_integral_time() -> None:
    gains = simc(slow=10.0, fast=0.0, delay=0.5, closed=0.5)
    assert gains.integral_time == pytest.approx(4.0)


def test_a_constant_error_is_answered_as_the_textbook_has_it() -> None:
    pi = PI(GAINS)
    outputs = [pi.step(1.0, DT, -1e9, 1e9) for _ in range(100)]
    # K (1 + 1 / (T s)) on a unit step, after one second.
    _, response = signal.step(([0.05, 0.5], [0.1, 0.0]), T=[0.0, 1.0])
    assert outputs[-1] == pytest.approx(response[-1], rel=1e-6)


def test_it_starts_at_nothing_whatever_the_error() -> None:
    pi = PI(GAINS)
    pi.begin(3.0)
    assert pi.step(3.0, 1e-9, -10.0, 10.0) == pytest.approx(0.0, abs=1e-6)


def test_what_a_bound_cuts_off_is_not_kept_in_the_integral() -> None:
    pi = PI(GAINS)
    pi.begin(-1.0)
    assert pi.step(0.8, DT, -0.8, 0.8) == 0.8
    # Back by the proportional part at once: K times 0.8.
    assert pi.step(0.0, DT, -0.8, 0.8) == pytest.approx(0.4)


def test_an_error_that_it_could_not_close_is_left_alone() -> None:
    pi = PI(GAINS)
    for _ in range(1000):
        assert pi.step(2.0, DT, -1.0, 1.0) == 0.0
    assert abs(pi.step(0.2, DT, -1.0, 1.0)) < 1.0


def test_a_bound_that_closes_in_is_kept() -> None:
    pi = PI(GAINS)
    for _ in range(50):
        pi.step(0.3, DT, -1.0, 1.0)
    assert pi.step(0.3, DT, -0.1, 0.1) == 0.1
