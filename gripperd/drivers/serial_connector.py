"""Opening a serial line, again after every loss."""

import asyncio
import time
from collections.abc import Callable
from pathlib import Path
from typing import Generic, TypeVar

import serial
import structlog

from gripperd.drivers.address import SerialAddress
from gripperd.drivers.line import Cut, Line
from gripperd.drivers.serial_line import SerialLine
from gripperd.drivers.serial_port import SYSFS, latency_timer, open_port
from gripperd.drivers.statistics import BusStatistics
from gripperd.errors import LinkLost

Q = TypeVar("Q")

log = structlog.get_logger()


class SerialConnector(Generic[Q]):
    """Opens one serial port, again after every loss.

    Parameters
    ----------
    address
        Where it is.
    cut
        Finds the end of a reply.
    statistics
        Counts what is thrown away.
    silence
        Before every request, as the grammar asks. [s]
    sysfs
        Where the kernel tells about its devices.
    open_
        Opens the port; it may take its time.
    """

    def __init__(
        self,
        address: SerialAddress,
        cut: Cut[Q],
        statistics: BusStatistics,
        silence: float,
        sysfs: Path = SYSFS,
        open_: Callable[[SerialAddress], serial.Serial] = open_port,
    ) -> None:
        self._address = address
        self._cut = cut
        self._statistics = statistics
        self._silence = silence if address.silence is None else address.silence
        self._sysfs = sysfs
        self._open = open_
        self._told = False

    async def open(self) -> Line[Q]:
        """Open the port and wait until it is quiet.

        Raises
        ------
        LinkLost
            It does not open, or never falls quiet.
        """
        port, delay = await self._port()
        line = SerialLine(
            port,
            self._address,
            self._cut,
            self._statistics,
            self._silence,
            time.monotonic,
        )
        self._tell_latency(delay)
        try:
            await line.drain()
        except asyncio.CancelledError:
            line.close()
            raise
        if line.closed.is_set():
            raise LinkLost(line.outage)
        return line

    async def _port(self) -> tuple[serial.Serial, int | None]:
        """Open it in a thread: a driver may take seconds, and nobody waits for it."""
        opening = asyncio.get_running_loop().run_in_executor(None, self._opened)
        try:
            return await asyncio.shield(opening)
        except asyncio.CancelledError:
            opening.add_done_callback(_close_unwanted)
            raise

    def _opened(self) -> tuple[serial.Serial, int | None]:
        port = self._open(self._address)
        return port, latency_timer(self._address.port, self._sysfs)

    def _tell_latency(self, delay: int | None) -> None:
        """Log once that the adapter delays every reply. [ms]."""
        if self._told or delay is None or delay <= 1:
            return
        self._told = True
        log.warning(
            "the serial adapter gathers octets before it passes them on;"
            " see docs/serial.md",
            port=self._address.port,
            latency_timer_ms=delay,
        )


def _close_unwanted(opening: asyncio.Future[tuple[serial.Serial, int | None]]) -> None:
    """Close a port that has opened after all."""
    if not opening.cancelled() and opening.exception() is None:
        opening.result()[0].close()
