"""What only a serial line does: silence, draining, echoes."""

import asyncio
import time
from collections.abc import Awaitable, Callable
from contextlib import suppress
from pathlib import Path

import pytest

from gripperd.drivers.bus import (
    DconAddress,
    ItvAddress,
    RtuAddress,
    open_bus,
)
from gripperd.errors import BadReply, LinkError, LinkLost, LocalEcho, ReplyTimeout
from gripperd.protocol.dcon import HOST_OK, Ask, Good
from gripperd.protocol.itv import Query, Set

from .far_end import (
    PATIENCE,
    Asked,
    FarEnd,
    RtuFarEnd,
    dead,
    honest,
    once,
    over_rtu,
    plugged,
    read,
    sealed,
    write,
)
from .peer import SOON, up
from .steady import steady

Eventually = Callable[[Callable[[], bool]], Awaitable[None]]

PATIENT = 2.0
"""Time-out while a line is opened, by a clock that a stall moves on. [s]"""


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "adapter"


async def test_octets_are_those_of_modbus_rtu(path: Path) -> None:
    async with over_rtu(path) as (bus, far):
        await bus.ask(read(0))
        assert far.heard == bytes.fromhex("01 03 00 00 00 01 84 0a")


async def test_a_late_reply_is_awaited_in_silence(path: Path) -> None:
    async with over_rtu(path) as (bus, far):
        far.behave = once(dead)
        with pytest.raises(ReplyTimeout):
            await bus.ask(read(0))
        asking = asyncio.create_task(bus.ask(read(100)))
        await asyncio.sleep(PATIENCE / 2)
        late = time.monotonic()
        honest(far, far.asked[0])
        assert await asking == (1100,)
        assert far.asked[1].at - late >= PATIENCE
        assert bus.statistics.discarded == 7
        assert bus.statistics.connections == 1


async def test_what_waits_for_a_drained_line_goes_by_urgency(path: Path) -> None:
    async with over_rtu(path) as (bus, far):
        await bus.ask(read(7))
        far.behave = once(dead)
        with pytest.raises(ReplyTimeout):
            await bus.ask(read(0))
        patient = asyncio.create_task(bus.ask(read(1)))
        await asyncio.sleep(0)
        await bus.ask(write(4000), urgent=True)
        await patient
        assert [asked.pdu[0] for asked in far.asked] == [3, 3, 6, 3]


async def test_a_request_waits_for_three_and_a_half_characters_of_silence(
    path: Path,
) -> None:
    async with over_rtu(path) as (bus, far):
        await bus.ask(read(0))
        answered = time.monotonic()
        await bus.ask(read(0))
        # 38.5 bits at 9600 Bd; the far end stamps a request before it answers.
        assert far.asked[1].at - far.asked[0].at >= 38.5 / 9600
        assert time.monotonic() - answered < SOON


async def test_a_silence_longer_than_a_time_out_is_waited_for_by_an_early_timer(
    path: Path,
) -> None:
    async with over_rtu(path, silence=2 * PATIENCE) as (bus, far):
        await bus.ask(read(0))
        line = bus._line
        assert line is not None
        clock, start = line._now, line._now()
        # The clock is slow, so that every timer rings early by it.
        line._now = lambda: start + 0.6 * (clock() - start)
        assert await bus.ask(read(0)) == (1000,)
        assert far.asked[1].at - far.asked[0].at >= 2 * PATIENCE


async def test_a_request_that_waits_for_silence_ends_when_the_adapter_is_unplugged(
    path: Path,
) -> None:
    async with over_rtu(path, silence=0.2) as (bus, far):
        await bus.ask(read(0))
        asking = asyncio.create_task(bus.ask(read(0)))
        await asyncio.sleep(0)
        far.unplug()
        with pytest.raises(LinkLost):
            await asyncio.wait_for(asking, SOON)
        assert len(far.asked) == 1


async def test_noise_between_requests_is_counted_and_forgotten(
    path: Path, eventually: Eventually
) -> None:
    async with over_rtu(path) as (bus, far):
        far.put(sealed(b"\x01\x03\x02\x0b\xad"))
        await eventually(lambda: bus.statistics.discarded == 7)
        assert await bus.ask(read(0)) == (1000,)


async def test_octets_the_kernel_still_keeps_answer_nothing(path: Path) -> None:
    async with over_rtu(path, silence=0.0) as (bus, far):
        await bus.ask(read(0))
        far.put(sealed(b"\x01\x03\x02\x0b\xad"))
        # No step of the loop in between: nobody has seen them yet.
        while far.unread < 7:
            time.sleep(0.001)  # noqa: ASYNC251
        assert await bus.ask(read(100)) == (1100,)
        assert bus.statistics.discarded == 7


async def test_a_port_is_listened_to_before_it_is_used(path: Path) -> None:
    async with (
        plugged(path) as far,
        open_bus(RtuAddress(port=str(path), timeout=PATIENT)) as bus,
    ):
        late = 0.0
        # What comes before the port is open, opening it throws away.
        while not bus.statistics.discarded:
            # The answer to somebody who had the port before.
            late = time.monotonic()
            far.put(sealed(b"\x01\x03\x02\x0b\xad"))
            await asyncio.sleep(PATIENT / 200)
        assert not bus.up.is_set()
        await up(bus)
        assert time.monotonic() - late >= PATIENT
        assert bus.statistics.discarded % 7 == 0
        assert await bus.ask(read(0)) == (1000,)


async def babble(far: RtuFarEnd) -> None:
    while True:
        # Nobody has taken off the line what is there already.
        with suppress(BlockingIOError):
            far.put(b"U")
        await asyncio.sleep(PATIENCE / 200)


async def test_a_line_that_never_falls_silent_is_not_written_to(
    path: Path, eventually: Eventually
) -> None:
    # The silence asked for is one that no stall of this machine brings about.
    async with over_rtu(path, silence=0.8 * PATIENCE) as (bus, far):
        babbling = asyncio.create_task(babble(far))
        await eventually(lambda: bus.statistics.discarded > 0)
        with pytest.raises(BadReply, match="does not fall silent"):
            await bus.ask(read(0))
        assert far.asked == []
        await eventually(lambda: not bus.up.is_set())
        with pytest.raises(LinkLost, match="another master"):
            await bus.ask(read(0))
        babbling.cancel()
        await up(bus)
        assert await bus.ask(read(0)) == (1000,)


async def test_a_write_waits_until_something_was_read(path: Path) -> None:
    async with over_rtu(path) as (bus, far):
        with pytest.raises(LinkLost, match=r"echo of 'write 4000 .*; read first"):
            await bus.ask(write(4000))
        assert far.heard == b""
        await bus.ask(read(0))
        assert await bus.ask(write(4000)) == (4000,)


def echoing(far: FarEnd, asked: Asked) -> None:
    """A converter that hears itself, and nobody behind it."""
    far.put(asked.frame)


def echoing_device(far: FarEnd, asked: Asked) -> None:
    far.put(asked.frame)
    honest(far, asked)


async def test_the_own_echo_is_no_reply(path: Path) -> None:
    async with over_rtu(path) as (bus, far):
        far.behave = echoing
        with pytest.raises(LocalEcho, match="local_echo: true"):
            await bus.ask(read(0, 4))
        with pytest.raises(LinkError):
            await bus.ask(write(4000))
        assert [asked.pdu[0] for asked in far.asked] == [3]


async def test_an_echo_that_is_expected_is_taken_off(path: Path) -> None:
    async with over_rtu(path, local_echo=True) as (bus, far):
        far.behave = echoing_device
        assert await bus.ask(write(4000)) == (4000,)
        assert await bus.ask(read(0, 2)) == (1000, 1001)
        assert bus.statistics.discarded == 0
        far.behave = echoing
        for request in (write(4000), read(0)):
            with pytest.raises(ReplyTimeout):
                await bus.ask(request)


async def test_closing_a_bus_ends_what_waits_for_a_drained_line(path: Path) -> None:
    async with plugged(path) as far:
        far.behave = dead
        async with open_bus(RtuAddress(port=str(path), timeout=PATIENCE)) as bus:
            await up(bus)
            with pytest.raises(ReplyTimeout):
                await bus.ask(read(0))
            asking = asyncio.create_task(bus.ask(read(1)))
            await asyncio.sleep(0)
        async with asyncio.timeout(SOON):
            with pytest.raises(LinkLost):
                await asking


async def test_ascii_modules_are_asked_on_their_line(path: Path) -> None:
    async with plugged(path) as far:
        far.speak(b"\r", {b"#010+10.700\r": b">\r"})
        address = DconAddress(port=str(path), timeout=PATIENCE)
        async with open_bus(address) as bus:
            steady(bus)
            await up(bus)
            assert await bus.ask(HOST_OK) == ""
            assert await bus.ask(Ask(1, "0+10.700")) == ""
        assert far.heard == b"~**\r#010+10.700\r"


async def test_regulators_are_asked_on_their_line(path: Path) -> None:
    async with plugged(path) as far:
        far.speak(b"\r\n", {b"SET 512\r\n": b"512\r\n", b"MON\r\n": b"511\r\n"})
        async with open_bus(ItvAddress(port=str(path), timeout=PATIENCE)) as bus:
            steady(bus)
            await up(bus)
            assert await bus.ask(Set(512)) == 512
            assert await bus.ask(Query.PRESSURE) == 511


async def test_a_module_that_asks_for_its_address_is_believed_with_it(
    path: Path,
) -> None:
    async with plugged(path) as far:
        far.speak(b"\r", {b"#010+10.700\r": b"!01\r"})
        async with open_bus(DconAddress(port=str(path), timeout=PATIENCE)) as bus:
            steady(bus)
            await up(bus)
            assert await bus.ask(Ask(1, "0+10.700", good=Good.ADDRESS)) == ""
