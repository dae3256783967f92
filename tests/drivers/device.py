"""Modbus devices on a real socket: registers that can be read, written and watched."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import cast

from gripperd.drivers.bus import ModbusBus, TcpAddress, open_bus
from gripperd.protocol.mbap import ModbusTcp
from gripperd.protocol.modbus import Read, Refusal, Request, Table, Write, WriteCoil

from .peer import SOON, up

TCP = ModbusTcp()


class Device:
    """Every unit has these registers; what is not there is an illegal address."""

    def __init__(self, registers: dict[tuple[Table, int], int]) -> None:
        self.registers = registers
        self.requests: list[Request] = []
        self.frozen: set[tuple[Table, int]] = set()
        """Places that a write is confirmed for, and does not change."""
        self.causing: dict[tuple[Table, int], dict[tuple[Table, int], int]] = {}
        """Registers that a write to another place changes."""

    @property
    def writes(self) -> list[Write | WriteCoil]:
        return [each for each in self.requests if not isinstance(each, Read)]

    def answer(self, frame: bytes) -> bytes:
        request = TCP.decode_request(frame)
        assert not isinstance(request, Refusal)
        self.requests.append(request)
        found = self._carry_out(request)
        if isinstance(found, Refusal):
            return TCP.encode_refusal(frame, found)
        return TCP.encode_reply(frame, request, found)

    def _carry_out(self, request: Request) -> tuple[int, ...] | Refusal:
        match request:
            case Read(_, table, address, count):
                places = [(table, address + n) for n in range(count)]
                if not set(places) <= self.registers.keys():
                    return Refusal.ILLEGAL_ADDRESS
                return tuple(self.registers[place] for place in places)
            case Write(_, address, values):
                for n, value in enumerate(values):
                    self._put((Table.HOLDING, address + n), value)
            case WriteCoil(_, address, on):
                self._put((Table.COILS, address), int(on))
        return ()

    def _put(self, place: tuple[Table, int], value: int) -> None:
        if place not in self.frozen:
            self.registers[place] = value
            self.registers |= self.causing.get(place, {})


class _Line(asyncio.Protocol):
    def __init__(self, device: Device) -> None:
        self._device = device
        self._buffer = bytearray()
        self.transport: asyncio.Transport | None = None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        self.transport = cast("asyncio.Transport", transport)

    def data_received(self, octets: bytes) -> None:
        assert self.transport is not None
        self._buffer += octets
        while (length := TCP.request_length(self._buffer)) is not None:
            frame = bytes(self._buffer[:length])
            del self._buffer[:length]
            self.transport.write(self._device.answer(frame))


@asynccontextmanager
async def on_the_wire(device: Device) -> AsyncIterator[ModbusBus]:
    """A bus that leads to the device."""
    loop = asyncio.get_running_loop()
    lines: list[_Line] = []

    def accept() -> _Line:
        lines.append(_Line(device))
        return lines[-1]

    server = await loop.create_server(accept, "127.0.0.1", 0)
    port = server.sockets[0].getsockname()[1]
    address = TcpAddress(host="127.0.0.1", port=port, timeout=SOON)
    try:
        async with open_bus(address) as bus:
            await up(bus)
            yield bus
    finally:
        server.close()
        for line in lines:
            if line.transport is not None:
                line.transport.abort()


def holding(first: int, *values: int) -> dict[tuple[Table, int], int]:
    """Consecutive holding registers."""
    return {(Table.HOLDING, first + n): value for n, value in enumerate(values)}


def placed(table: Table, first: int, *values: int) -> dict[tuple[Table, int], int]:
    """Consecutive registers or bits of any table."""
    return {(table, first + n): value for n, value in enumerate(values)}
