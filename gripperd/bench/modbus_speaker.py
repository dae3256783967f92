"""Modbus on behalf of the bench's modules, on TCP and on serial lines."""

from abc import abstractmethod
from typing import ClassVar

from gripperd.bench.modules import Modules
from gripperd.bench.register_device import RegisterDevice
from gripperd.bench.speaker import Speaker
from gripperd.protocol import mbap, pdu, rtu
from gripperd.protocol.modbus import Read, Refusal, Request, Table
from gripperd.protocol.modules import ModuleDialect

BROADCAST = 0
"""Unit of a request to every module of a serial line; none answers."""


class ModbusSpeaker(Speaker):
    """What both kinds of line have in common."""

    _codec: ClassVar[mbap.ModbusTcp | rtu.ModbusRtu]
    _at: ClassVar[int]
    """Place of the unit in a frame."""

    def __init__(self, modules: Modules) -> None:
        super().__init__(modules)
        modules.spoken((ModuleDialect.MODBUS,))
        self._devices = {
            unit: RegisterDevice(*at) for unit, at in modules.units.items()
        }

    def request_length(self, buffer: bytes | bytearray) -> int | None:
        """Octets of the request at the start of a buffer, None while incomplete."""
        return self._codec.request_length(buffer)

    def heard(self, frame: bytes) -> tuple[frozenset[int], bool]:
        """Units that a complete request is for, and whether it writes."""
        request = self._codec.decode_request(frame)
        writes = not isinstance(request, Read | Refusal | None)
        return frozenset({self._unit(frame)}), writes

    def answer(self, frame: bytes) -> bytes:
        """Do as a request says, and reply; nothing where nobody answers."""
        request = self._codec.decode_request(frame)
        if request is None:
            return b""
        unit = self._unit(frame)
        if unit not in self._devices:
            return self._unanswered(frame, request)
        if isinstance(request, Refusal):
            return self._codec.encode_refusal(frame, request)
        found = self._devices[unit].answer(request)
        if isinstance(found, Refusal):
            return self._codec.encode_refusal(frame, found)
        return self._codec.encode_reply(frame, request, found)

    def refusal(self, frame: bytes, code: int) -> bytes:
        """Exception reply, of any code."""
        unit = self._unit(frame)
        if unit not in self._devices:
            return b""
        function = frame[self._at + 1] | pdu.EXCEPTION
        return self._framed(frame, unit, bytes((function, code)))

    @abstractmethod
    def _body(self, reply: bytes) -> bytes:
        """Function of a reply and what follows it."""

    @abstractmethod
    def _framed(self, frame: bytes, unit: int, body: bytes) -> bytes:
        """Answer to the request in a frame."""

    @abstractmethod
    def _unanswered(self, frame: bytes, request: Request | Refusal) -> bytes:
        """What comes back where no module is at that unit."""

    def _unit(self, frame: bytes) -> int:
        return frame[self._at]

    def _from_another_unit(self, frame: bytes, reply: bytes) -> bytes:
        return self._framed(frame, self._unit(frame) ^ 0x40, self._body(reply))

    def _to_another_function(self, frame: bytes, reply: bytes) -> bytes:
        body = self._body(reply)
        return self._framed(frame, self._unit(frame), bytes((body[0] ^ 7,)) + body[1:])

    def _with_another_value(self, frame: bytes, reply: bytes) -> bytes:
        body = self._body(reply)
        other = body[:-1] + bytes((body[-1] ^ 1,))
        return self._framed(frame, self._unit(frame), other)

    def _shortened(self, frame: bytes, reply: bytes) -> bytes:
        body = self._body(reply)
        if body[0] & pdu.EXCEPTION:
            return reply
        octets = body[2:-1] if Table(body[0]).of_bits else body[2:-2]
        short = bytes((body[0], len(octets))) + octets
        return self._framed(frame, self._unit(frame), short)


class TcpSpeaker(ModbusSpeaker):
    """Modbus TCP; a unit that is not there is the gateway's to refuse."""

    name = "modbus_tcp"
    _codec = mbap.ModbusTcp()
    _at = mbap.HEADER - 1

    def _body(self, reply: bytes) -> bytes:
        return reply[mbap.HEADER :]

    def _framed(self, frame: bytes, unit: int, body: bytes) -> bytes:
        counted = (len(body) + 1).to_bytes(2, "big")
        return frame[:4] + counted + bytes((unit,)) + body

    def _unanswered(self, frame: bytes, request: Request | Refusal) -> bytes:
        refusal = request if isinstance(request, Refusal) else Refusal.NO_RESPONSE
        return self._codec.encode_refusal(frame, refusal)

    def _garbled(self, frame: bytes, reply: bytes) -> bytes:
        # TCP has a checksum of its own: only what ties a reply to its request is seen.
        return bytes((reply[0] ^ 0x20,)) + reply[1:]


class RtuSpeaker(ModbusSpeaker):
    """Modbus RTU; a unit that is not there is silent, and a broadcast unanswered."""

    name = "modbus_rtu"
    parted_by_silence = True
    _codec = rtu.ModbusRtu()
    _at = 0

    def heard(self, frame: bytes) -> tuple[frozenset[int], bool]:
        """Units that a complete request is for, and whether it writes."""
        units, writes = super().heard(frame)
        return frozenset(self._devices) if units == {BROADCAST} else units, writes

    def _body(self, reply: bytes) -> bytes:
        return reply[1:-2]

    def _framed(self, frame: bytes, unit: int, body: bytes) -> bytes:
        octets = bytes((unit,)) + body
        return octets + rtu.crc(octets).to_bytes(2, "little")

    def _unanswered(self, frame: bytes, request: Request | Refusal) -> bytes:
        if frame[0] == BROADCAST and not isinstance(request, Refusal | Read):
            for device in self._devices.values():
                device.answer(request)
        return b""

    def _garbled(self, frame: bytes, reply: bytes) -> bytes:
        return reply[:-3] + bytes((reply[-3] ^ 0x20,)) + reply[-2:]
