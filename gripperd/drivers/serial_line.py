"""A serial line.

Nothing on a serial line says which request a reply answers, so that silence has to:
before every request, and for much longer after one that was not answered soundly.

References
----------
.. [1] MODBUS over Serial Line Specification and Implementation Guide V1.02,
       section 2.5.1.1: frames are parted by 3.5 characters of silence.
"""

import asyncio
import os
import termios
from collections.abc import Callable
from contextlib import suppress
from typing import TypeVar

import serial

from gripperd.drivers.address import LONGEST_DRAIN, SerialAddress
from gripperd.drivers.line import Cut, Line
from gripperd.drivers.statistics import BusStatistics
from gripperd.errors import BadReply, LinkLost

Q = TypeVar("Q")

MOST_READ = 4096
"""What the kernel keeps of a port at most."""


class SerialLine(Line[Q]):
    """An open serial port.

    Parameters
    ----------
    port
        Opened so that nothing waits on it.
    address
        Where it is, and what its times are.
    cut, statistics
        See :class:`Line`.
    silence
        Before every request. [s]
    now
        A clock that never steps. [s]
    """

    def __init__(
        self,
        port: serial.Serial,
        address: SerialAddress,
        cut: Cut[Q],
        statistics: BusStatistics,
        silence: float,
        now: Callable[[], float],
    ) -> None:
        super().__init__(str(address), address.timeout, cut, statistics, now)
        # Whoever had the port before may have asked something.
        self.spoiled = True
        # A converter that echoes is found out by the first reply that is believed.
        self.proved = False
        self.halting = True
        self._port = port
        self._descriptor = port.fileno()
        self._silence = silence
        self._heard = now()
        self._loop.add_reader(self._descriptor, self._read)

    async def pause(self) -> None:
        """Return once the line is silent enough for a request.

        Raises
        ------
        BadReply
            It does not fall silent.
        """
        limit = self._now() + self._timeout
        self._read()
        while (left := self._heard + self._silence - self._now()) > 0:
            # Not by what time it is: a timer may ring before the silence is over.
            if self._heard > limit:
                message = f"{self._name} does not fall silent: nothing was sent"
                raise BadReply(message)
            await asyncio.sleep(left)
        self.discard()

    def send(self, request: Q, octets: bytes) -> asyncio.Future[bytes]:
        """Put a request on the line, see :meth:`Line.send`."""
        if self.closed.is_set():
            message = f"{self._name} is not there any more"
            raise LinkLost(message)
        try:
            written = os.write(self._descriptor, octets)
        except OSError as error:
            self.close(f"it cannot be written to: {error.strerror}")
            message = f"{self._name} cannot be written to: {error.strerror}"
            raise LinkLost(message) from error
        if written < len(octets):
            # The rest would reach the device as a frame of its own.
            self.close("it takes no more octets")
            message = f"{self._name} took {written} of {len(octets)} octets"
            raise LinkLost(message)
        reply = self.expect(request)
        # A broadcast has its empty reply already.
        self.hear(b"")
        return reply

    def spoil(self) -> None:
        """Keep silent from now on, until the line is drained."""
        self.spoiled = True
        self._heard = self._now()
        self.forget()

    def overhear(self) -> None:
        """Noise, or a reply too late: nobody will want it."""
        self.discard()

    async def drain(self) -> None:
        """Return once no late reply can come any more, or the line is closed.

        A line that is never quiet is closed: too fast a speed, or another master.
        """
        # A reply that was given up may be on its way for as long again.
        limit = self._now() + LONGEST_DRAIN * self._timeout
        while not self.closed.is_set():
            left = self._heard + self._timeout - self._now()
            if left <= 0:
                self.spoiled = False
                break
            if self._now() > limit:
                self.close("it never falls quiet; is another master on the line?")
                break
            with suppress(TimeoutError):
                async with asyncio.timeout(min(left, limit - self._now())):
                    await self.closed.wait()
        self.discard()

    def close(self, why: str = "the bus was closed") -> None:
        """Close now; octets that are not out yet are dropped."""
        if self.closed.is_set():
            return
        self._loop.remove_reader(self._descriptor)
        # Else closing waits until a port that takes nothing has sent them.
        with suppress(OSError, termios.error):
            self._port.reset_output_buffer()
        with suppress(OSError):
            self._port.close()
        self.lost(why)

    def _read(self) -> None:
        if self.closed.is_set():
            return
        try:
            octets = os.read(self._descriptor, MOST_READ)
        except BlockingIOError:
            return
        except OSError as error:
            self.close(f"it is gone: {error.strerror}")
            return
        if not octets:
            self.close("it is gone: the adapter was unplugged")
            return
        self._heard = self._now()
        self.hear(octets)
