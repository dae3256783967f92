"""What differs between two readings of the settings."""

from collections.abc import Iterator, Mapping

from gripperd.config.settings import Settings

WHOLE = ("http", "runtime_dir", "state_dir", "bench")
"""Parts that are told as one."""


def changes(old: Settings, new: Settings) -> Iterator[str]:
    """Name every part that differs, such as ``grippers.g0`` or ``profiles.apple``.

    What a part names counts as its content: another model in the same file is a change
    of its gripper.
    """
    for name in WHOLE:
        if getattr(old, name) != getattr(new, name):
            yield name
    yield from _inside("grippers", old.grippers, new.grippers)
    yield from _inside("profiles", old.profiles, new.profiles)


def _inside(
    name: str, old: Mapping[str, object], new: Mapping[str, object]
) -> Iterator[str]:
    for key in dict.fromkeys([*old, *new]):
        if old.get(key) != new.get(key):
            yield f"{name}.{key}"
