"""Frames on a Unix socket: a length, then MessagePack. The one codec of both ends."""

from asyncio import IncompleteReadError, StreamReader
from typing import Any, TypeVar

import msgspec

from gripperd import errors

LENGTH = 4
LONGEST = 1 << 20
"""No message comes near it; a longer one is not ours. [octets]"""

LINK_ERRORS = frozenset(
    {
        errors.LinkError,
        errors.LinkLost,
        errors.ReplyTimeout,
        errors.BadReply,
        errors.LocalEcho,
        errors.ModuleMismatch,
    }
)
"""Those that say nothing but their message."""

T = TypeVar("T")

_encoder = msgspec.msgpack.Encoder()


class Ask(msgspec.Struct, frozen=True, array_like=True):
    """A request on its way."""

    id: int
    body: msgspec.Raw


class Failed(msgspec.Struct, frozen=True):
    """An error on its way; it is raised again at the other end."""

    error: str
    """Name of a class in :mod:`gripperd.errors`."""
    message: str
    code: str = ""
    hints: tuple[str, ...] = ()
    key: str | None = None
    exception_code: int | None = None


class Answer(msgspec.Struct, frozen=True, array_like=True):
    """What came of a request."""

    id: int
    body: msgspec.Raw
    failed: Failed | None = None


def encode(message: Any) -> bytes:  # noqa: ANN401 - whatever msgspec knows
    """MessagePack of a message."""
    return _encoder.encode(message)


def decode(octets: bytes | msgspec.Raw, kind: type[T]) -> T:
    """A message of a known type.

    Raises
    ------
    BadReply
        The octets are no such message.
    """
    try:
        return msgspec.msgpack.decode(octets, type=kind)
    except msgspec.DecodeError as error:
        message = f"a message between the processes is garbled: {error}"
        raise errors.BadReply(message) from error


def frame(message: Ask | Answer) -> bytes:
    """Octets that go on the socket."""
    body = encode(message)
    return len(body).to_bytes(LENGTH, "big") + body


async def read_frame(reader: StreamReader) -> bytes | None:
    """Body of the next frame, None at the end of the stream.

    Raises
    ------
    BadReply
        The stream cannot be followed further.
    """
    try:
        length = int.from_bytes(await reader.readexactly(LENGTH), "big")
        if length > LONGEST:
            message = f"a frame of {length} octets is not ours"
            raise errors.BadReply(message)
        return await reader.readexactly(length)
    except (IncompleteReadError, ConnectionError):
        return None


def failed(error: errors.GripperdError) -> Failed:
    """An error, ready to travel."""
    name, message = type(error).__name__, str(error)
    if isinstance(error, errors.Refused):
        return Failed(name, message, code=error.code, hints=error.hints)
    if isinstance(error, errors.InputError):
        return Failed(name, message, key=error.key)
    if isinstance(error, errors.DeviceRefused):
        return Failed(name, message, exception_code=error.exception_code)
    return Failed(name, message)


def raised(failed: Failed) -> errors.GripperdError:
    """The error as it was raised at the other end."""
    kind = getattr(errors, failed.error, None)
    if kind is errors.Refused:
        return errors.Refused(failed.message, code=failed.code, hints=failed.hints)
    if kind in {errors.InputError, errors.DomainError, errors.NotFound}:
        error: errors.GripperdError = kind(failed.message, key=failed.key)
        return error
    if kind in LINK_ERRORS:
        lost: errors.GripperdError = kind(failed.message)
        return lost
    if kind in {errors.DeviceRefused, errors.WatchdogTripped}:
        refused: errors.GripperdError = kind(
            failed.message, exception_code=failed.exception_code
        )
        return refused
    # Nothing that was raised on purpose: asking again would not help.
    return errors.GripperdError(failed.message)
