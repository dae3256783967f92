import pytest

from gripperd.control.force import ForceSense, grip_force
from gripperd.model import Chain, PressedObject
from gripperd.signals import Measurement, Quality, Reading

BROKEN = Reading.bad("the loop is broken")
PERIOD = 0.01


def measured(
    grip: Reading, pressure: float | None = None, opening: float | None = None
) -> Measurement:
    return Measurement(
        time=0.0,
        current=Reading(0.0107),
        pressure=BROKEN if pressure is None else Reading(pressure),
        opening=BROKEN if opening is None else Reading(opening),
        grip=grip,
    )


def test_a_measured_force_is_believed_over_the_model(chain: Chain) -> None:
    reading = grip_force(measured(Reading(7.0), 209_375.0, 0.065), chain)
    assert reading == Reading(7.0)


def test_a_broken_sensor_is_replaced_by_the_model_and_says_so(chain: Chain) -> None:
    reading = grip_force(measured(BROKEN, 209_375.0, 0.065), chain)
    assert reading.quality is Quality.SUBSTITUTED
    assert reading.cause == "the loop is broken"
    # The paper's 10.7 mA on a rigid object of 65 mm.
    assert reading.value == pytest.approx(47.6, abs=0.05)
    predicted = chain.predict(0.0107, PressedObject(0.065)).grip_force
    assert reading.value == pytest.approx(predicted)


def test_a_slack_muscle_presses_on_nothing(chain: Chain) -> None:
    reading = grip_force(measured(BROKEN, 0.0, 0.065), chain)
    assert reading.value == 0.0


@pytest.mark.parametrize(
    ("pressure", "opening"), [(None, 0.065), (209_375.0, None), (None, None)]
)
def test_without_pressure_or_opening_there_is_no_force(
    chain: Chain, pressure: float | None, opening: float | None
) -> None:
    reading = grip_force(measured(BROKEN, pressure, opening), chain)
    assert reading.value is None
    assert reading.quality is Quality.BAD


def test_an_opening_the_braid_cannot_reach_is_no_force(chain: Chain) -> None:
    reading = grip_force(measured(BROKEN, 209_375.0, 0.2), chain)
    assert reading.value is None
    assert "braid" in reading.cause


def test_one_spike_is_no_contact(chain: Chain) -> None:
    sense = ForceSense(chain)
    touching = []
    for force in (0.0, 50.0, 0.0, 0.5, 0.5, 0.5):
        sense.update(measured(Reading(force)), PERIOD)
        touching.append(sense.touching)
    assert touching == [False, False, False, False, True, True]


def test_the_filter_follows_within_its_time_constant(chain: Chain) -> None:
    sense = ForceSense(chain)
    sense.update(measured(Reading(0.0)), PERIOD)
    for _ in range(10):
        sense.update(measured(Reading(10.0)), PERIOD)
    # One time constant of 0.1 s: 1 - 0.9^10 of the step.
    assert sense.filtered == pytest.approx(6.51, abs=0.01)


def test_a_lost_sensor_leaves_no_old_force(chain: Chain) -> None:
    sense = ForceSense(chain)
    for _ in range(3):
        sense.update(measured(Reading(10.0)), PERIOD)
    sense.update(measured(BROKEN), PERIOD)
    assert sense.filtered is None
    assert not sense.touching


def sensed(sense: ForceSense, force: float, opening: float, seconds: float) -> Quality:
    """Quality after the sensor has said the same for so long, at 10.7 mA."""
    for _ in range(round(seconds / PERIOD)):
        sense.update(measured(Reading(force), 209_375.0, opening), PERIOD)
    return sense.now.quality


def test_a_sensor_at_rest_is_believed_as_long_as_the_model_agrees(
    chain: Chain,
) -> None:
    # 47.6 N on a rigid object of 65 mm; 10 N more or less are within the doubt.
    for force in (47.6, 39.0, 56.0):
        assert sensed(ForceSense(chain), force, 0.065, 2.0) is Quality.GOOD


@pytest.mark.parametrize("force", [0.0, 36.0, 60.0])
def test_a_sensor_at_rest_is_doubted_when_the_model_contradicts(
    chain: Chain, force: float
) -> None:
    sense = ForceSense(chain)
    assert sensed(sense, force, 0.065, 0.15) is Quality.GOOD
    assert sensed(sense, force, 0.065, 0.15) is Quality.SUBSTITUTED
    assert f"stuck at {force:.2f} N" in sense.now.cause
    assert sense.now.value == pytest.approx(47.6, abs=0.05)


def test_a_sensor_that_moves_again_is_believed_again(chain: Chain) -> None:
    sense = ForceSense(chain)
    sensed(sense, 0.0, 0.065, 1.0)
    assert sensed(sense, 0.01, 0.065, PERIOD) is Quality.GOOD
