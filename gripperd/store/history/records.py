"""What is kept of a command and of an event, each sealed with its digest."""

import hashlib
from dataclasses import astuple, dataclass, replace


@dataclass(frozen=True, slots=True, kw_only=True)
class CommandRecord:
    """One command as it was last known."""

    id: str
    gripper: str
    key: str | None
    """The client's idempotency key."""
    fingerprint: str
    """Digest of what was asked for."""
    life: float
    """Start of the control process it was given to, in seconds since the epoch."""
    created_at: float
    """Seconds since the epoch."""
    final: bool
    document: str
    """JSON, as clients get it."""

    @property
    def digest(self) -> str:
        """SHA-256 of all of it."""
        return _digest(astuple(self))


@dataclass(frozen=True, slots=True, kw_only=True)
class EventRecord:
    """One event."""

    number: int | None = None
    """Counts on over all restarts; None until it is kept."""
    at: float
    """Seconds since the epoch."""
    kind: str
    gripper: str | None = None
    command: str | None = None
    """Id of the command that it is about."""
    life: float | None = None
    """Start of the control process that told it."""
    entry: int | None = None
    """Number in the journal of that process."""
    document: str
    """JSON, as clients get it."""

    @property
    def digest(self) -> str:
        """SHA-256 of all of it but its number."""
        return _digest(astuple(replace(self, number=None)))


@dataclass(frozen=True, slots=True, kw_only=True)
class EventQuery:
    """Which events are asked for; None is any."""

    kinds: tuple[str, ...] = ()
    gripper: str | None = None
    command: str | None = None
    since: float | None = None
    until: float | None = None
    """Seconds since the epoch."""
    before: int | None = None
    after: int | None = None
    """Numbers that those asked for are below, or above."""
    limit: int = 100


def _digest(fields: tuple[object, ...]) -> str:
    # SQLite gives back a float where an int was written. The repr of a tuple keeps the
    # borders between fields: no two lists of them look the same.
    read = tuple(float(one) if isinstance(one, int) else one for one in fields)
    return hashlib.sha256(repr(read).encode()).hexdigest()
