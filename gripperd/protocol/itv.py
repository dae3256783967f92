"""SMC ITV regulators with RS-232C: lines of text, both halves.

The set-point and the measured pressure are counts, 0 to 1023 over the range of the
regulator. No manual was at hand: the lines are those of public drivers for the
ITV1050-RC2N, ITV1050-RCF2N and their like, on hardware.
"""

from dataclasses import dataclass
from enum import StrEnum
from typing import TypeAlias

from gripperd.errors import BadReply, DeviceRefused, InputError
from gripperd.protocol.disbelief import not_believed

END = b"\r\n"

FULL_SCALE = 1023
"""Count at the end of the regulator's range."""

LONGEST = 32
"""Octets in which a line must end; `UNKNOWN COMMAND` takes 17."""


class Query(StrEnum):
    """What can be asked."""

    PRESSURE = "MON"
    """The pressure that is measured."""
    SET_POINT = "REQ"
    """The pressure that is aimed at."""


@dataclass(frozen=True, slots=True)
class Set:
    """Aim at a pressure.

    Raises
    ------
    InputError
        Outside 0 to 1023.
    """

    count: int

    def __post_init__(self) -> None:
        if not 0 <= self.count <= FULL_SCALE:
            message = f"{self.count} is no set-point of an ITV: 0 to {FULL_SCALE} is"
            raise InputError(message, key="count")

    def __str__(self) -> str:
        """As it is sent."""
        return f"SET {self.count}"


Request: TypeAlias = Set | Query


class Refusal(StrEnum):
    """What the regulator says when it does not do as it is told."""

    UNKNOWN_COMMAND = "UNKNOWN COMMAND"
    OUT_OF_RANGE = "OUT OF RANGE"


@dataclass(frozen=True, slots=True)
class Itv:
    """Lines of an ITV.

    A reply is a bare number. A late one cannot be told from the right one, except by
    a `Set`, which is answered with its own count: whoever owns the line must let it
    fall silent before asking again.
    """

    def encode(self, request: Request, sequence: int) -> bytes:
        """Octets of a request; the line carries no `sequence`."""
        return str(request).encode("ascii") + END

    def frame_length(self, request: Request, buffer: bytes | bytearray) -> int | None:
        """Octets of the reply at the start of a buffer, None while it is incomplete.

        Raises
        ------
        BadReply
            It does not end.
        """
        return self.request_length(buffer)

    def decode(self, request: Request, sequence: int, frame: bytes) -> int:
        """Believe a reply only if it can answer the request.

        Returns
        -------
        The count that was asked for, or set.

        Raises
        ------
        BadReply
            Not a count from 0 to 1023, or another one than was set.
        DeviceRefused
            The regulator says that the request is unknown or out of range.
        """
        text = frame.removesuffix(END).decode("latin-1")
        if frame.endswith(END) and text in set(Refusal):
            raise DeviceRefused(f"the regulator refuses '{request}': {text.lower()}")
        count = _count(text)
        if not frame.endswith(END) or count is None:
            raise not_believed(request, "it is not a count", repr(frame))
        if isinstance(request, Set) and count != request.count:
            raise not_believed(request, "another count comes back", repr(frame))
        return count

    def request_length(self, buffer: bytes | bytearray) -> int | None:
        """Octets of the line at the start of a buffer, None while it is incomplete.

        Raises
        ------
        BadReply
            It does not end; follow the stream again after the next end of a line.
        """
        end = buffer.find(END, 0, LONGEST)
        if end >= 0:
            return end + len(END)
        if len(buffer) >= LONGEST:
            message = f"a line does not end: {bytes(buffer[:LONGEST])!r}"
            raise BadReply(message)
        return None

    def decode_request(self, frame: bytes) -> Request | Refusal:
        """What a complete line asks; :class:`Refusal` where it asks too much."""
        text = frame.removesuffix(END).decode("latin-1")
        if text in set(Query):
            return Query(text)
        if not text.startswith("SET "):
            return Refusal.UNKNOWN_COMMAND
        count = _count(text.removeprefix("SET "))
        return Refusal.OUT_OF_RANGE if count is None else Set(count)

    def encode_reply(self, count: int) -> bytes:
        """Answer to any request that is granted."""
        return b"%d" % count + END

    def encode_refusal(self, refusal: Refusal) -> bytes:
        """Answer to a request that is not."""
        return refusal.value.encode("ascii") + END


def _count(text: str) -> int | None:
    """The number in one to four digits, if it is one of an ITV."""
    # Latin-1 has no decimals but 0 to 9.
    if not text.isdecimal() or len(text) > 4:
        return None
    count = int(text)
    return count if count <= FULL_SCALE else None
