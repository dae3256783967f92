import asyncio
import time

import pytest

from gripperd.control.alarm import Alarm

pytestmark = pytest.mark.anyio


async def test_it_never_rings_before_its_time() -> None:
    with Alarm() as alarm:
        for _ in range(20):
            when = time.monotonic() + 1.3e-3
            await alarm.until(when)
            assert time.monotonic() >= when


async def test_a_time_that_is_past_is_no_wait_for_ever() -> None:
    with Alarm() as alarm:
        await alarm.until(time.monotonic() - 1.0)
        await alarm.until(0.0001)


async def test_others_have_a_turn_while_it_waits() -> None:
    turns: list[str] = []

    async def other() -> None:
        turns.append("other")

    with Alarm() as alarm:
        task = asyncio.create_task(other())
        await alarm.until(time.monotonic() - 1.0)
        turns.append("rung")
        await task
    assert turns == ["other", "rung"]


async def test_it_can_be_set_anew_after_a_cancelled_wait() -> None:
    with Alarm() as alarm:
        with pytest.raises(TimeoutError):
            async with asyncio.timeout(0.01):
                await alarm.until(time.monotonic() + 1000)
        when = time.monotonic() + 0.01
        await alarm.until(when)
        assert when <= time.monotonic() < when + 500
