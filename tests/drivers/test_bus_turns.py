import asyncio

import pytest

from gripperd.drivers.turns import Turns

from .peer import (
    SOON,
    connected,
    echo,
    silence,
    value_of,
    write,
)


async def test_a_request_cancelled_in_the_queue_is_never_sent() -> None:
    async with connected(silence) as (bus, peer):
        first = asyncio.create_task(bus.ask(write(1)))
        await peer.asked(1)
        second = asyncio.create_task(bus.ask(write(2)))
        third = asyncio.create_task(bus.ask(write(3)))
        await asyncio.sleep(0)
        second.cancel()
        with pytest.raises(asyncio.CancelledError):
            await second
        peer.behave = echo
        echo(peer.lines[0], peer.requests[0])
        assert await first == (1,)
        assert await third == (3,)
        assert [value_of(frame) for frame in peer.requests] == [1, 3]
        assert len(peer.lines) == 1


async def test_one_request_at_a_time_is_on_the_line() -> None:
    async with connected(silence) as (bus, peer):
        asking = [asyncio.create_task(bus.ask(write(value))) for value in range(3)]
        for count in range(3):
            await peer.asked(count + 1)
            assert len(peer.requests) == count + 1
            echo(peer.lines[0], peer.requests[count])
            assert await asking[count] == (count,)


async def test_an_urgent_request_passes_fifty_that_wait() -> None:
    async with connected(silence) as (bus, peer):
        first = asyncio.create_task(bus.ask(write(0)))
        await peer.asked(1)
        patient = [asyncio.create_task(bus.ask(write(value))) for value in range(1, 51)]
        await asyncio.sleep(0)
        urgent = [
            asyncio.create_task(bus.ask(write(value), urgent=True))
            for value in (901, 902)
        ]
        await asyncio.sleep(0)
        peer.behave = echo
        echo(peer.lines[0], peer.requests[0])
        await asyncio.gather(first, *patient, *urgent)
        values = [value_of(frame) for frame in peer.requests]
        assert values == [0, 901, 902, *range(1, 51)]


@pytest.mark.parametrize("given", ["before", "after"])
async def test_the_turn_of_one_who_is_leaving_goes_to_the_next(given: str) -> None:
    turns = Turns()
    assert turns.take()
    leaving = asyncio.create_task(turns.wait(urgent=False))
    staying = asyncio.create_task(turns.wait(urgent=False))
    await asyncio.sleep(0)
    if given == "before":
        turns.give()
    leaving.cancel()
    if given == "after":
        turns.give()
    with pytest.raises(asyncio.CancelledError):
        await leaving
    async with asyncio.timeout(SOON):
        await staying
