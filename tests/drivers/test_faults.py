"""Everything that goes wrong on a line, on either kind of line."""

import asyncio
import re
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path

import pytest

from gripperd.drivers.bus import Exchange, ModbusBus, TcpAddress
from gripperd.errors import BadReply, DeviceRefused, LinkError, LinkLost, ReplyTimeout
from gripperd.protocol.modbus import Read, Table, Write

from .far_end import (
    PATIENCE,
    Asked,
    Behaviour,
    FarEnd,
    dead,
    honest,
    once,
    over_rtu,
    over_tcp,
    read,
    write,
)
from .peer import SOON, up


@pytest.fixture(params=["tcp", "rtu"])
async def line(
    request: pytest.FixtureRequest, tmp_path: Path
) -> AsyncIterator[tuple[ModbusBus, FarEnd]]:
    """A bus that has just read something, and its far end."""
    async with opened(request.param, tmp_path) as (bus, far):
        assert await bus.ask(read(7)) == (1007,)
        far.asked.clear()
        yield bus, far


@asynccontextmanager
async def opened(kind: str, folder: Path) -> AsyncIterator[tuple[ModbusBus, FarEnd]]:
    if kind == "tcp":
        async with over_tcp(PATIENCE) as (bus, tcp):
            yield bus, tcp
        return
    async with over_rtu(folder / "adapter") as (bus, rtu):
        yield bus, rtu


async def sound_again(bus: ModbusBus) -> None:
    """The line answers the right question, whatever went wrong on it."""
    await up(bus)
    assert await bus.ask(read(200, 2)) == (1200, 1201)
    assert await bus.ask(write(10_700)) == (10_700,)


async def has_no_reply(bus: ModbusBus, far: FarEnd, request: Read | Write) -> None:
    far.behave = once(dead)
    with pytest.raises(ReplyTimeout, match=f"100 ms: {re.escape(str(request))}"):
        await bus.ask(request)


async def test_a_late_read_does_not_answer_the_next_read(
    line: tuple[ModbusBus, FarEnd],
) -> None:
    bus, far = line
    await has_no_reply(bus, far, read(0))
    honest(far, far.asked[0])
    await up(bus)
    assert await bus.ask(read(100)) == (1100,)


async def test_a_late_echo_does_not_answer_a_read(
    line: tuple[ModbusBus, FarEnd],
) -> None:
    bus, far = line
    await has_no_reply(bus, far, write(10_700))
    honest(far, far.asked[0])
    await up(bus)
    assert await bus.ask(Read(1, Table.INPUT, 100)) == (1100,)


async def test_an_echo_later_than_any_silence_does_not_answer_a_read(
    line: tuple[ModbusBus, FarEnd],
) -> None:
    bus, far = line
    await has_no_reply(bus, far, write(10_700))
    await up(bus)
    far.behave = once(lambda far, _: honest(far, far.asked[0]))
    with pytest.raises(BadReply):
        await bus.ask(Read(1, Table.INPUT, 100))
    await sound_again(bus)


async def test_a_cancelled_request_answers_nobody(
    line: tuple[ModbusBus, FarEnd],
) -> None:
    bus, far = line
    far.behave = once(dead)
    asking = asyncio.create_task(bus.ask(read(0)))
    await far.has(1)
    asking.cancel()
    with pytest.raises(asyncio.CancelledError):
        await asking
    honest(far, far.asked[0])
    await up(bus)
    assert await bus.ask(read(100)) == (1100,)
    assert bus.statistics.errors == {"CancelledError": 1}


def other_value(far: FarEnd, asked: Asked) -> None:
    far.reply(asked, asked.pdu[:-1] + bytes([asked.pdu[-1] ^ 1]))


def one_of_four(far: FarEnd, asked: Asked) -> None:
    far.reply(asked, bytes([3, 2, 0, 1]))


def one_that_claims_four(far: FarEnd, asked: Asked) -> None:
    far.reply(asked, bytes([3, 8, 0, 1]))


def other_unit(far: FarEnd, asked: Asked) -> None:
    far.reply(asked, bytes([3, 8, *range(8)]), unit=2)


def other_function(far: FarEnd, asked: Asked) -> None:
    far.reply(asked, bytes([4, 8, *range(8)]))


def after_noise(far: FarEnd, asked: Asked) -> None:
    far.put(b"\x00\xff")
    honest(far, asked)


def cut_off(far: FarEnd, asked: Asked) -> None:
    far.put(far.framed(asked, bytes([3, 8, *range(8)]), asked.unit)[:-3])


def exception_of_another_function(far: FarEnd, asked: Asked) -> None:
    far.reply(asked, bytes([0x84, 2]))


MISFITS = [
    pytest.param(write(5000), other_value, BadReply, id="wrong echo"),
    pytest.param(read(0, 4), one_of_four, BadReply, id="short read"),
    pytest.param(read(0, 4), one_that_claims_four, LinkError, id="wrong byte count"),
    pytest.param(read(0, 4), other_unit, BadReply, id="wrong unit"),
    pytest.param(read(0, 4), other_function, BadReply, id="wrong function"),
    pytest.param(read(0, 4), after_noise, LinkError, id="noise before the frame"),
    pytest.param(read(0, 4), cut_off, ReplyTimeout, id="end of the frame lost"),
    pytest.param(read(0, 4), dead, ReplyTimeout, id="no reply"),
    pytest.param(
        read(0, 4), exception_of_another_function, BadReply, id="wrong exception"
    ),
]


@pytest.mark.parametrize(("request_", "misbehave", "error"), MISFITS)
async def test_a_misfit_is_not_believed_and_nothing_is_asked_twice(
    line: tuple[ModbusBus, FarEnd],
    request_: Read,
    misbehave: Behaviour,
    error: type[LinkError],
) -> None:
    bus, far = line
    far.behave = once(misbehave)
    with pytest.raises(error):
        await bus.ask(request_)
    await sound_again(bus)
    assert [asked.pdu[0] for asked in far.asked] == [far.asked[0].pdu[0], 3, 6]
    assert bus.statistics.errors.total() == 1


@pytest.mark.parametrize("code", [1, 2, 3, 4, 6, 77])
async def test_an_exception_is_told_from_a_fault_of_the_line(
    line: tuple[ModbusBus, FarEnd], code: int
) -> None:
    bus, far = line
    far.behave = once(
        lambda far, asked: far.reply(asked, bytes([asked.pdu[0] | 0x80, code]))
    )
    with pytest.raises(DeviceRefused) as refused:
        await bus.ask(write(65_535))
    assert refused.value.exception_code == code
    assert bus.up.is_set()
    await sound_again(bus)
    assert bus.statistics.connections == 1


async def test_a_dead_device_gets_each_queued_write_at_most_once(
    line: tuple[ModbusBus, FarEnd],
) -> None:
    bus, far = line
    far.behave = dead
    asking = [asyncio.create_task(bus.ask(write(value))) for value in (1, 2, 3)]
    async with asyncio.timeout(SOON):
        outcomes = await asyncio.gather(*asking, return_exceptions=True)
    assert all(isinstance(outcome, LinkError) for outcome in outcomes)
    values = [asked.value for asked in far.asked]
    if isinstance(bus.address, TcpAddress):
        # The others found no connection, and were told so at once.
        assert values == [1]
        assert [type(outcome) for outcome in outcomes[1:]] == [LinkLost] * 2
    else:
        assert values == [1, 2, 3]
        assert [type(outcome) for outcome in outcomes] == [ReplyTimeout] * 3


async def test_an_urgent_write_passes_fifty_reads_that_wait(
    line: tuple[ModbusBus, FarEnd],
) -> None:
    bus, far = line
    far.behave = once(dead)
    first = asyncio.create_task(bus.ask(read(0)))
    await far.has(1)
    patient = [asyncio.create_task(bus.ask(read(place))) for place in range(1, 51)]
    await asyncio.sleep(0)
    urgent = asyncio.create_task(bus.ask(write(4000), urgent=True))
    await asyncio.sleep(0)
    honest(far, far.asked[0])
    assert await urgent == (4000,)
    assert await first == (1000,)
    assert await asyncio.gather(*patient) == [(1000 + p,) for p in range(1, 51)]
    assert [asked.pdu[0] for asked in far.asked[:3]] == [3, 6, 3]


async def test_every_exchange_can_be_traced(
    line: tuple[ModbusBus, FarEnd],
) -> None:
    bus, far = line
    seen: list[Exchange] = []
    bus.trace = seen.append
    await bus.ask(read(100))
    far.behave = once(cut_off)
    with pytest.raises(ReplyTimeout):
        await bus.ask(read(0, 4))
    assert [exchange.request for exchange in seen] == [a.frame for a in far.asked]
    assert [exchange.error for exchange in seen] == [None, "ReplyTimeout"]
    assert seen[0].reply == far.framed(far.asked[0], b"\x03\x02\x04\x4c", 1)
    piece = far.framed(far.asked[1], bytes([3, 8, *range(8)]), 1)[:-3]
    assert seen[1].reply == piece
    assert 0 < seen[0].time < seen[1].time


async def test_statistics_count_what_was_believed_and_what_was_not(
    line: tuple[ModbusBus, FarEnd],
) -> None:
    bus, far = line
    far.behave = once(other_value)
    with pytest.raises(BadReply):
        await bus.ask(write(5000))
    await sound_again(bus)
    found = bus.statistics.snapshot()
    assert found.requests == 4
    assert found.errors == {"BadReply": 1}
    assert sum(found.latency_counts) == 3
    assert found.latency_total > 0
