"""More requests at once than are answered."""

import asyncio
import json
from dataclasses import dataclass, field

import pytest
from starlette.types import Message, Receive, Scope, Send

from gripperd.service.crowd import Crowd

pytestmark = pytest.mark.anyio


@dataclass
class Slow:
    """Answers nobody until it may."""

    may: asyncio.Event = field(default_factory=asyncio.Event)
    asked: list[str] = field(default_factory=list)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        self.asked.append(scope["path"])
        await self.may.wait()


async def _nothing() -> Message:
    return {"type": "http.disconnect"}


async def ask(crowd: Crowd, method: str, path: str) -> list[Message]:
    sent: list[Message] = []

    async def send(message: Message) -> None:
        sent.append(message)

    scope = {"type": "http", "method": method, "path": path, "headers": []}
    await crowd(scope, _nothing, send)
    return sent


async def test_one_too_many_is_told_so_and_a_stop_is_not_one() -> None:
    slow = Slow()
    crowd = Crowd(slow, most=2)
    async with asyncio.TaskGroup() as tasks:
        for number in range(2):
            tasks.create_task(ask(crowd, "GET", f"/{number}"))
        await asyncio.sleep(0)
        start, body = await ask(crowd, "GET", "/third")
        assert start["status"] == 503
        assert json.loads(body["body"])["code"] == "overloaded"
        assert (b"connection", b"close") in start["headers"]
        tasks.create_task(ask(crowd, "POST", "/v1/grippers/g0/stop"))
        await asyncio.sleep(0)
        slow.may.set()
    assert slow.asked == ["/0", "/1", "/v1/grippers/g0/stop"]


async def test_who_was_answered_makes_room() -> None:
    slow = Slow()
    slow.may.set()
    crowd = Crowd(slow, most=1)
    assert await ask(crowd, "GET", "/1") == []
    assert await ask(crowd, "GET", "/2") == []
    assert slow.asked == ["/1", "/2"]


async def test_a_request_that_fails_makes_room_too() -> None:
    async def broken(scope: Scope, receive: Receive, send: Send) -> None:
        message = "broken"
        raise ValueError(message)

    crowd = Crowd(broken, most=1)
    for _ in range(2):
        with pytest.raises(ValueError, match="broken"):
            await ask(crowd, "GET", "/1")
