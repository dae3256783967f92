"""Sharing answers."""

import asyncio

import pytest

from gripperd.errors import LinkLost
from gripperd.service.shared import Shared

pytestmark = pytest.mark.anyio


class Source:
    """Counts how often it is asked, on a clock of its own."""

    def __init__(self) -> None:
        self.asked: list[str] = []
        self.time = 0.0
        self.open = asyncio.Event()
        self.open.set()

    async def ask(self, name: str) -> int:
        self.asked.append(name)
        await self.open.wait()
        return len(self.asked)

    def now(self) -> float:
        return self.time


async def test_who_asks_within_a_moment_shares() -> None:
    source = Source()
    shared = Shared(source.ask, 0.005, source.now)
    assert [await shared.get("a") for _ in range(3)] == [1, 1, 1]
    source.time = 0.005
    assert await shared.get("a") == 2


async def test_who_asks_meanwhile_shares() -> None:
    source = Source()
    source.open.clear()
    shared = Shared(source.ask, 0.005, source.now)
    waiting = [asyncio.create_task(shared.get("a")) for _ in range(5)]
    await asyncio.sleep(0)
    source.open.set()
    assert await asyncio.gather(*waiting) == [1] * 5


async def test_names_are_apart() -> None:
    source = Source()
    shared = Shared(source.ask, 0.005, source.now)
    assert (await shared.get("a"), await shared.get("b")) == (1, 2)


async def test_what_was_forgotten_is_asked_anew_even_in_flight() -> None:
    source = Source()
    source.open.clear()
    shared = Shared(source.ask, 0.005, source.now)
    early = asyncio.create_task(shared.get("a"))
    await asyncio.sleep(0)
    shared.forget("a")
    late = asyncio.create_task(shared.get("a"))
    await asyncio.sleep(0)
    source.open.set()
    await early
    await late
    assert source.asked == ["a", "a"]


async def test_one_who_goes_away_takes_nothing_from_the_others() -> None:
    source = Source()
    source.open.clear()
    shared = Shared(source.ask, 0.005, source.now)
    first, second = (asyncio.create_task(shared.get("a")) for _ in range(2))
    await asyncio.sleep(0)
    first.cancel()
    await asyncio.sleep(0)
    source.open.set()
    assert await second == 1


async def test_an_error_reaches_all_and_does_not_stay() -> None:
    times = 0

    async def fail(name: str) -> int:
        nonlocal times
        times += 1
        raise LinkLost(name)

    now = [0.0]
    shared = Shared(fail, 0.005, lambda: now[0])
    for moment in (0.0, 0.001, 0.01):
        now[0] = moment
        with pytest.raises(LinkLost):
            await shared.get("a")
    assert times == 2
