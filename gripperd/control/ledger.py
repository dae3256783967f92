"""The commands of one gripper: queue, recent past, names given by clients."""

from collections import Counter, OrderedDict, deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import islice

from gripperd.control.command import (
    Command,
    Failure,
    GraspOrder,
    GraspResult,
    Kind,
    Order,
    Status,
    kind_of,
)
from gripperd.control.journal import Journal
from gripperd.control.snapshot import Instant
from gripperd.errors import InputError, NotFound, Refused

HISTORY = 1000
"""Commands that are remembered; what is older has long been written down."""
LONGEST_QUEUE = 8


@dataclass(frozen=True, slots=True)
class Key:
    """Who gives a command names it: the same name twice is the same command."""

    id: str
    """Id of the command, chosen before it is given, so that it can be looked for."""
    fingerprint: str
    """Digest of what was asked for, to catch a key used twice for other things."""


class Ledger:
    """Every command from its acceptance to long after its end.

    Parameters
    ----------
    gripper
        Whose commands they are.
    identify
        Gives a command its id when its client did not.
    """

    def __init__(self, gripper: str, identify: Callable[[], str]) -> None:
        self.journal = Journal()
        self.ended: Counter[str] = Counter()
        """How many are over, by kind and status."""
        self._gripper = gripper
        self._identify = identify
        self._commands: OrderedDict[str, Command] = OrderedDict()
        self._fingerprints: dict[str, str] = {}
        self._queue: deque[str] = deque()
        self._open: set[str] = set()

    def replay(self, key: Key | None) -> Command | None:
        """The command that a key stands for already.

        Raises
        ------
        InputError
            The key was used for something else.
        """
        if key is None or key.id not in self._commands:
            return None
        if self._fingerprints.get(key.id) != key.fingerprint:
            message = f"command {key.id} was given with another request"
            raise InputError(message, key="Idempotency-Key")
        return self._commands[key.id]

    def accept(
        self, order: Order, deadline: float, key: Key | None, now: Instant
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
            id=self._identify() if key is None else key.id,
            gripper=self._gripper,
            kind=kind_of(order),
            order=order if isinstance(order, GraspOrder) else None,
            task=None if isinstance(order, GraspOrder) else order,
            status=Status.QUEUED,
            created_at=now.wall,
            deadline=deadline,
            due=now.monotonic + deadline,
        )
        self._commands[command.id] = command
        self._queue.append(command.id)
        self._open.add(command.id)
        if key is not None:
            self._fingerprints[key.id] = key.fingerprint
        self.journal.command(command)
        self._forget()
        return command

    def _forget(self) -> None:
        """Drop the oldest commands that are over."""
        over = (name for name in tuple(self._commands) if name not in self._open)
        for name in islice(over, max(len(self._commands) - HISTORY, 0)):
            del self._commands[name]
            self._fingerprints.pop(name, None)

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
        known = self._commands.get(command.id)
        self._commands[command.id] = command
        if known is None or known.status is not command.status:
            self.journal.command(command)
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
        self.ended[f"{command.kind} {status}"] += 1
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
