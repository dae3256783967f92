"""The grippers, each with the model that control goes by."""

import asyncio
from collections.abc import Iterator, Mapping

import structlog

from gripperd.config import GripperSettings, Settings
from gripperd.errors import GripperdError
from gripperd.store import versions_of, with_active_models
from gripperd.store.active import with_model

log = structlog.get_logger()


class Fleet(Mapping[str, GripperSettings]):
    """Settings of every gripper by its name; they follow what control says.

    Parameters
    ----------
    settings
        As they were loaded.

    Raises
    ------
    ConfigError
        An active version is damaged, or a gripper cannot go by it.
    """

    def __init__(self, settings: Settings) -> None:
        self._loaded = settings
        self._now = dict(with_active_models(settings).grippers)
        self._unreadable: set[tuple[str, str]] = set()

    def __getitem__(self, name: str) -> GripperSettings:
        """Settings of one gripper."""
        return self._now[name]

    def __iter__(self) -> Iterator[str]:
        """Every name."""
        return iter(self._now)

    def __len__(self) -> int:
        """Number of grippers."""
        return len(self._now)

    async def follow(self, name: str, model: str) -> GripperSettings:
        """Settings of a gripper that goes by a model, read if it is another.

        While a version cannot be read, which is told once, the one before stays.
        """
        if self._now[name].chain.name != model:
            try:
                self._now[name] = await asyncio.to_thread(self._read, name, model)
                self._unreadable.discard((name, model))
            except GripperdError as error:
                self._warn(name, model, str(error))
        return self._now[name]

    def _warn(self, name: str, model: str, reason: str) -> None:
        if (name, model) not in self._unreadable:
            self._unreadable.add((name, model))
            log.warning("a model cannot be followed", gripper=name, reason=reason)

    def _read(self, name: str, model: str) -> GripperSettings:
        loaded = self._loaded.grippers[name]
        return with_model(loaded, versions_of(self._loaded, loaded).get(model).model)
