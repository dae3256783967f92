"""What every line promises, on one that goes nowhere and a clock that stands still."""

import asyncio

import pytest

from gripperd.drivers.line import Line
from gripperd.drivers.statistics import BusStatistics
from gripperd.errors import LinkLost, ReplyTimeout

from .peer import SOON

TIMEOUT = 0.002
"""By the clock of the test; the event loop rings by its own. [s]"""


class Clock:
    """Goes on when it is told to, and counts how often it was looked at."""

    def __init__(self) -> None:
        self.time = 0.0
        self.looks = 0

    def now(self) -> float:
        self.looks += 1
        return self.time

    async def is_looked_at(self) -> None:
        """Return once somebody has looked again, and again."""
        until = self.looks + 2
        async with asyncio.timeout(SOON):
            while self.looks < until:  # noqa: ASYNC110
                await asyncio.sleep(TIMEOUT)


class DeadEnd(Line[str]):
    """A request ends with a full stop, and so does its reply."""

    def __init__(self, clock: Clock) -> None:
        super().__init__("nowhere", TIMEOUT, _sentence, BusStatistics(), clock.now)

    def send(self, request: str, octets: bytes) -> asyncio.Future[bytes]:
        return self.expect(request)

    def spoil(self) -> None:
        self.forget()

    def close(self, why: str = "the bus was closed") -> None:
        self.lost(why)

    def overhear(self) -> None:
        self.discard()


def _sentence(_: str, buffer: bytes) -> int | None:
    return buffer.find(b".") + 1 or None


async def test_a_request_has_its_whole_time_however_long_ago_the_last_one_was() -> None:
    clock = Clock()
    line = DeadEnd(clock)
    first = line.send("first", b"")
    line.hear(b"yes.")
    assert await first == b"yes."
    clock.time = 0.9 * TIMEOUT
    second = line.send("second", b"")
    # When the time of the first would have been over.
    clock.time = 1.1 * TIMEOUT
    await clock.is_looked_at()
    assert not second.done()
    clock.time = 2 * TIMEOUT
    with pytest.raises(ReplyTimeout, match="within 2 ms: second"):
        await asyncio.wait_for(second, SOON)


async def test_a_line_that_was_at_rest_still_minds_the_time() -> None:
    clock = Clock()
    line = DeadEnd(clock)
    for request in ("first", "second"):
        reply = line.send(request, b"")
        clock.time += TIMEOUT
        with pytest.raises(ReplyTimeout, match=request):
            await asyncio.wait_for(reply, SOON)


async def test_a_stall_of_ours_is_no_silence_of_the_peer() -> None:
    clock = Clock()
    line = DeadEnd(clock)
    reply = line.send("first", b"")
    clock.time = 10 * TIMEOUT
    await clock.is_looked_at()
    line.hear(b"yes.")
    assert await reply == b"yes."


async def test_a_stall_excuses_a_peer_once() -> None:
    clock = Clock()
    line = DeadEnd(clock)
    reply = line.send("first", b"")
    clock.time = 10 * TIMEOUT
    await clock.is_looked_at()
    assert not reply.done()
    clock.time = 20 * TIMEOUT
    with pytest.raises(ReplyTimeout, match="first"):
        await asyncio.wait_for(reply, SOON)
    second = line.send("second", b"")
    clock.time = 30 * TIMEOUT
    await clock.is_looked_at()
    assert not second.done()
    clock.time = 31 * TIMEOUT
    with pytest.raises(ReplyTimeout, match="second"):
        await asyncio.wait_for(second, SOON)


async def test_a_request_that_was_forgotten_is_not_told_of_its_time() -> None:
    clock = Clock()
    line = DeadEnd(clock)
    forgotten = line.send("first", b"")
    line.forget()
    reply = line.send("second", b"")
    clock.time = TIMEOUT
    with pytest.raises(ReplyTimeout, match="second"):
        await asyncio.wait_for(reply, SOON)
    assert not forgotten.done()


async def test_what_is_behind_a_reply_is_kept_as_evidence() -> None:
    line = DeadEnd(Clock())
    reply = line.send("first", b"")
    line.hear(b"ye")
    line.hear(b"s.and more")
    assert await reply == b"yes."
    assert line.received == b"and more"


async def test_who_was_cancelled_a_moment_ago_gets_no_reply_and_no_error() -> None:
    line = DeadEnd(Clock())
    answered = line.send("first", b"")
    answered.cancel()
    line.hear(b"yes.")
    cut_off = line.send("second", b"")
    cut_off.cancel()
    line.close()
    assert answered.cancelled()
    assert cut_off.cancelled()


async def test_a_closed_line_says_why() -> None:
    line = DeadEnd(Clock())
    reply = line.send("first", b"")
    line.close("the plug was pulled")
    with pytest.raises(LinkLost, match="nowhere: the plug was pulled"):
        await reply
