"""Devices that speak text, on the far end of a real pty."""

import asyncio
import os
import tty
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager

from gripperd.drivers.bus import Bus, DconAddress, ItvAddress, open_bus
from gripperd.protocol import itv
from gripperd.protocol.dcon import Ask

from .peer import up
from .steady import steady

PATIENCE = 0.3
"""Time-out of the line, and so the silence before it is first used. [s]"""

Answer = Callable[[str], str | None]


class TextDevice:
    """Answers each line as it is told; lines are without their end."""

    def __init__(self, answer: Answer, end: str = "\r") -> None:
        self.answer = answer
        self.lines: list[str] = []
        self._end = end
        self._text = ""
        self._master, self._slave = os.openpty()
        tty.setraw(self._slave)
        os.set_blocking(self._master, False)
        self.port = os.ttyname(self._slave)

    def start(self) -> None:
        asyncio.get_running_loop().add_reader(self._master, self._read)

    def stop(self) -> None:
        asyncio.get_running_loop().remove_reader(self._master)
        os.close(self._master)
        os.close(self._slave)

    def _read(self) -> None:
        self._text += os.read(self._master, 4096).decode()
        while self._end in self._text:
            line, _, self._text = self._text.partition(self._end)
            self.lines.append(line)
            reply = self.answer(line)
            if reply is not None:
                os.write(self._master, f"{reply}{self._end}".encode())


@asynccontextmanager
async def dcon_line(device: TextDevice) -> AsyncIterator[Bus[Ask, str]]:
    """A bus that leads to a DCON module."""
    device.start()
    try:
        async with open_bus(DconAddress(port=device.port, timeout=PATIENCE)) as bus:
            steady(bus)
            await up(bus)
            yield bus
    finally:
        device.stop()


@asynccontextmanager
async def itv_line(device: TextDevice) -> AsyncIterator[Bus[itv.Request, int]]:
    """A bus that leads to a regulator."""
    device.start()
    try:
        async with open_bus(ItvAddress(port=device.port, timeout=PATIENCE)) as bus:
            steady(bus)
            await up(bus)
            yield bus
    finally:
        device.stop()
