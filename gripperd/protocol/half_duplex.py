"""Lines on which a sender may hear itself before it hears the answer."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Generic, TypeVar

from gripperd.errors import BadReply, LocalEcho
from gripperd.protocol.disbelief import not_believed

Q = TypeVar("Q")
R = TypeVar("R")


@dataclass(frozen=True, slots=True, kw_only=True)
class HalfDuplex(ABC, Generic[Q, R]):
    """Takes the echo off, or says that there is one.

    Many two-wire RS-485 adapters hand back every octet that they send.
    """

    local_echo: bool = False
    """The line echoes: each reply comes behind a copy of its request."""

    @abstractmethod
    def encode(self, request: Q, sequence: int) -> bytes:
        """Octets to send; the line carries no `sequence`."""

    @abstractmethod
    def _reply_length(self, request: Q, buffer: bytes | bytearray) -> int | None:
        """As `frame_length`, with the echo taken off."""

    @abstractmethod
    def _decode_reply(self, request: Q, frame: bytes) -> R:
        """As `decode`, with the echo taken off."""

    def frame_length(self, request: Q, buffer: bytes | bytearray) -> int | None:
        """Octets of echo and reply at the start of a buffer, None while incomplete.

        Raises
        ------
        LocalEcho
            It is the request, and no echo was announced.
        BadReply
            What has come cannot be the start of a reply to this request.
        """
        if not self.local_echo:
            return self._unechoed_length(request, buffer)
        sent = self.encode(request, 0)
        if not (buffer.startswith(sent) or sent.startswith(buffer)):
            raise _no_echo(request, buffer)
        if len(buffer) < len(sent):
            return None
        length = self._reply_length(request, buffer[len(sent) :])
        return None if length is None else len(sent) + length

    def decode(self, request: Q, sequence: int, frame: bytes) -> R:
        """Believe a complete reply only if it answers the request.

        Raises
        ------
        LocalEcho
            It is the request, and no echo was announced.
        BadReply
            It answers something else, or is damaged.
        DeviceRefused
            A sound reply in which the device refuses.
        """
        if not self.local_echo:
            return self._decode_unechoed(request, frame)
        sent = self.encode(request, 0)
        if not frame.startswith(sent):
            raise _no_echo(request, frame)
        return self._decode_reply(request, frame[len(sent) :])

    def _unechoed_length(self, request: Q, buffer: bytes | bytearray) -> int | None:
        try:
            return self._reply_length(request, buffer)
        except BadReply:
            sent = self.encode(request, 0)
            if buffer.startswith(sent):
                raise _echo(request) from None
            if sent.startswith(buffer):
                return None
            raise

    def _decode_unechoed(self, request: Q, frame: bytes) -> R:
        try:
            return self._decode_reply(request, frame)
        except BadReply:
            # The echo of a long request was cut to the length of the reply.
            sent = self.encode(request, 0)
            if frame and (sent.startswith(frame) or frame.startswith(sent)):
                raise _echo(request) from None
            raise


def _echo(request: object) -> LocalEcho:
    return LocalEcho(
        f"the reply to '{request}' is the request itself: the line echoes what is sent;"
        " set 'local_echo: true' for this bus"
    )


def _no_echo(request: object, octets: bytes | bytearray) -> BadReply:
    why = (
        "it does not begin with the echo of the request; 'local_echo: true' is set,"
        " and either the line does not echo or others talk on it"
    )
    return not_believed(request, why, octets.hex(" "))
