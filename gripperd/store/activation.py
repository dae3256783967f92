"""Another active version, in the files and in a control process that runs."""

from asyncio import to_thread
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from functools import partial

from gripperd.config import Settings
from gripperd.control.snapshot import GripperState
from gripperd.errors import ConfigError, GripperdError, Refused
from gripperd.link.client import Client
from gripperd.link.control import UseModel
from gripperd.link.model import model_message
from gripperd.model import Chain
from gripperd.store.active import versions_of, with_model
from gripperd.store.version import Version
from gripperd.store.versions import Versions

WITHIN = 2.0
"""Longest wait for control; it answers in milliseconds. [s]"""


@dataclass(frozen=True, slots=True)
class Activation:
    """A version that can become the active one: it was read and checked."""

    version: Version
    grippers: tuple[str, ...]
    """Those with that model; all of them go by it, or none."""
    keep: Callable[[], Version]
    """Writes down that it is the active one."""
    former: Chain | None
    """What goes on if it cannot be kept; None where that cannot be read any more."""

    async def take_up(self, control: Client) -> None:
        """Let control go by it now, and keep it; no current is written by it.

        Raises
        ------
        Refused
            A gripper moves or may hold something, or the disk took nothing; nothing
            was changed.
        LinkError
            Control does not answer; nothing was kept.
        """
        await self._use(self.version.model.chain(), control)
        try:
            await to_thread(self.keep)
        except GripperdError:
            # What runs and what the next start reads must be the same.
            if self.former is not None:
                with suppress(GripperdError):
                    await self._use(self.former, control)
            raise

    async def _use(self, chain: Chain, control: Client) -> None:
        request = UseModel(self.grippers, model_message(chain))
        await control.ask(request, list[GripperState], WITHIN)


def activation(settings: Settings, gripper: str, which: int | str | None) -> Activation:
    """Prepare that another version becomes the active one; nothing is changed yet.

    Parameters
    ----------
    settings
        As they were loaded.
    gripper
        A gripper with the model.
    which
        Number or name of the version; None for the one that was active before.

    Raises
    ------
    NotFound
        There is no such version.
    Refused
        There was none before; or its file is damaged, or a gripper cannot go by it
        (``model-unusable``).
    """
    versions = versions_of(settings, settings.grippers[gripper])
    name = settings.grippers[gripper].model.name
    sharing = [each for each in settings.grippers.values() if each.model.name == name]
    try:
        version = versions.before() if which is None else versions.get(which)
        for each in sharing:
            with_model(each, version.model)
    except ConfigError as unusable:
        hints = ("what is active stays so",)
        raise Refused(str(unusable), code="model-unusable", hints=hints) from unusable
    return Activation(
        version=version,
        grippers=tuple(each.name for each in sharing),
        keep=versions.rollback
        if which is None
        else partial(versions.activate, version.number),
        former=_former(versions),
    )


def _former(versions: Versions) -> Chain | None:
    try:
        return versions.get().model.chain()
    except ConfigError:
        return None
