"""The state document, from snapshots as control gives them."""

import pytest

from gripperd.config import Settings, load_model, shipped
from gripperd.control.snapshot import GripperState
from gripperd.control.states import Event, Grip, Machine
from gripperd.service.state import state_document
from gripperd.signals import ABSENT, Measurement, Quality, Reading

REFERENCE = load_model(shipped("models/reference.yaml")).chain()


def snapshot(age: float | None, **channels: Reading) -> GripperState:
    measured = Measurement(time=0.0, current=Reading(10.7e-3), **channels)
    return GripperState(
        name="g0",
        machine=Machine.READY,
        grip=Grip.HOLDING,
        available_transitions=(Event.STOP,),
        adopted=False,
        current=10.7e-3,
        measured=None if age is None else measured,
        age=age,
        command=None,
        holding="apple",
        link="up",
        model="reference",
        model_digest=REFERENCE.digest,
    )


def test_an_old_value_is_not_repeated(settings: Settings) -> None:
    for age, value, quality in [(0.5, 209.375, "good"), (0.501, None, "stale")]:
        state = snapshot(age, pressure=Reading(209.375e3))
        found = state_document(state, settings.grippers["g0"]).measured.pressure_kPa
        assert (found.value, found.quality) == (value, quality)


def test_an_absent_sensor_stays_absent_however_old(settings: Settings) -> None:
    state = snapshot(9.0, grip=ABSENT)
    found = state_document(state, settings.grippers["g0"]).measured.force_N
    assert found.quality is Quality.ABSENT


def test_the_prediction_is_that_of_the_design(settings: Settings) -> None:
    # 47.6 N on an apple of 65 mm at 10.7 mA, contracting.
    state = snapshot(0.01, opening=Reading(65e-3))
    found = state_document(state, settings.grippers["g0"]).prediction
    assert found is not None
    assert found.force_N == pytest.approx(47.6, abs=0.05)
    assert 0 < found.std_N < 5


def test_an_old_measurement_gives_no_prediction(settings: Settings) -> None:
    state = snapshot(0.6, opening=Reading(65e-3))
    assert state_document(state, settings.grippers["g0"]).prediction is None


def test_a_bad_reading_keeps_its_cause(settings: Settings) -> None:
    state = snapshot(0.01, opening=Reading.bad("2.1 mA is under 3.6 mA"))
    found = state_document(state, settings.grippers["g0"]).measured.opening_mm
    assert (found.value, found.cause) == (None, "2.1 mA is under 3.6 mA")


def test_each_contact_says_whether_it_is_closed(settings: Settings) -> None:
    cut = Reading.bad("the loop is broken: 0.000 mA is below 3.6 mA")
    for reading, expected in [
        (Reading(1.0), True),
        (Reading(0.0), False),
        (cut, False),
        (ABSENT, None),
    ]:
        state = snapshot(0.01, enable=reading, estop=Reading(1.0))
        found = state_document(state, settings.grippers["g0"]).interlocks
        assert (found.enable, found.estop) == (expected, True)


def test_a_contact_that_was_not_read_lately_is_not_known(settings: Settings) -> None:
    for age in (0.6, None):
        state = snapshot(age, enable=Reading(1.0), estop=Reading(1.0))
        found = state_document(state, settings.grippers["g0"]).interlocks
        assert (found.enable, found.estop) == (None, None)
