"""What the daemon keeps in its state directory: the versions of its models."""

from gripperd.store.active import folder_of, versions_of, with_active_models
from gripperd.store.difference import Change, difference
from gripperd.store.version import Shelf, Version
from gripperd.store.versions import ACTIVE, Versions

__all__ = [
    "ACTIVE",
    "Change",
    "Shelf",
    "Version",
    "Versions",
    "difference",
    "folder_of",
    "versions_of",
    "with_active_models",
]
