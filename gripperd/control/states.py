"""The two state machines of a gripper, as tables.

The machine state says what is allowed; the grip state says what the jaws hold. A missed
grasp changes the second, never the first.
"""

from collections.abc import Mapping
from enum import StrEnum
from types import MappingProxyType

from gripperd.errors import Refused


class Machine(StrEnum):
    """Availability of the gripper."""

    OFFLINE = "offline"
    """No link to the valve; the module keeps the last current."""
    ATTACHING = "attaching"
    """Reading the actual state; nothing is written."""
    DISABLED = "disabled"
    """The current stays where it was found until someone enables."""
    READY = "ready"
    EXECUTING = "executing"
    STOPPING = "stopping"
    """A stop froze the current; the jaws are coming to rest."""
    FAULT_REACTION = "fault_reaction"
    FAULT = "fault"
    """Latched until acknowledged and reset."""
    ESTOPPED = "estopped"
    MAINTENANCE = "maintenance"


class Event(StrEnum):
    """What moves the machine from state to state."""

    LINK_UP = "link_up"
    LINK_LOST = "link_lost"
    ADOPT = "adopt"
    ENABLE = "enable"
    DISABLE = "disable"
    START = "start"
    FINISH = "finish"
    STOP = "stop"
    REST = "rest"
    FAIL = "fail"
    REACTED = "reacted"
    RESET = "reset"
    ESTOP = "estop"
    MAINTAIN = "maintain"
    MAINTAINED = "maintained"


class Grip(StrEnum):
    """What the jaws are known to do."""

    UNKNOWN = "unknown"
    RELEASED = "released"
    CLOSING = "closing"
    HOLDING = "holding"
    NO_PART = "no_part"
    PART_LOST = "part_lost"
    RELEASING = "releasing"
    MOVING = "moving"


class Sign(StrEnum):
    """What tells of the jaws: the beginning of a motion, or what is seen."""

    CLOSE = "close"
    OPEN = "open"
    MOVE = "move"
    CONTACT = "contact"
    """They press on something."""
    MISS = "miss"
    """They press on nothing."""
    LOSS = "loss"
    """What they pressed on is gone."""
    LET_GO = "let_go"
    """They are open, without pressure and force."""
    DOUBT = "doubt"
    """Nothing that is seen can tell."""


APART = frozenset({Machine.OFFLINE, Machine.ATTACHING})
"""States in which it is not known what the module does."""
BOUND = frozenset({Machine.FAULT_REACTION, Machine.FAULT, Machine.ESTOPPED})
"""States that only a person ends; nothing that is latched has more to stop in them."""

_ONLINE = {
    Event.LINK_LOST: Machine.OFFLINE,
    Event.FAIL: Machine.FAULT_REACTION,
    Event.ESTOP: Machine.ESTOPPED,
}

TRANSITIONS: Mapping[Machine, Mapping[Event, Machine]] = MappingProxyType(
    {
        Machine.OFFLINE: {Event.LINK_UP: Machine.ATTACHING},
        # Before it is known what is there, a stop has nothing to freeze.
        Machine.ATTACHING: _ONLINE
        | {Event.ADOPT: Machine.DISABLED, Event.STOP: Machine.ATTACHING},
        Machine.DISABLED: _ONLINE
        | {
            Event.ENABLE: Machine.READY,
            Event.STOP: Machine.DISABLED,
            Event.MAINTAIN: Machine.MAINTENANCE,
        },
        Machine.READY: _ONLINE
        | {
            Event.START: Machine.EXECUTING,
            Event.STOP: Machine.STOPPING,
            Event.DISABLE: Machine.DISABLED,
        },
        Machine.EXECUTING: _ONLINE
        | {Event.FINISH: Machine.READY, Event.STOP: Machine.STOPPING},
        Machine.STOPPING: _ONLINE
        | {Event.REST: Machine.READY, Event.STOP: Machine.STOPPING},
        Machine.FAULT_REACTION: _ONLINE
        | {Event.REACTED: Machine.FAULT, Event.STOP: Machine.FAULT_REACTION},
        Machine.FAULT: _ONLINE
        | {Event.RESET: Machine.DISABLED, Event.STOP: Machine.FAULT},
        # Neither a fault nor a second emergency stop ends an emergency stop.
        Machine.ESTOPPED: {
            Event.LINK_LOST: Machine.OFFLINE,
            Event.RESET: Machine.DISABLED,
            Event.ESTOP: Machine.ESTOPPED,
            Event.FAIL: Machine.ESTOPPED,
            Event.STOP: Machine.ESTOPPED,
        },
        Machine.MAINTENANCE: _ONLINE
        | {Event.MAINTAINED: Machine.DISABLED, Event.STOP: Machine.MAINTENANCE},
    }
)
"""Every allowed pair; a pair that is not listed is refused."""


_ANYWHERE = {
    Sign.OPEN: Grip.RELEASING,
    Sign.CONTACT: Grip.HOLDING,
    Sign.DOUBT: Grip.UNKNOWN,
}
_FREE = {Sign.CLOSE: Grip.CLOSING, Sign.MOVE: Grip.MOVING}
_EMPTY = {Sign.MISS: Grip.NO_PART, Sign.LET_GO: Grip.RELEASED}
_GONE = dict.fromkeys((Sign.LOSS, Sign.MISS, Sign.LET_GO), Grip.PART_LOST)

GRIPS: Mapping[Grip, Mapping[Sign, Grip]] = MappingProxyType(
    {
        Grip.UNKNOWN: _ANYWHERE | _FREE | _EMPTY | {Sign.LOSS: Grip.PART_LOST},
        Grip.RELEASED: _ANYWHERE | _FREE | _EMPTY,
        Grip.CLOSING: _ANYWHERE | _FREE | _EMPTY | {Sign.LOSS: Grip.PART_LOST},
        # What is held is let go of by a command, or lost; never just not there.
        Grip.HOLDING: _ANYWHERE | _GONE,
        Grip.NO_PART: _ANYWHERE | _FREE | _EMPTY,
        # A loss stays visible until a command, or the part itself, ends it.
        Grip.PART_LOST: _ANYWHERE | _FREE | _GONE,
        Grip.RELEASING: _ANYWHERE | _FREE | _EMPTY,
        Grip.MOVING: _ANYWHERE | _FREE | _EMPTY | {Sign.LOSS: Grip.PART_LOST},
    }
)
"""Every allowed pair of the grip; a pair that is not listed is refused."""

SIGNS: Mapping[Grip, Sign] = MappingProxyType(
    {grip: sign for sign, grip in (_ANYWHERE | _FREE | _EMPTY).items()}
    | {Grip.PART_LOST: Sign.LOSS}
)
"""What tells of each grip state."""


REQUESTS = {
    Event.START: "a command",
    Event.ENABLE: "enable",
    Event.DISABLE: "disable",
    Event.STOP: "stop",
    Event.RESET: "reset",
}
"""What clients can ask for, in their words; the rest happens by itself."""


def possible(state: Machine) -> tuple[Event, ...]:
    """What a client can ask for in a state."""
    return tuple(event for event in REQUESTS if event in TRANSITIONS[state])


def after(state: Machine, event: Event) -> Machine:
    """State that follows an event.

    Raises
    ------
    Refused
        With what would be possible, when the pair is not in the table.
    """
    allowed = TRANSITIONS[state]
    if event not in allowed:
        words = ", ".join(REQUESTS[asked] for asked in possible(state))
        message = (
            f"{REQUESTS.get(event, event)} is not possible while the gripper is {state}"
        )
        raise Refused(
            message,
            code="wrong-state",
            hints=(f"possible now: {words or 'nothing, only waiting'}",),
        )
    return allowed[event]


def gripped(grip: Grip, sign: Sign) -> Grip:
    """Grip state that follows a sign.

    Raises
    ------
    Refused
        With what may follow, when the pair is not in the table.
    """
    allowed = GRIPS[grip]
    if sign not in allowed:
        message = f"{sign} does not follow while the grip is {grip}"
        hint = f"what may follow: {', '.join(sorted(allowed))}"
        raise Refused(message, code="wrong-state", hints=(hint,))
    return allowed[sign]
