"""Where a gripper stands in the machine table."""

from gripperd.control.states import APART, Event, Machine, after, possible


class Lifecycle:
    """The machine state of one gripper; only events of the table change it."""

    def __init__(self) -> None:
        self.state = Machine.OFFLINE

    def on(self, event: Event) -> None:
        """Go where an event leads.

        Raises
        ------
        Refused
            The event has no place in this state.
        """
        self.state = after(self.state, event)

    def check(self, event: Event) -> None:
        """Refuse an event that has no place in this state, and stay."""
        after(self.state, event)

    @property
    def possible(self) -> tuple[Event, ...]:
        """What a client can ask for now."""
        return possible(self.state)

    @property
    def attached(self) -> bool:
        """Whether the present state of the hardware is known."""
        return self.state not in APART
