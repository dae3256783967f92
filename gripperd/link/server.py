"""Answers requests on a Unix socket."""

import asyncio
import os
from asyncio import StreamReader, StreamWriter
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager, suppress
from pathlib import Path

import msgspec

from gripperd.errors import BadReply, GripperdError
from gripperd.link.frames import Answer, Ask, decode, encode, failed, frame, read_frame

Respond = Callable[[msgspec.Raw], Awaitable[object]]
"""Decodes a request, does it, returns what :func:`frames.encode` can encode."""

NOTHING = msgspec.Raw(encode(None))


@asynccontextmanager
async def serve(path: Path, respond: Respond) -> AsyncIterator[None]:
    """Answer on a socket while inside; requests of one client run side by side.

    The socket is the user's own: whoever may open it may move the gripper.
    """
    _clear(path)
    clients: set[asyncio.Task[None]] = set()

    async def connected(reader: StreamReader, writer: StreamWriter) -> None:
        task = asyncio.current_task()
        assert task is not None
        clients.add(task)
        try:
            with suppress(asyncio.CancelledError):
                await _converse(reader, writer, respond)
        finally:
            clients.discard(task)
            writer.close()

    mask = os.umask(0o177)
    try:
        server = await asyncio.start_unix_server(connected, path)
    finally:
        os.umask(mask)
    try:
        yield
    finally:
        server.close()
        for client in tuple(clients):
            client.cancel()
        _clear(path)


def _clear(path: Path) -> None:
    """Leave no socket of an earlier life, and a folder that is the user's alone."""
    path.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
    path.unlink(missing_ok=True)


async def _converse(
    reader: StreamReader, writer: StreamWriter, respond: Respond
) -> None:
    async with asyncio.TaskGroup() as tasks:
        while (body := await read_frame(reader)) is not None:
            try:
                ask = decode(body, Ask)
            except BadReply:
                break
            tasks.create_task(_answer(ask, writer, respond))


async def _answer(ask: Ask, writer: StreamWriter, respond: Respond) -> None:
    try:
        answer = Answer(ask.id, msgspec.Raw(encode(await respond(ask.body))))
    except GripperdError as error:
        answer = Answer(ask.id, NOTHING, failed(error))
    if not writer.is_closing():
        writer.write(frame(answer))
