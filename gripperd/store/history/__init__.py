"""What happened, on disk: commands with their keys and results, and every event."""

from gripperd.store.history.database import NOT_RECORDED, SetAside
from gripperd.store.history.history import History
from gripperd.store.history.records import CommandRecord, EventQuery, EventRecord

__all__ = [
    "NOT_RECORDED",
    "CommandRecord",
    "EventQuery",
    "EventRecord",
    "History",
    "SetAside",
]
