import pytest

from gripperd.control.states import TRANSITIONS, Event, Machine, after
from gripperd.errors import Refused

MOVING = {Machine.EXECUTING}
ENABLED = {Machine.READY, Machine.EXECUTING}


PROMISED = """
offline        link_up        attaching
attaching      adopt          disabled
attaching      stop           attaching
disabled       enable         ready
disabled       maintain       maintenance
disabled       stop           disabled
ready          start          executing
ready          disable        disabled
ready          stop           stopping
executing      finish         ready
executing      stop           stopping
stopping       rest           ready
stopping       stop           stopping
fault_reaction reacted        fault
fault_reaction stop           fault_reaction
fault          reset          disabled
fault          stop           fault
estopped       estop_released disabled
estopped       estop          estopped
estopped       fail           estopped
estopped       stop           estopped
maintenance    maintained     disabled
maintenance    stop           maintenance
"""
"""What the documents promise, besides: wherever there is a link, losing it leads to
offline; and outside an emergency stop a fault to fault_reaction, an estop to estopped.
"""


def promised() -> dict[tuple[str, str], str]:
    rows = (line.split() for line in PROMISED.strip().splitlines())
    table = {(state, event): target for state, event, target in rows}
    for state in set(Machine) - {Machine.OFFLINE}:
        table[state, "link_lost"] = "offline"
        if state is not Machine.ESTOPPED:
            table[state, "fail"] = "fault_reaction"
            table[state, "estop"] = "estopped"
    return table


def test_the_table_is_what_was_promised() -> None:
    found = {
        (str(state), str(event)): str(target)
        for state, allowed in TRANSITIONS.items()
        for event, target in allowed.items()
    }
    assert found == promised()


@pytest.mark.parametrize("state", Machine)
@pytest.mark.parametrize("event", Event)
def test_every_pair_is_in_the_table_or_refused_with_hints(
    state: Machine, event: Event
) -> None:
    if event in TRANSITIONS[state]:
        assert after(state, event) is TRANSITIONS[state][event]
        return
    words = "a command" if event is Event.START else event
    with pytest.raises(Refused, match=f"{words} is not possible while") as refused:
        after(state, event)
    assert f"while the gripper is {state}" in str(refused.value)
    assert refused.value.code == "wrong-state"
    (hint,) = refused.value.hints
    for asked in (Event.ENABLE, Event.DISABLE, Event.STOP, Event.RESET):
        assert (asked in TRANSITIONS[state]) == (
            asked in hint.split(": ")[1].split(", ")
        )


def test_every_state_can_be_reached_from_offline() -> None:
    reached = {Machine.OFFLINE}
    while (
        more := {state for start in reached for state in TRANSITIONS[start].values()}
        - reached
    ):
        reached |= more
    assert reached == set(Machine)


def test_every_event_means_something() -> None:
    used = {event for allowed in TRANSITIONS.values() for event in allowed}
    assert used == set(Event)


@pytest.mark.parametrize("state", Machine)
def test_a_stop_never_leads_to_motion_nor_to_readiness(state: Machine) -> None:
    target = TRANSITIONS[state].get(Event.STOP)
    assert target not in MOVING | ENABLED


@pytest.mark.parametrize("state", set(Machine) - {Machine.OFFLINE, Machine.ATTACHING})
def test_a_stop_is_possible_wherever_the_state_is_known(state: Machine) -> None:
    assert Event.STOP in TRANSITIONS[state]


def test_only_a_start_leads_to_motion() -> None:
    for allowed in TRANSITIONS.values():
        for event, target in allowed.items():
            assert target not in MOVING or event is Event.START


def test_motion_starts_only_when_ready() -> None:
    assert [
        state for state, allowed in TRANSITIONS.items() if Event.START in allowed
    ] == [Machine.READY]


@pytest.mark.parametrize("state", set(Machine) - {Machine.OFFLINE})
def test_a_lost_link_is_offline_whatever_was_going_on(state: Machine) -> None:
    assert after(state, Event.LINK_LOST) is Machine.OFFLINE


def test_after_a_link_nothing_is_enabled_unasked() -> None:
    state = Machine.OFFLINE
    for event in (Event.LINK_UP, Event.ADOPT):
        state = after(state, event)
    assert state is Machine.DISABLED


def test_a_stop_enables_nothing_that_was_not_enabled_before() -> None:
    for state, allowed in TRANSITIONS.items():
        if allowed.get(Event.STOP) is Machine.STOPPING:
            assert state in ENABLED | {Machine.STOPPING}


def test_only_its_release_or_a_lost_link_ends_an_emergency_stop() -> None:
    allowed = TRANSITIONS[Machine.ESTOPPED]
    leaving = {event for event in allowed if allowed[event] is not Machine.ESTOPPED}
    assert leaving == {Event.ESTOP_RELEASED, Event.LINK_LOST}
