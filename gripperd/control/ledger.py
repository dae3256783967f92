"""The commands of one gripper: queue, history, idempotency keys."""

from collections import OrderedDict, deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import islice

from gripperd.control.command import (
    Command,
    Failure,
    GraspOrder,
    GraspResult,
    Kind,
    Status,
)
from gripperd.control.snapshot import Instant
from gripperd.errors import InputError, NotFound, Refused

HISTORY = 1000
"""Commands that are remembered; idempotency keys go with them."""
LONGEST_QUEUE = 8


@dataclass(frozen=True, slots=True)
class Key:
    """A client's promise that two requests are the same."""

    text: str
    fingerprint: str
    """Digest of what was asked for, to catch a key used twice for other things."""


class Ledger:
    """Every command from its acceptance to long after its end.

    Parameters
    ----------
    gripper
        Whose commands they are.
    identify
        Gives a new command its id.
    """

    def __init__(self, gripper: str, identify: Callable[[], str]) -> None:
        self._gripper = gripper
        self._identify = identify
        self._commands: OrderedDict[str, Command] = OrderedDict()
        self._keys: dict[str, tuple[Key, str]] = {}
        self._queue: deque[str] = deque()
        self._open: set[str] = set()

    def replay(self, key: Key | None) -> Command | None:
        """The command that a key stands for already.

        Raises
        ------
        InputError
            The key was used for something else.
        """
        if key is None or key.text not in self._keys:
            return None
        known, command = self._keys[key.text]
        if known.fingerprint != key.fingerprint:
            message = (
                f"the idempotency key {key.text!r} was used for another request:"
                f" command {command}"
            )
            raise InputError(message, key="Idempotency-Key")
        return self._commands[command]

    def accept(
        self, order: GraspOrder | None, deadline: float, key: Key | None, now: Instant
    ) -> Command:
        """Queue a new command.

        Raises
        ------
        Refused
            The queue is full.
        """
        if len(self._queue) >= LONGEST_QUEUE:
            message = f"{LONGEST_QUEUE} commands are waiting already"
            raise Refused(message, code="queue-full", hints=("stop, or wait",))
        command = Command(
            id=self._identify(),
            gripper=self._gripper,
            kind=Kind.RELEASE if order is None else Kind.GRASP,
            order=order,
            status=Status.QUEUED,
            created_at=now.wall,
            deadline=deadline,
            due=now.monotonic + deadline,
        )
        self._commands[command.id] = command
        self._queue.append(command.id)
        self._open.add(command.id)
        if key is not None:
            self._keys[key.text] = (key, command.id)
        self._forget()
        return command

    def _forget(self) -> None:
        """Drop the oldest commands that are over."""
        over = (name for name in tuple(self._commands) if name not in self._open)
        for name in islice(over, max(len(self._commands) - HISTORY, 0)):
            del self._commands[name]
            self._keys = {k: v for k, v in self._keys.items() if v[1] != name}

    def get(self, command: str) -> Command:
        """One command.

        Raises
        ------
        NotFound
            Unknown, or forgotten.
        """
        if command not in self._commands:
            message = f"there is no command {command!r}"
            raise NotFound(message, key="id")
        return self._commands[command]

    def newest(self, count: int) -> list[Command]:
        """The last commands, newest first."""
        return list(islice(reversed(self._commands.values()), count))

    def next(self) -> Command | None:
        """Take the command that is due from the queue."""
        return self._commands[self._queue.popleft()] if self._queue else None

    def waiting(self) -> Iterator[Command]:
        """Commands that have not started."""
        return (self._commands[command] for command in tuple(self._queue))

    @property
    def releases_first(self) -> bool:
        """Whether a release waits, so that a grasp after it makes sense."""
        return any(command.kind is Kind.RELEASE for command in self.waiting())

    def overdue(self, now: Instant) -> list[tuple[Command, Failure]]:
        """Commands whose time is up, each with what to say of it."""
        return [
            (command, _deadline_missed(command))
            for command in map(self.get, tuple(self._open))
            if now.monotonic > command.due
        ]

    def put(self, command: Command) -> Command:
        """Record a new snapshot of a known command."""
        self._commands[command.id] = command
        return command

    def close(
        self,
        command: Command,
        wall: float,
        *,
        result: GraspResult | None = None,
        failure: Failure | None = None,
    ) -> Command:
        """Give a command its final status: failed or cancelled with a failure."""
        status = Status.SUCCEEDED
        if failure is not None:
            cancelled = failure.category == "cancelled"
            status = Status.CANCELLED if cancelled else Status.FAILED
        self._open.discard(command.id)
        if command.id in self._queue:
            self._queue.remove(command.id)
        return self.put(
            replace(
                command,
                status=status,
                completed_at=wall,
                result=result,
                error=failure,
                phase="",
            )
        )


def _deadline_missed(command: Command) -> Failure:
    message = f"not finished within {command.deadline:g} s"
    return Failure(category="fault", code="deadline", message=message)
