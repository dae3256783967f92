"""What happened, wherever it is known: followed, kept, told, asked for."""

import asyncio
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

from gripperd.control.command import Command
from gripperd.errors import LinkError, NotFound, Refused
from gripperd.link.client import Client
from gripperd.link.control import ListCommands, ReadCommand
from gripperd.service.archive import Archive
from gripperd.service.broadcast import Broadcast
from gripperd.service.command_documents import CommandDocument, command_document
from gripperd.service.follower import Follower
from gripperd.service.submissions import Submissions

GRACE = 5.0
"""How much longer than the wait itself its answer may take. [s]"""


class Past:
    """Commands and events of every gripper, over all restarts.

    Parameters
    ----------
    path
        The database file.
    control
        Answers :mod:`gripperd.link.control`.
    grippers
        Their names.
    """

    def __init__(self, path: Path, control: Client, grippers: Iterable[str]) -> None:
        self.archive = Archive(path)
        self.broadcast = Broadcast()
        self.submissions = Submissions(control, self.archive, self._life)
        self._control = control
        self._followers = {
            name: Follower(
                name, control, self.archive, self.broadcast, self.submissions.underway
            )
            for name in grippers
        }
        self._following: list[asyncio.Task[None]] = []

    def open(self) -> None:
        """Follow what happens from now on."""
        self._following = [
            asyncio.create_task(each.run()) for each in self._followers.values()
        ]

    async def close(self) -> None:
        """Follow no more; what was told is on disk."""
        self.broadcast.end()
        for task in self._following:
            task.cancel()
        await asyncio.gather(*self._following, return_exceptions=True)
        await self.archive.close()

    async def command(self, gripper: str, name: str, wait: float) -> CommandDocument:
        """One command once it is over, or as it stands after a time.

        Raises
        ------
        NotFound
            Neither control nor the disk knows it.
        LinkError
            Control does not answer, and it is not known to be over.
        """
        request = ReadCommand(gripper, name, wait)
        try:
            answer = await self._control.ask(request, Command, wait + GRACE)
        except (NotFound, LinkError) as error:
            found = await self._kept(gripper, name)
            gone = isinstance(error, LinkError)
            if found is None or (gone and found.completed_at is None):
                raise
            return found
        return command_document(answer)

    async def commands(self, gripper: str, count: int) -> list[CommandDocument]:
        """The last commands, newest first; those of earlier lives from the disk."""
        request = ListCommands(gripper, count)
        known = await self._control.ask(request, list[Command])
        found = {each.id: command_document(each) for each in known}
        with suppress(Refused):
            for record in await self.archive.do(
                lambda history: history.newest(gripper, count)
            ):
                kept = CommandDocument.model_validate_json(record.document)
                found.setdefault(kept.id, kept)
        # Both are in the order of acceptance, which the clock's may not be.
        return list(found.values())[:count]

    async def _kept(self, gripper: str, name: str) -> CommandDocument | None:
        try:
            record = await self.archive.do(lambda history: history.command(name))
        except Refused:
            return None
        if record is None or record.gripper != gripper:
            return None
        return CommandDocument.model_validate_json(record.document)

    def _life(self, gripper: str) -> float:
        return self._followers[gripper].life
