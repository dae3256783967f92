"""Lines of text: DCON and the ITV."""

import random

from gripperd.protocol import itv
from gripperd.protocol.dcon import HOST_OK, Ask, Command, Dcon, Good, Lead
from gripperd.protocol.itv import Itv

from .half import Case, Half, OtherHalf
from .octets import as_it_is

ASKS = (
    HOST_OK,
    Ask(1, "0+10.700"),
    Ask(1, "C0+10.700", good=Good.ADDRESS),
    Ask(0xAB, "60", Lead.SETTING, Good.ADDRESS, 7),
    Ask(1, "", payload=None),
)
ITV_REQUESTS: tuple[itv.Request, ...] = (itv.Set(512), *itv.Query)


def dcon_halves(line: Dcon, name: str) -> dict[str, Case]:
    """Both halves of DCON."""

    def reply(rng: random.Random, ask: Ask) -> bytes:
        if rng.random() < 0.1:
            return rng.choice((b"!\r", b"?\r", b"?01\r", b"!21\r", b"?3F\r"))
        return line.encode_reply(ask, ask.good, "+10.700"[: ask.payload])

    def holds(ask: Ask, frame: bytes, text: str) -> bool:
        if ask.unit is None:
            return not frame
        return frame == line.encode_reply(ask, ask.good, text)

    def understood(frame: bytes, command: Command | None) -> bool:
        return command is None or line.encode(command, 1) == frame

    return {
        f"{name} reply": Half(
            ASKS, line.frame_length, line.decode, reply, as_it_is, holds
        ),
        f"{name} request": OtherHalf(
            lambda rng: line.encode(rng.choice(ASKS), 1),
            line.request_length,
            line.decode_request,
            as_it_is,
            understood,
        ),
    }


def itv_halves() -> dict[str, Case]:
    """Both halves of the ITV."""
    line = Itv()

    def reply(rng: random.Random, request: itv.Request) -> bytes:
        if rng.random() < 0.1:
            return line.encode_refusal(rng.choice(list(itv.Refusal)))
        mine = isinstance(request, itv.Set)
        return line.encode_reply(512 if mine else rng.randrange(1024))

    def understood(frame: bytes, request: itv.Request | itv.Refusal) -> bool:
        if isinstance(request, itv.Set):
            # Leading zeros are the only freedom there is.
            return int(frame[4:]) == request.count
        return isinstance(request, itv.Refusal) or line.encode(request, 1) == frame

    return {
        "ITV reply": Half(
            ITV_REQUESTS,
            line.frame_length,
            line.decode,
            reply,
            as_it_is,
            lambda _, frame, count: int(frame) == count,
        ),
        "ITV request": OtherHalf(
            lambda rng: line.encode(rng.choice(ITV_REQUESTS), 1),
            line.request_length,
            line.decode_request,
            as_it_is,
            understood,
        ),
    }
