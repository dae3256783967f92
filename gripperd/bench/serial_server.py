"""The rig's modules on a serial line: a pty of the bench's own, or a port.

References
----------
.. [1] MODBUS over Serial Line Specification and Implementation Guide V1.02,
       section 2.5.1.1: frames are parted by 3.5 characters of silence.
"""

import asyncio
import errno
import os
import time
import tty
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import ExitStack, asynccontextmanager, contextmanager
from pathlib import Path

import serial

from gripperd.bench.pace import Pace
from gripperd.bench.server import BenchServer, living
from gripperd.bench.speaker import Speaker
from gripperd.bench.wire_faults import WireFaults
from gripperd.errors import BadReply, Refused

STALE = 0.05
"""After so much silence the piece of a frame is dropped: longer than 3.5 characters
above 770 Bd, and than the octets of one request are apart on a busy machine. [s]"""
MOST_READ = 4096


class SerialServer:
    """Answers on an open port, octet by octet at its pace.

    Parameters
    ----------
    bench
        Answers.
    descriptor
        Of the port; reading it does not wait.
    pace
        How fast octets travel; None takes no time at all.
    now
        A clock that never steps. [s]
    """

    def __init__(
        self,
        bench: BenchServer,
        descriptor: int,
        pace: Pace | None,
        now: Callable[[], float],
    ) -> None:
        self._bench = bench
        self._now = now
        self._descriptor = descriptor
        self._pace = pace
        self._buffer = bytearray()
        self._began = 0.0
        """When the first octet of the buffer came. [s]"""
        self._heard = 0.0
        self._replies: set[asyncio.Task[None]] = set()
        self._line = asyncio.Lock()
        self._loop = asyncio.get_running_loop()
        self._loop.add_reader(descriptor, self._read)

    def close(self) -> None:
        """Hear and say nothing more."""
        self._loop.remove_reader(self._descriptor)
        for reply in self._replies:
            reply.cancel()

    def _read(self) -> None:
        try:
            octets = os.read(self._descriptor, MOST_READ)
        except BlockingIOError:
            return
        except OSError:
            octets = b""
        if not octets:
            # The other end of the port was closed for good.
            self._loop.remove_reader(self._descriptor)
            return
        now = self._now()
        if self._bench.speaker.parted_by_silence and now - self._heard > STALE:
            self._buffer.clear()
        if not self._buffer:
            self._began = now
        self._heard = now
        self._buffer += octets
        self._cut()

    def _cut(self) -> None:
        """Take every complete request off the buffer."""
        try:
            while length := self._bench.speaker.request_length(self._buffer):
                frame = bytes(self._buffer[:length])
                del self._buffer[:length]
                self._answer(frame)
        except BadReply:
            self._buffer.clear()

    def _answer(self, frame: bytes) -> None:
        if self._pace is not None:
            self._began += len(frame) * self._pace.character
        reply = asyncio.create_task(self._reply(frame, self._began))
        self._replies.add(reply)
        reply.add_done_callback(self._replies.discard)

    async def _reply(self, frame: bytes, complete: float) -> None:
        """Answer once the last octet of a request would have come. [s]."""
        silence = self._pace.silence if self._pace else 0.0
        await self._until(complete + silence)
        octets, delay = self._bench.respond(frame)
        if delay:
            await asyncio.sleep(delay)
        async with self._line:
            await self._send(octets)

    async def _send(self, octets: bytes) -> None:
        character = self._pace.character if self._pace else 0.0
        start, sent = self._now(), 0
        while sent < len(octets):
            await self._until(start + (sent + 1) * character)
            gone = self._now() - start
            due = int(gone / character) if character else len(octets)
            due = min(max(due, sent + 1), len(octets))
            if not self._put(octets[sent:due]):
                return
            sent = due

    def _put(self, octets: bytes) -> bool:
        """Write; who does not listen loses what the port does not keep."""
        try:
            os.write(self._descriptor, octets)
        except OSError as error:
            return error.errno == errno.EAGAIN
        return True

    async def _until(self, moment: float) -> None:
        # A timer may fire early.
        while (left := moment - self._now()) > 0:  # noqa: ASYNC110
            await asyncio.sleep(left)


@asynccontextmanager
async def serve_serial(
    speaker: Speaker,
    path: Path,
    pace: Pace | None,
    now: Callable[[], float] = time.monotonic,
    faults: WireFaults | None = None,
) -> AsyncIterator[BenchServer]:
    """Serve the rig on a serial line while inside.

    Parameters
    ----------
    speaker
        What is spoken on it.
    path
        A port that is there, or where to put a link to a pty made for it.
    pace
        How fast octets travel; None takes no time at all.
    now
        A clock that never steps. [s]
    faults
        What goes wrong on it; nothing unless told.

    Raises
    ------
    Refused
        The port does not open, or something else is in the way.
    """
    bench = BenchServer(speaker.modules, now, speaker, faults)
    bench.address = str(path)
    with ExitStack() as stack:
        line = SerialServer(bench, _port(path, pace, stack), pace, now)
        try:
            async with living(bench):
                yield bench
        finally:
            line.close()


def _port(path: Path, pace: Pace | None, stack: ExitStack) -> int:
    """Descriptor of a port that the stack closes."""
    if path.exists() and not path.is_char_device():
        message = f"{path} is in the way: it is no serial port"
        raise Refused(message, code="port-taken")
    opened = _existing(path, pace) if path.exists() else _made(path)
    try:
        return stack.enter_context(opened)
    except (OSError, ValueError) as error:
        message = f"{path} cannot be used as a serial port: {error}"
        raise Refused(message, code="port-taken") from error


@contextmanager
def _existing(path: Path, pace: Pace | None) -> Iterator[int]:
    pace = pace or Pace()
    with serial.Serial(
        str(path),
        baudrate=pace.baud,
        parity="E" if pace.parity else "N",
        stopbits=pace.stop_bits,
        timeout=0,
        exclusive=True,
    ) as port:
        yield port.fileno()


@contextmanager
def _made(path: Path) -> Iterator[int]:
    """A pty; its far end stays open, so that clients may come and go."""
    near, far = os.openpty()
    try:
        tty.setraw(far)
        os.set_blocking(near, False)
        name = Path(os.ttyname(far))
        _clear(path, name.parent)
        path.symlink_to(name)
        yield near
    finally:
        if path.is_symlink() and str(path.readlink()) == os.ttyname(far):
            path.unlink()
        os.close(near)
        os.close(far)


def _clear(path: Path, ptys: Path) -> None:
    """Remove the link to a pty that a bench of this user has left when it was killed.

    Raises
    ------
    Refused
        Somebody else's link, or one to something else.
    """
    if not path.is_symlink():
        return
    end = path.readlink()
    if path.lstat().st_uid != os.geteuid() or end.parent != ptys:
        message = (
            f"{path} is in the way: a link to {end}, which is not there, and no bench"
            " of this user has left it; remove it or choose another path"
        )
        raise Refused(message, code="port-taken")
    path.unlink()
