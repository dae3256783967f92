import pytest

from gripperd.control.force import ForceSense
from gripperd.signals import Measurement, Reading

BROKEN = Reading.bad("the loop is broken")
PERIOD = 0.01


def measured(grip: Reading) -> Measurement:
    return Measurement(time=0.0, current=Reading(0.0107), grip=grip)


def test_one_spike_is_no_contact() -> None:
    sense = ForceSense()
    touching = []
    for force in (0.0, 50.0, 0.0, 0.5, 0.5, 0.5):
        sense.update(measured(Reading(force)), PERIOD)
        touching.append(sense.touching)
    assert touching == [False, False, False, False, True, True]


def test_the_filter_follows_within_its_time_constant() -> None:
    sense = ForceSense()
    sense.update(measured(Reading(0.0)), PERIOD)
    for _ in range(10):
        sense.update(measured(Reading(10.0)), PERIOD)
    # One time constant of 0.1 s: 1 - 0.9^10 of the step.
    assert sense.filtered == pytest.approx(6.51, abs=0.01)


def test_a_lost_sensor_leaves_no_old_force() -> None:
    sense = ForceSense()
    for _ in range(3):
        sense.update(measured(Reading(10.0)), PERIOD)
    sense.update(measured(BROKEN), PERIOD)
    assert sense.filtered is None
    assert not sense.touching
