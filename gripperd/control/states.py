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
    ESTOP_RELEASED = "estop_released"
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
            Event.ESTOP_RELEASED: Machine.DISABLED,
            Event.ESTOP: Machine.ESTOPPED,
            Event.FAIL: Machine.ESTOPPED,
            Event.STOP: Machine.ESTOPPED,
        },
        Machine.MAINTENANCE: _ONLINE
        | {Event.MAINTAINED: Machine.DISABLED, Event.STOP: Machine.MAINTENANCE},
    }
)
"""Every allowed pair; a pair that is not listed is refused."""


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
