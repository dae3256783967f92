from dataclasses import replace
from random import Random

import pytest

from gripperd.control.force import ForceSense
from gripperd.control.senses import Senses, grip_force
from gripperd.effects.linkage_friction import LinkageFriction
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


def sensed(senses: Senses, force: float, opening: float, seconds: float) -> Reading:
    """Force after the sensor has said the same for so long, at 10.7 mA."""
    raw = measured(Reading(force), 209_375.0, opening)
    for _ in range(round(seconds / PERIOD) - 1):
        senses.judge(raw, PERIOD)
    return senses.judge(raw, PERIOD).grip


def test_a_sensor_at_rest_is_believed_as_long_as_the_model_agrees(
    chain: Chain,
) -> None:
    # 47.6 N on a rigid object of 65 mm; 10 N more or less are within the doubt.
    for force in (47.6, 39.0, 56.0):
        assert sensed(Senses(chain), force, 0.065, 2.0).quality is Quality.GOOD


@pytest.mark.parametrize("force", [0.0, 36.0, 60.0])
def test_a_sensor_at_rest_is_doubted_when_the_model_contradicts(
    chain: Chain, force: float
) -> None:
    senses = Senses(chain)
    assert sensed(senses, force, 0.065, 0.15).quality is Quality.GOOD
    doubted = sensed(senses, force, 0.065, 0.15)
    assert doubted.quality is Quality.SUBSTITUTED
    assert f"stuck at {force:.2f} N" in doubted.cause
    assert doubted.value == pytest.approx(47.6, abs=0.05)


def test_a_sensor_that_moves_again_is_believed_again(chain: Chain) -> None:
    senses = Senses(chain)
    sensed(senses, 0.0, 0.065, 1.0)
    assert sensed(senses, 0.01, 0.065, PERIOD).quality is Quality.GOOD


def test_a_pressure_that_leaps_for_one_sample_is_never_shown(chain: Chain) -> None:
    senses = Senses(chain)
    said = (200e3, 200.5e3, 590e3, 200e3, 0.0, 200.5e3)
    shown = [
        senses.judge(measured(BROKEN, each, 0.065), PERIOD).pressure for each in said
    ]
    assert [each.value for each in shown] == [
        200e3,
        200.5e3,
        200.5e3,
        200e3,
        200e3,
        200.5e3,
    ]
    assert all(each.quality is Quality.GOOD for each in shown)


def test_a_pressure_full_of_spikes_is_bad_and_says_why(chain: Chain) -> None:
    senses = Senses(chain)
    said = (200e3, 590e3, 200e3, 0.0)
    *_, shown = (
        senses.judge(measured(BROKEN, each, 0.065), PERIOD).pressure
        for each in said * 3
    )
    assert (shown.quality, shown.value) == (Quality.BAD, None)
    assert shown.cause == "spikes: 3 or more within 1 s"


def test_spikes_do_not_pass_for_noise(chain: Chain) -> None:
    rng, senses = Random(1), Senses(chain)
    for number in range(3000):
        wild = rng.uniform(0.0, 590e3) if number % 10 == 5 else rng.gauss(200e3, 300.0)
        senses.judge(measured(BROKEN, wild, 0.065), PERIOD)
    assert senses.scatter.pressure < 600.0


def forces(senses: Senses, *raw: Reading) -> list[float | None]:
    """What comes out for a row of force samples."""
    return [senses.judge(measured(each), PERIOD).grip.value for each in raw]


def test_one_lie_among_truths_does_not_count(chain: Chain) -> None:
    said = [Reading(value) for value in (22.0, 22.1, 99.0, 22.2, 22.1, 0.0, 22.0)]
    found = forces(Senses(chain), *said)
    assert all(value is not None and 21.9 < value < 22.3 for value in found)


def test_a_gap_of_two_samples_is_bridged_and_a_third_is_told(chain: Chain) -> None:
    found = forces(Senses(chain), Reading(22.0), BROKEN, BROKEN, BROKEN, Reading(5.0))
    assert found == [22.0, 22.0, 22.0, None, 5.0]


def test_what_was_never_measured_is_not_made_up(chain: Chain) -> None:
    assert forces(Senses(chain), BROKEN, BROKEN) == [None, None]


def test_a_broken_sensor_is_replaced_with_what_the_joints_leave(chain: Chain) -> None:
    rubs = replace(chain, effects=(LinkageFriction(loss=0.1),))
    reading = grip_force(measured(BROKEN, 209_375.0, 0.065), rubs)
    # While closing the joints take a tenth of the 47.6 N.
    assert reading.value == pytest.approx(0.9 * 47.6, abs=0.05)


@pytest.mark.parametrize(("span", "contact"), [(100.0, 0.4), (500.0, 2.0)])
def test_contact_is_what_stands_out_of_the_noise_that_a_span_implies(
    chain: Chain, span: float, contact: float
) -> None:
    # 8 sigma of 0.05 % of the span.
    for share, touching in ((0.98, False), (1.02, True)):
        senses, force = Senses(chain, {"grip": span}), ForceSense()
        for _ in range(5):
            raw = measured(Reading(share * contact))
            force.update(senses.judge(raw, PERIOD), PERIOD)
        assert force.touching is touching


def test_contact_follows_a_sensor_that_is_noisier_than_its_span_implies(
    chain: Chain,
) -> None:
    rng, senses, force = Random(1), Senses(chain), ForceSense()
    for _ in range(3000):
        raw = measured(Reading(rng.gauss(0.0, 0.2)))
        force.update(senses.judge(raw, PERIOD), PERIOD)
        assert not force.touching
    assert senses.scatter.grip == pytest.approx(0.2, rel=0.15)
