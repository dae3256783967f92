import pytest

from gripperd.control.states import (
    GRIPS,
    SIGNS,
    TRANSITIONS,
    Event,
    Grip,
    Machine,
    Sign,
    after,
    gripped,
    possible,
)
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
estopped       reset          disabled
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
    words = {Event.START: "a command"}.get(event, event)
    with pytest.raises(Refused, match=f"{words} is not possible while") as refused:
        after(state, event)
    assert f"while the gripper is {state}" in str(refused.value)
    assert refused.value.code == "wrong-state"
    (hint,) = refused.value.hints
    offered = hint.split(": ")[1].split(", ")
    for asked in (Event.ENABLE, Event.DISABLE, Event.STOP):
        assert (asked in TRANSITIONS[state]) == (asked in offered)
    assert (state in {Machine.FAULT, Machine.ESTOPPED}) == ("reset" in offered)


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


@pytest.mark.parametrize(
    "state", sorted(set(Machine) - {Machine.OFFLINE, Machine.ATTACHING})
)
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


@pytest.mark.parametrize("state", sorted(set(Machine) - {Machine.OFFLINE}))
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


def test_only_a_reset_or_a_lost_link_ends_an_emergency_stop() -> None:
    allowed = TRANSITIONS[Machine.ESTOPPED]
    leaving = {event for event in allowed if allowed[event] is not Machine.ESTOPPED}
    assert leaving == {Event.RESET, Event.LINK_LOST}


ANYWHERE = {"open": "releasing", "contact": "holding", "doubt": "unknown"}
EMPTY = ANYWHERE | {
    "close": "closing",
    "move": "moving",
    "miss": "no_part",
    "let_go": "released",
}
GONE = dict.fromkeys(("loss", "miss", "let_go"), "part_lost")
GRIP_PROMISED = {
    "unknown": EMPTY | {"loss": "part_lost"},
    "released": EMPTY,
    "closing": EMPTY | {"loss": "part_lost"},
    "holding": ANYWHERE | GONE,
    "no_part": EMPTY,
    "part_lost": ANYWHERE | GONE | {"close": "closing", "move": "moving"},
    "releasing": EMPTY,
    "moving": EMPTY | {"loss": "part_lost"},
}


def test_the_grip_table_is_what_was_promised() -> None:
    found = {
        str(grip): {str(sign): str(target) for sign, target in allowed.items()}
        for grip, allowed in GRIPS.items()
    }
    assert found == GRIP_PROMISED


@pytest.mark.parametrize("grip", Grip)
@pytest.mark.parametrize("sign", Sign)
def test_every_pair_of_the_grip_is_in_the_table_or_refused(
    grip: Grip, sign: Sign
) -> None:
    promised = GRIP_PROMISED[grip].get(sign)
    if promised is not None:
        assert gripped(grip, sign) == promised
        return
    with pytest.raises(Refused, match=f"{sign} does not follow") as refused:
        gripped(grip, sign)
    assert f"while the grip is {grip}" in str(refused.value)
    (hint,) = refused.value.hints
    assert set(hint.split(": ")[1].split(", ")) == set(GRIP_PROMISED[grip])


def test_what_is_held_never_vanishes_without_a_loss() -> None:
    ways = {sign for sign, target in GRIPS[Grip.HOLDING].items()}
    assert {GRIPS[Grip.HOLDING][sign] for sign in ways} == {
        Grip.HOLDING,
        Grip.RELEASING,
        Grip.UNKNOWN,
        Grip.PART_LOST,
    }


def test_each_grip_has_a_sign_that_leads_to_it() -> None:
    for grip in Grip:
        assert any(table.get(SIGNS[grip]) is grip for table in GRIPS.values())


def test_a_fault_offers_its_reset() -> None:
    assert Event.RESET in possible(Machine.FAULT)
    assert Event.START not in possible(Machine.FAULT)
