"""What happened to one gripper, numbered, until somebody has written it down."""

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import islice

from gripperd.control.command import Command
from gripperd.control.snapshot import GripperState
from gripperd.control.states import APART, Grip, Machine
from gripperd.units import MILLI

LENGTH = 4000
"""Entries that are kept: a command takes about six, so an hour of work at full pace."""
PAGE = 50
"""Entries that go at once, so that they fit into one message between the processes."""


class Happening(StrEnum):
    """What an entry is about."""

    COMMAND = "command"
    STATE = "state"
    ADOPTION = "adoption"
    """A current was found, not commanded."""
    FAULT = "fault"
    LEASE = "lease"


@dataclass(frozen=True, slots=True, kw_only=True)
class Entry:
    """One thing that happened."""

    number: int
    """Counts from 1 without gaps in the life of a control process."""
    at: float
    """Seconds since the epoch."""
    kind: Happening
    text: str
    """For a person."""
    machine: Machine | None = None
    grip: Grip | None = None
    command: Command | None = None
    """As it stood when its status changed."""


class Journal:
    """Entries of one gripper; the oldest give way, nobody is waited for."""

    def __init__(self, length: int = LENGTH) -> None:
        self._entries: deque[Entry] = deque(maxlen=length)
        self._count = 0
        self._seen: GripperState | None = None

    @property
    def newest(self) -> int:
        """Number of the last entry, 0 before the first."""
        return self._count

    @property
    def oldest(self) -> int:
        """Number of the first entry that is still there, or will be."""
        return self._entries[0].number if self._entries else self._count + 1

    def since(self, number: int) -> Sequence[Entry]:
        """Entries after a number, oldest first, no more than a page of them."""
        start = max(number + 1 - self.oldest, 0)
        return tuple(islice(self._entries, start, start + PAGE))

    def command(self, command: Command) -> None:
        """Tell that a command has another status."""
        at = command.completed_at or command.started_at or command.created_at
        reason = f": {command.error.message}" if command.error else ""
        text = f"{command.kind} {command.id[:8]} {command.status}{reason}"
        self._add(
            Entry(
                number=self._count + 1,
                at=at,
                kind=Happening.COMMAND,
                text=text,
                command=command,
            )
        )

    def note(self, kind: Happening, text: str, at: float) -> None:
        """Tell what has no other form than a sentence."""
        self._add(Entry(number=self._count + 1, at=at, kind=kind, text=text))

    def look(self, state: GripperState, at: float) -> None:
        """Compare with what was seen last, and tell what is new."""
        last, self._seen = self._seen, state
        if last is None or (last.machine, last.grip) != (state.machine, state.grip):
            why = f": {state.link}" if state.machine is Machine.OFFLINE else ""
            text = f"{state.machine}, {state.grip}{why}"
            self._add(
                Entry(
                    number=self._count + 1,
                    at=at,
                    kind=Happening.STATE,
                    text=text,
                    machine=state.machine,
                    grip=state.grip,
                )
            )
        if state.adopted and state.current is not None:
            self._adopted(state.current, last, at)

    def _adopted(self, current: float, last: GripperState | None, at: float) -> None:
        if last is None or last.machine in APART:
            self.note(Happening.ADOPTION, f"adopted {_shown(current)} as found", at)
        elif not last.adopted or last.current != current:
            was = "" if last.current is None else f", not {_shown(last.current)}"
            text = f"adopted {_shown(current)}{was}: somebody else has set it"
            self.note(Happening.ADOPTION, text, at)

    def _add(self, entry: Entry) -> None:
        self._entries.append(entry)
        self._count = entry.number


def _shown(current: float) -> str:
    return f"{current / MILLI:.2f} mA"
