"""The grippers, each with the model that control goes by."""

from collections.abc import Awaitable, Callable, Iterator, Mapping
from dataclasses import replace

import structlog

from gripperd.config import GripperSettings, Settings
from gripperd.control.snapshot import GripperState
from gripperd.errors import GripperdError
from gripperd.model import Chain
from gripperd.store import with_active_models

log = structlog.get_logger()


class Fleet(Mapping[str, GripperSettings]):
    """Settings of every gripper by its name; their chains follow what control says.

    Parameters
    ----------
    settings
        As they were loaded.
    ask
        Gets the model that control goes by, of a gripper by its name.

    Raises
    ------
    ConfigError
        An active version is damaged, or a gripper cannot go by it.
    """

    def __init__(
        self, settings: Settings, ask: Callable[[str], Awaitable[Chain]]
    ) -> None:
        self._ask = ask
        self._configured = {
            name: gripper.model.chain() for name, gripper in settings.grippers.items()
        }
        self._now = dict(with_active_models(settings).grippers)
        self._told: set[str] = set()

    def __getitem__(self, name: str) -> GripperSettings:
        """Settings of one gripper."""
        return self._now[name]

    def __iter__(self) -> Iterator[str]:
        """Every name."""
        return iter(self._now)

    def __len__(self) -> int:
        """Number of grippers."""
        return len(self._now)

    async def follow(self, state: GripperState) -> GripperSettings:
        """Settings of a gripper as it is now, asked for if its model is another.

        While control does not give it, which is told once, the one before stays.
        """
        name = state.name
        if self._now[name].chain.digest != state.model_digest:
            try:
                chain = await self._ask(name)
            except GripperdError as error:
                self._warn(state, str(error))
            else:
                self._now[name] = replace(self._now[name], chain=chain)
                if self.edited(name):
                    log.warning("a model was edited", gripper=name, model=chain.name)
        return self._now[name]

    def _warn(self, state: GripperState, reason: str) -> None:
        if state.model_digest not in self._told:
            self._told.add(state.model_digest)
            log.warning("a model cannot be followed", gripper=state.name, reason=reason)

    def edited(self, name: str) -> bool:
        """Whether control goes by a version 0 that is not the one that was loaded.

        Control that was started anew reads the file as it is now, and the command line
        gives it what that says.
        """
        now, loaded = self._now[name].chain, self._configured[name]
        return now.name == loaded.name and now.digest != loaded.digest
