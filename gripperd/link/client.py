"""Asks over a Unix socket, many questions at a time."""

import asyncio
import itertools
from asyncio import StreamReader, StreamWriter
from contextlib import suppress
from pathlib import Path
from typing import TypeVar

import msgspec

from gripperd.errors import BadReply, LinkLost, NotConnected, ReplyTimeout
from gripperd.link.frames import Answer, Ask, decode, encode, frame, raised, read_frame

T = TypeVar("T")

LOOKS = 4
"""Parts that a wait has. A stall of this process ends one of them, however long it was:
what was answered meanwhile is still read."""


class Client:
    """Connects when asked, and again after the other end was restarted.

    Parameters
    ----------
    path
        The socket.
    peer
        What answers there, for messages.
    """

    def __init__(self, path: Path, peer: str) -> None:
        self._path = path
        self._peer = peer
        self._ids = itertools.count()
        self._waiting: dict[int, asyncio.Future[Answer]] = {}
        self._writer: StreamWriter | None = None
        self._reading: asyncio.Task[None] | None = None
        self._connecting = asyncio.Lock()

    async def ask(
        self, request: msgspec.Struct, reply: type[T], seconds: float = 5.0
    ) -> T:
        """Ask one question.

        Raises
        ------
        NotConnected
            The other end is not there; nothing was sent.
        LinkLost
            It went away; whether it got the question is unknown.
        ReplyTimeout
            It did not answer in time.
        GripperdError
            Whatever it raised itself.
        """
        writer = await self._connected()
        number = next(self._ids)
        answer: asyncio.Future[Answer] = asyncio.get_running_loop().create_future()
        self._waiting[number] = answer
        try:
            writer.write(frame(Ask(number, msgspec.Raw(encode(request)))))
            for _ in range(LOOKS):
                if not answer.done():
                    await asyncio.wait([answer], timeout=seconds / LOOKS)
        finally:
            self._waiting.pop(number, None)
        if not answer.done():
            raise ReplyTimeout(f"{self._peer} did not answer within {seconds:g} s")
        found = answer.result()
        if found.failed is not None:
            raise raised(found.failed)
        return decode(found.body, reply)

    async def _connected(self) -> StreamWriter:
        async with self._connecting:
            if self._writer is not None and not self._writer.is_closing():
                return self._writer
            try:
                reader, self._writer = await asyncio.open_unix_connection(self._path)
            except OSError as error:
                reason = error.strerror or error
                message = f"{self._peer} is not running: {self._path}: {reason}"
                raise NotConnected(message) from error
            self._reading = asyncio.create_task(self._read(reader, self._writer))
            return self._writer

    async def _read(self, reader: StreamReader, writer: StreamWriter) -> None:
        try:
            while (body := await read_frame(reader)) is not None:
                answer = decode(body, Answer)
                waiting = self._waiting.get(answer.id)
                if waiting is not None and not waiting.done():
                    waiting.set_result(answer)
        except BadReply:
            pass
        writer.close()
        self._give_up()

    def _give_up(self) -> None:
        for waiting in self._waiting.values():
            if not waiting.done():
                waiting.set_exception(LinkLost(f"{self._peer} went away"))

    async def close(self) -> None:
        """Close the connection, if there is one."""
        if self._reading is not None:
            self._reading.cancel()
            with suppress(asyncio.CancelledError):
                await self._reading
        if self._writer is not None:
            self._writer.close()
        self._give_up()
