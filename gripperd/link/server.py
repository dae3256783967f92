"""Answers requests on a Unix socket."""

import asyncio
import os
from asyncio import StreamReader, StreamWriter
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager, suppress
from pathlib import Path

import msgspec
import structlog

from gripperd.errors import BadReply, ConfigError, GripperdError, Refused
from gripperd.link.folder import private_folder
from gripperd.link.frames import Answer, Ask, decode, encode, failed, frame, read_frame

Respond = Callable[[msgspec.Raw], Awaitable[object]]
"""Decodes a request, does it, returns what :func:`frames.encode` can encode."""

log = structlog.get_logger()

NOTHING = msgspec.Raw(encode(None))


@asynccontextmanager
async def serve(path: Path, respond: Respond) -> AsyncIterator[None]:
    """Answer on a socket while inside; requests of one client run side by side.

    The socket is the user's own: whoever may open it may move the gripper.

    Raises
    ------
    ConfigError
        The socket cannot be there.
    Refused
        Another process answers there.
    """
    await _make_way(path)
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

    server = await _listening(path, connected)
    ours = _identity(path)
    try:
        yield
    finally:
        server.close()
        for client in tuple(clients):
            client.cancel()
        _clear(path, ours)


async def _listening(
    path: Path, connected: Callable[[StreamReader, StreamWriter], Awaitable[None]]
) -> asyncio.Server:
    mask = os.umask(0o177)
    try:
        return await asyncio.start_unix_server(connected, path)
    except OSError as error:
        message = f"{path} cannot be listened on: {error.strerror or error}"
        raise ConfigError(message) from error
    finally:
        os.umask(mask)


async def _make_way(path: Path) -> None:
    """Leave no socket of an earlier life, and a folder that is the user's alone."""
    private_folder(path.parent, path.name)
    try:
        _, writer = await asyncio.open_unix_connection(path)
    except FileNotFoundError:
        return
    except ConnectionRefusedError:
        _remove_socket(path)
        return
    writer.close()
    message = f"another process answers on {path}"
    raise Refused(message, code="already-running", hints=("stop it first",))


def _remove_socket(path: Path) -> None:
    if not path.is_socket():
        message = f"{path} is in the way: it is no socket, so it is not removed"
        raise ConfigError(message)
    path.unlink()


def _clear(path: Path, ours: tuple[int, int] | None) -> None:
    if _identity(path) == ours:
        path.unlink(missing_ok=True)


def _identity(path: Path) -> tuple[int, int] | None:
    """Which socket stands at a path; a newer process may have put its own there."""
    try:
        found = path.stat()
    except FileNotFoundError:
        return None
    return found.st_dev, found.st_ino


async def _converse(
    reader: StreamReader, writer: StreamWriter, respond: Respond
) -> None:
    async with asyncio.TaskGroup() as tasks:
        while (ask := await _next(reader)) is not None:
            tasks.create_task(_answer(ask, writer, respond))


async def _next(reader: StreamReader) -> Ask | None:
    """The next request; None at the end, and after octets that are none of ours."""
    try:
        body = await read_frame(reader)
        return None if body is None else decode(body, Ask)
    except BadReply:
        return None


async def _answer(ask: Ask, writer: StreamWriter, respond: Respond) -> None:
    try:
        answer = Answer(ask.id, msgspec.Raw(encode(await respond(ask.body))))
    except GripperdError as error:
        answer = Answer(ask.id, NOTHING, failed(error))
    except Exception as error:
        log.exception("a request failed")
        answer = Answer(ask.id, NOTHING, failed(GripperdError(f"defect: {error!r}")))
    if not writer.is_closing():
        writer.write(frame(answer))
