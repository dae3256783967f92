import pytest

from gripperd.control.states import Grip
from gripperd.control.watch import GripWatch
from gripperd.signals import Measurement, Reading

PERIOD = 0.01
BROKEN = Reading.bad("the loop is broken")


def look(
    watch: GripWatch, grip: Reading, pressure: Reading = BROKEN, samples: int = 1
) -> None:
    measured = Measurement(
        time=0.0, current=Reading(0.0107), pressure=pressure, grip=grip
    )
    for _ in range(samples):
        watch.update(measured, PERIOD)


@pytest.mark.parametrize(
    ("grip", "pressure", "seen"),
    [
        (Reading(5.0), Reading(100e3), Grip.HOLDING),
        (Reading(0.0), Reading(100e3), Grip.NO_PART),
        (Reading(0.0), Reading(9.9e3), Grip.RELEASED),
        (Reading(0.0), Reading(10.1e3), Grip.NO_PART),
        (BROKEN, Reading(0.0), Grip.RELEASED),
        (BROKEN, Reading(100e3), Grip.UNKNOWN),
        (BROKEN, BROKEN, Grip.UNKNOWN),
    ],
)
def test_what_the_jaws_are_seen_to_do(
    grip: Reading, pressure: Reading, seen: Grip
) -> None:
    watch = GripWatch()
    look(watch, grip, pressure, samples=3)
    assert watch.seen() is seen


def test_a_part_is_lost_after_five_samples_without_contact() -> None:
    watch = GripWatch()
    look(watch, Reading(5.0), samples=3)
    look(watch, Reading(0.0), samples=4)
    assert not watch.lost
    look(watch, Reading(0.0))
    assert watch.lost


def test_a_part_that_is_felt_again_is_not_lost() -> None:
    watch = GripWatch()
    look(watch, Reading(5.0), samples=3)
    look(watch, Reading(0.0), samples=4)
    look(watch, Reading(5.0), samples=2)
    look(watch, Reading(0.0), samples=4)
    assert not watch.lost


def test_who_sees_nothing_claims_no_loss() -> None:
    watch = GripWatch()
    look(watch, Reading(5.0), samples=3)
    look(watch, BROKEN, samples=100)
    assert not watch.lost
