"""Gives commands to control so that each has one effect, and is known afterwards.

A command is on disk under an id of its own before control hears of it, and its client
hears of it after both. So whatever ends when it will, a key stands for one command: who
asks again is answered with that, or, if control cannot have had it, it is given under
the same id. That id is made from the key, so that control still knows it by that when
the disk has lost it.
"""

import uuid
from asyncio import Lock
from collections import defaultdict
from collections.abc import Awaitable, Callable
from contextlib import suppress
from dataclasses import dataclass

import structlog
from msgspec.structs import replace

from gripperd.control.command import Command
from gripperd.control.ledger import Key, Ledger
from gripperd.control.loop import clock
from gripperd.control.snapshot import Instant
from gripperd.errors import InputError, LinkError, NotConnected, NotFound, Refused
from gripperd.link.client import Client
from gripperd.link.control import (
    Overview,
    ReadCommand,
    ReadOverview,
    Submit,
    Submitted,
)
from gripperd.service.archive import Archive
from gripperd.service.command_documents import CommandDocument, command_document
from gripperd.service.endings import RESTARTED, ended
from gripperd.service.event_documents import command_record
from gripperd.store.history import NOT_RECORDED, CommandRecord

KEYS = uuid.UUID("58b623ea-911d-5cd8-b1e9-0a0b62452717")
"""Namespace of the ids that are made from idempotency keys (RFC 9562, section 5.5)."""
IN_TIME = 5.0
"""Control does not begin what comes later: by then its client was told so. [s]"""

log = structlog.get_logger()

Give = Callable[[Submit, type[Submitted]], Awaitable[Submitted]]
"""Gives a command to control."""


@dataclass(frozen=True, slots=True)
class Given:
    """What became of a request."""

    command: CommandDocument
    replayed: bool = False
    """The request was made before."""
    recorded: bool = True
    """It is on disk; only without a key may it be carried out all the same."""


class Submissions:
    """The way of every command from its client to control.

    Parameters
    ----------
    control
        Answers :mod:`gripperd.link.control`.
    archive
        Where commands are kept.
    life
        Tells which life of control was heard last, by the name of a gripper.
    now, identify
        The clock, and where the ids of commands without a key come from.
    """

    def __init__(
        self,
        control: Client,
        archive: Archive,
        life: Callable[[str], float],
        now: Callable[[], Instant] = clock,
        identify: Callable[[], str] = lambda: uuid.uuid4().hex,
    ) -> None:
        self.underway: set[str] = set()
        """Ids of commands that are on their way to control."""
        self._control = control
        self._archive = archive
        self._life = life
        self._now = now
        self._identify = identify
        self._turns: defaultdict[str, Lock] = defaultdict(Lock)

    async def give(
        self, submit: Submit, client_key: str | None, fingerprint: str, give: Give
    ) -> Given:
        """Have a command carried out once, however often it is asked for.

        Parameters
        ----------
        submit
            What is asked for.
        client_key
            The client's idempotency key.
        fingerprint
            Digest of its request.
        give
            How control is asked.

        Raises
        ------
        InputError
            The key was used for another request.
        Refused
            Control refuses it; or there is a key and the disk does not keep it.
        LinkError
            Whether control has it is not known; a key tells, when it is used again.
        """
        if client_key is None:
            return await self._begin(submit, None, fingerprint, give)
        # Who races with the same key waits for the first to know what became of it.
        async with self._turns[submit.gripper]:
            known = await self._archive.do(
                lambda history: history.of_key(submit.gripper, client_key)
            )
            if known is None:
                return await self._begin(submit, client_key, fingerprint, give)
            if known.fingerprint != fingerprint:
                message = (
                    f"the idempotency key {client_key!r} was used for another request:"
                    f" command {known.id}"
                )
                raise InputError(message, key="Idempotency-Key")
            return await self._again(known, submit, give)

    async def _begin(
        self, submit: Submit, client_key: str | None, fingerprint: str, give: Give
    ) -> Given:
        name = self._identify()
        if client_key is not None:
            name = uuid.uuid5(KEYS, f"{submit.gripper}/{client_key}").hex
        self.underway.add(name)
        try:
            record = self._announced(submit, name, client_key, fingerprint)
            recorded = await self._recorded(record)
            return await self._hand_over(submit, record, give, recorded=recorded)
        finally:
            self.underway.discard(name)

    def _announced(
        self, submit: Submit, name: str, client_key: str | None, fingerprint: str
    ) -> CommandRecord:
        """The command as control will queue it."""
        ledger = Ledger(submit.gripper, lambda: name)
        command = ledger.accept(
            submit.task or submit.order, submit.deadline, None, self._now()
        )
        life = self._life(submit.gripper)
        return command_record(command_document(command), life, client_key, fingerprint)

    async def _recorded(self, record: CommandRecord) -> bool:
        try:
            await self._archive.do(lambda history: history.put([record]))
        except Refused as error:
            # The promise of a key cannot be kept without the disk; to open the jaws
            # must be possible.
            if record.key is not None or error.code != NOT_RECORDED:
                raise
            log.warning("a command is not recorded", id=record.id[:8])
            return False
        return True

    async def _hand_over(
        self, submit: Submit, record: CommandRecord, give: Give, *, recorded: bool
    ) -> Given:
        key = Key(record.id, record.fingerprint)
        late = self._now().monotonic + IN_TIME
        try:
            submitted = await give(replace(submit, key=key, late=late), Submitted)
        except (Refused, InputError, NotConnected):
            if recorded:
                with suppress(Refused):
                    await self._archive.do(lambda history: history.forget(record.id))
            raise
        return Given(
            command_document(submitted.command),
            replayed=submitted.replayed,
            recorded=recorded,
        )

    async def _again(self, known: CommandRecord, submit: Submit, give: Give) -> Given:
        """Answer a request that was made before."""
        kept = CommandDocument.model_validate_json(known.document)
        request = ReadCommand(known.gripper, known.id)
        try:
            command = await self._control.ask(request, Command)
        except NotFound:
            return await self._unheard_of(known, kept, submit, give)
        except LinkError:
            if known.final:
                return Given(kept, replayed=True)
            raise
        return Given(command_document(command), replayed=True)

    async def _unheard_of(
        self, known: CommandRecord, kept: CommandDocument, submit: Submit, give: Give
    ) -> Given:
        """Answer a request whose command control does not know."""
        if known.final:
            return Given(kept, replayed=True)
        overview = await self._control.ask(ReadOverview(), Overview)
        if known.life != overview.started_at:
            # Control may have begun it before it ended: never twice.
            return Given(ended(known, RESTARTED, self._now().wall), replayed=True)
        return await self._hand_over(submit, known, give, recorded=True)
