"""Modules on a real socket, unit by unit, and the doctor run against them."""

import asyncio
import os
import sys
from collections.abc import AsyncIterator, Mapping
from contextlib import asynccontextmanager
from dataclasses import dataclass
from typing import TypeAlias

from gripperd.protocol.mbap import ModbusTcp
from gripperd.protocol.modbus import Read, Refusal, Table

TCP = ModbusTcp()
Image: TypeAlias = dict[tuple[Table, int], int]
"""What a unit holds."""


def image(table: Table, first: int, *values: int) -> Image:
    return {(table, first + place): value for place, value in enumerate(values)}


AO = image(Table.HOLDING, 0, 10_700, *[4000] * 7) | image(Table.HOLDING, 0x8000, 100)
"""A Waveshare Analog Output 8CH that gives 10.7 mA on channel 0."""
AI = (
    image(Table.INPUT, 0, 8000, 12_000, 0, *[4000] * 5)
    | image(Table.HOLDING, 0x1000, *[2] * 8)
    | image(Table.HOLDING, 0x8000, 120)
)
"""A Waveshare Analog Input 8CH, 0-20 mA, with a broken wire on channel 2."""


@dataclass
class Rack:
    """Units behind one gateway; every write is refused and remembered."""

    units: Mapping[int, Image]
    port: int = 0
    writes: int = 0

    @property
    def address(self) -> str:
        return f"127.0.0.1:{self.port}"

    def answer(self, frame: bytes) -> bytes:
        request = TCP.decode_request(frame)
        if not isinstance(request, Read):
            self.writes += 1
            return TCP.encode_refusal(frame, Refusal.ILLEGAL_FUNCTION)
        held = self.units.get(request.unit)
        if held is None:
            return TCP.encode_refusal(frame, Refusal.NO_RESPONSE)
        places = [(request.table, request.address + n) for n in range(request.count)]
        if not held.keys() >= set(places):
            return TCP.encode_refusal(frame, Refusal.ILLEGAL_ADDRESS)
        return TCP.encode_reply(frame, request, [held[place] for place in places])

    async def serve(
        self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter
    ) -> None:
        buffer = bytearray()
        while octets := await reader.read(4096):
            buffer += octets
            while (length := TCP.request_length(buffer)) is not None:
                writer.write(self.answer(bytes(buffer[:length])))
                del buffer[:length]
        writer.close()


@asynccontextmanager
async def powered(units: Mapping[int, Image]) -> AsyncIterator[Rack]:
    rack = Rack(units)
    server = await asyncio.start_server(rack.serve, "127.0.0.1", 0)
    rack.port = server.sockets[0].getsockname()[1]
    async with server:
        yield rack


@dataclass(frozen=True)
class Said:
    status: int
    out: str
    err: str


async def doctor(*arguments: str) -> Said:
    """Run ``gripperd doctor`` while this loop serves its modules."""
    environment = {k: v for k, v in os.environ.items() if k != "GRIPPERD_CONFIG"}
    process = await asyncio.create_subprocess_exec(
        *(sys.executable, "-m", "gripperd", "doctor", *arguments),
        stdout=asyncio.subprocess.PIPE,
        stderr=asyncio.subprocess.PIPE,
        env=environment,
    )
    out, err = await process.communicate()
    assert process.returncode is not None
    return Said(process.returncode, out.decode(), err.decode())
