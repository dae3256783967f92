from dataclasses import replace
from itertools import count

import pytest

from gripperd.control.faults import HISTORY, Faults
from gripperd.control.journal import Journal
from gripperd.control.monitors.policy import Cause, Policy, Reaction
from gripperd.control.monitors.sight import Symptom
from gripperd.control.snapshot import Instant
from gripperd.errors import NotFound, Refused

BURST = Symptom(Cause.BURST, "the muscle burst")
SAG = Symptom(Cause.SUPPLY_SAG, "the supply sags")
LATCHED = Policy(after=0.0, latched=True)
PASSING = Policy(after=0.0, reaction=Reaction.HOLD)


def at(seconds: float) -> Instant:
    return Instant(seconds, 1e9 + seconds)


@pytest.fixture
def journal() -> Journal:
    return Journal()


@pytest.fixture
def faults(journal: Journal) -> Faults:
    ids = count(1)
    return Faults("g0", lambda: f"f{next(ids)}", journal)


def test_a_symptom_that_lasts_is_one_fault(faults: Faults) -> None:
    (raised,) = faults.update([(SAG, PASSING)], 0.01, at(0.0))
    assert faults.update([(SAG, PASSING)], 0.01, at(0.01)) == []
    assert faults.newest(10) == [raised]
    assert (raised.message, raised.raised_at) == ("the supply sags", 1e9)


def test_two_channels_with_the_same_cause_are_two_faults(faults: Faults) -> None:
    cut = [
        (Symptom(Cause.SENSOR_FAILED, "cut", channel), PASSING)
        for channel in ("grip", "opening")
    ]
    assert len(faults.update(cut, 0.01, at(0.0))) == 2
    assert faults.update(cut, 0.01, at(0.01)) == []


def test_a_cause_is_gone_after_a_second_without_its_symptom(faults: Faults) -> None:
    faults.update([(SAG, PASSING)], 0.01, at(0.0))
    faults.update([], 0.9, at(0.9))
    assert faults.newest(1)[0].active
    faults.update([], 0.2, at(1.1))
    gone = faults.newest(1)[0]
    assert (gone.active, gone.cleared_at) == (False, 1e9 + 1.1)
    (again,) = faults.update([(SAG, PASSING)], 0.01, at(2.0))
    assert again.id != gone.id


def test_a_symptom_that_flickers_stays_one_fault(faults: Faults) -> None:
    for step in range(100):
        told = [(SAG, PASSING)] if step % 10 == 0 else []
        faults.update(told, 0.1, at(0.1 * step))
    assert len(faults.newest(10)) == 1


def test_a_latched_fault_stays_after_its_cause_is_gone(faults: Faults) -> None:
    faults.update([(BURST, LATCHED)], 0.01, at(0.0))
    faults.update([], 5.0, at(5.0))
    (fault,) = faults.latched
    assert fault.active
    assert fault.cleared_at == 1e9 + 5.0


def test_a_cause_that_comes_back_is_not_gone(faults: Faults) -> None:
    faults.update([(BURST, LATCHED)], 0.01, at(0.0))
    faults.update([], 5.0, at(5.0))
    faults.update([(BURST, LATCHED)], 0.01, at(5.1))
    assert faults.latched[0].cleared_at is None
    faults.acknowledge("f1", "Ada", at(6.0))
    with pytest.raises(Refused, match="still so: the muscle burst") as refused:
        faults.reset(at(6.0))
    assert refused.value.code == "cause-present"


def test_a_reset_takes_every_acknowledgement(faults: Faults) -> None:
    other = Symptom(Cause.VALVE_NOT_FOLLOWING, "the valve is stuck")
    faults.update([(BURST, LATCHED), (other, LATCHED)], 0.01, at(0.0))
    faults.update([], 2.0, at(2.0))
    faults.acknowledge("f1", "Ada", at(3.0))
    with pytest.raises(Refused, match="not acknowledged yet: the valve") as refused:
        faults.reset(at(3.0))
    assert refused.value.hints == ("POST .../faults/f2/acknowledge",)
    faults.acknowledge("f2", "Ada", at(3.0))
    faults.reset(at(4.0))
    assert faults.latched == ()
    assert {fault.reset_at for fault in faults.newest(2)} == {1e9 + 4.0}


def test_the_first_acknowledgement_counts(faults: Faults) -> None:
    faults.update([(BURST, LATCHED)], 0.01, at(0.0))
    faults.acknowledge("f1", "Ada", at(1.0))
    again = faults.acknowledge("f1", "Bob", at(2.0))
    assert (again.acknowledged_by, again.acknowledged_at) == ("Ada", 1e9 + 1.0)


def test_an_unknown_fault_is_not_found(faults: Faults) -> None:
    with pytest.raises(NotFound, match="no fault 'f9'"):
        faults.acknowledge("f9", "Ada", at(0.0))


def test_the_history_forgets_the_oldest_but_nothing_that_is_active(
    faults: Faults,
) -> None:
    faults.update([(BURST, LATCHED)], 0.01, at(0.0))
    for step in range(HISTORY + 10):
        faults.update([(BURST, LATCHED), (SAG, PASSING)], 0.01, at(step))
        faults.update([(BURST, LATCHED)], 2.0, at(step + 0.5))
    kept = faults.newest(10 * HISTORY)
    assert len(kept) == HISTORY
    assert kept[-1].id == "f1"


def test_what_happens_is_told_in_the_journal(faults: Faults, journal: Journal) -> None:
    faults.update([(BURST, LATCHED)], 0.01, at(0.0))
    faults.acknowledge("f1", "Ada", at(1.0))
    faults.update([], 2.0, at(2.0))
    faults.reset(at(3.0))
    assert [entry.text for entry in journal.since(0)] == [
        "burst: the muscle burst",
        "burst acknowledged by Ada",
        "burst cleared",
        "burst reset",
    ]


def test_a_new_life_goes_on_with_what_was_latched(faults: Faults) -> None:
    faults.update([(BURST, LATCHED)], 0.01, at(0.0))
    (burst,) = faults.latched
    gone = replace(burst, id="f7", subject="2", cleared_at=1e9 + 1.0)
    journal = Journal()
    later = Faults("g0", lambda: "new", journal)
    later.adopt([burst, gone])
    assert later.update([(BURST, LATCHED)], 0.01, at(9.0)) == []
    assert later.latched == (burst, gone)
    assert journal.newest == 0
    later.update([], 2.0, at(11.0))
    assert [entry.text for entry in journal.since(0)] == ["burst cleared"]
    with pytest.raises(Refused, match="not acknowledged yet"):
        later.reset(at(12.0))
