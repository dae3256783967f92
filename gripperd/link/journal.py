"""How the service follows what happens to a gripper, without control waiting for it."""

import msgspec

from gripperd.control.journal import Entry, Journal


class ReadJournal(msgspec.Struct, frozen=True, tag=True):
    """Ask for a :class:`Page`, once there is a new entry or ``wait`` seconds passed."""

    gripper: str
    life: float
    """Of the control process that the numbers are of; another one starts anew."""
    after: int
    """Number of the last entry that is known."""
    wait: float = 0.0


class Page(msgspec.Struct, frozen=True):
    """Some entries, oldest first."""

    life: float
    """Start of the control process, in seconds since the epoch: it names its life."""
    oldest: int
    """Number of the first entry that is still there: what is between is lost."""
    entries: tuple[Entry, ...]


def page(journal: Journal, life: float, after: int) -> Page:
    """The entries after a number."""
    return Page(life, journal.oldest, tuple(journal.since(after)))
