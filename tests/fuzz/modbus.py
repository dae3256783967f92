"""Modbus TCP and RTU."""

import random

from gripperd.protocol.mbap import ModbusTcp
from gripperd.protocol.modbus import Read, Refusal, Request, Table, Write, WriteCoil
from gripperd.protocol.rtu import ModbusRtu, crc

from .half import Case, Half, OtherHalf
from .octets import framed, sealed

TCP, RTU, ECHOING = ModbusTcp(), ModbusRtu(), ModbusRtu(local_echo=True)

REQUESTS: tuple[Request, ...] = (
    Write(1, 0, (10_700,)),
    Write(1, 0, (10_700,), multiple=True),
    Write(3, 0x20, (0x3333, 0x412B)),
    WriteCoil(1, 269, on=True),
    Read(1, Table.HOLDING, 0, 1),
    Read(2, Table.INPUT, 0, 8),
    Read(1, Table.INPUT, 0x1000, 8),
    Read(4, Table.COILS, 259, 11),
    Read(4, Table.DISCRETE, 0, 1),
)


def _values(rng: random.Random, request: Request) -> tuple[int, ...]:
    if not isinstance(request, Read):
        return ()
    most = 1 if request.table.of_bits else 0xFFFF
    return tuple(rng.randint(0, most) for _ in range(request.count))


def _same(a: bytes, b: bytes, request: Request) -> bool:
    """Whether two replies are equal, but for what pads bits."""
    return a == b or (isinstance(request, Read) and request.table.of_bits)


def tcp_reply(rng: random.Random, request: Request) -> bytes:
    asked = TCP.encode(request, 1)
    if rng.random() < 0.1:
        return TCP.encode_refusal(asked, rng.choice(list(Refusal)))
    return TCP.encode_reply(asked, request, _values(rng, request))


def rtu_reply(rng: random.Random, request: Request) -> bytes:
    asked = RTU.encode(request, 1)
    chance = rng.random()
    if chance < 0.1:
        return RTU.encode_refusal(asked, rng.choice(list(Refusal)))
    reply = RTU.encode_reply(asked, request, _values(rng, request))
    return asked + reply if chance < 0.2 else reply


def echoed(rng: random.Random, request: Request) -> bytes:
    return RTU.encode(request, 1) + rtu_reply(rng, request)


def tcp_holds(request: Request, frame: bytes, values: tuple[int, ...]) -> bool:
    return _same(frame, TCP.encode_reply(frame, request, values), request)


def rtu_holds(request: Request, frame: bytes, values: tuple[int, ...]) -> bool:
    return _same(frame, RTU.encode_reply(frame, request, values), request)


def echo_holds(request: Request, frame: bytes, values: tuple[int, ...]) -> bool:
    asked = RTU.encode(request, 1)
    return frame.startswith(asked) and rtu_holds(request, frame[len(asked) :], values)


def tcp_understood(frame: bytes, request: Request | Refusal) -> bool:
    if isinstance(request, Refusal):
        return len(TCP.encode_refusal(frame, request)) == 9
    return TCP.encode(request, int.from_bytes(frame[:2])) == frame


def rtu_understood(frame: bytes, request: Request | Refusal | None) -> bool:
    if request is None:
        return crc(frame) != 0
    if isinstance(request, Refusal):
        return len(RTU.encode_refusal(frame, request)) == 5
    return request.unit == 0 or RTU.encode(request, 0) == frame


def modbus_halves() -> dict[str, Case]:
    """Both halves of Modbus TCP and RTU."""
    return {
        "TCP reply": Half(
            REQUESTS, TCP.frame_length, TCP.decode, tcp_reply, framed, tcp_holds
        ),
        "RTU reply": Half(
            REQUESTS, RTU.frame_length, RTU.decode, rtu_reply, sealed, rtu_holds
        ),
        "RTU reply, echo": Half(
            REQUESTS, ECHOING.frame_length, ECHOING.decode, echoed, sealed, echo_holds
        ),
        "TCP request": OtherHalf(
            lambda rng: TCP.encode(rng.choice(REQUESTS), 1),
            TCP.request_length,
            TCP.decode_request,
            framed,
            tcp_understood,
        ),
        "RTU request": OtherHalf(
            lambda rng: RTU.encode(rng.choice(REQUESTS), 1),
            RTU.request_length,
            RTU.decode_request,
            sealed,
            rtu_understood,
        ),
    }
