"""What every line grammar offers to the owner of a bus."""

from typing import Protocol, TypeVar

Q = TypeVar("Q", contravariant=True)
"""A request."""
R = TypeVar("R", covariant=True)
"""What a believed reply says."""


class Dialect(Protocol[Q, R]):
    """Octets of a request, and what its reply says. No I/O, no memory."""

    def encode(self, request: Q, sequence: int) -> bytes:
        """Octets to send; `sequence` numbers requests from 1 to 65535, then from 1."""
        ...

    def frame_length(self, request: Q, buffer: bytes | bytearray) -> int | None:
        """Octets of the reply at the start of a buffer, None while it is incomplete.

        It is 0 for a request that has no reply, such as one to every module of a line.

        Raises
        ------
        BadReply
            What has come cannot be the start of a reply to this request.
        """
        ...

    def decode(self, request: Q, sequence: int, frame: bytes) -> R:
        """Believe a complete reply only if it answers the request.

        Raises
        ------
        BadReply
            It answers something else, or is damaged.
        DeviceRefused
            A sound reply in which the device refuses.
        """
        ...
