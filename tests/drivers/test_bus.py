import asyncio
from collections.abc import Awaitable, Callable

import pytest

from gripperd.drivers.bus import TcpAddress, open_bus
from gripperd.drivers.statistics import BusStatistics
from gripperd.drivers.tcp import TcpConnector
from gripperd.errors import (
    BadReply,
    DeviceRefused,
    LinkError,
    LinkLost,
    ReplyTimeout,
)
from gripperd.protocol.mbap import ModbusTcp
from gripperd.protocol.modbus import Read, Table

from .peer import (
    SOON,
    Behaviour,
    Line,
    closed,
    connected,
    echo,
    listening,
    once,
    silence,
    up,
    value_of,
    write,
)
from .steady import steady

Eventually = Callable[[Callable[[], bool]], Awaitable[None]]
SHORT = 0.05
"""Reply time-out where the peer stays silent on purpose. [s]"""


def replying(change: Callable[[bytes], bytes]) -> Behaviour:
    return lambda line, frame: line.send(change(frame))


def half(line: Line, frame: bytes) -> None:
    line.send(frame[:7])


def half_and_gone(line: Line, frame: bytes) -> None:
    line.send(frame[:7])
    line.hang_up()


def gone(line: Line, frame: bytes) -> None:
    line.hang_up()


LIES = [
    pytest.param(silence, ReplyTimeout, id="silence"),
    pytest.param(half, ReplyTimeout, id="half a frame"),
    pytest.param(gone, LinkLost, id="hanging up"),
    pytest.param(half_and_gone, LinkLost, id="hanging up half way"),
    pytest.param(replying(lambda _: b"\xff" * 12), BadReply, id="garbage"),
    pytest.param(
        replying(lambda frame: b"\xab\xcd" + frame[2:]), BadReply, id="transaction"
    ),
    pytest.param(
        replying(lambda frame: frame[:6] + b"\x02" + frame[7:]), BadReply, id="unit"
    ),
    pytest.param(replying(lambda frame: frame[:-2] + b"\0\0"), BadReply, id="value"),
]


@pytest.mark.parametrize(("lie", "error"), LIES)
async def test_a_lie_is_not_believed_and_the_line_is_reopened(
    lie: Behaviour, error: type[LinkError]
) -> None:
    timeout = SHORT if error is ReplyTimeout else SOON
    async with connected(once(lie), timeout) as (bus, peer):
        with pytest.raises(error):
            await bus.ask(write(10_700))
        assert not bus.up.is_set()
        await closed(peer.lines[0])
        await up(bus)
        assert await bus.ask(write(5000)) == (5000,)
        assert len(peer.lines) == 2
        assert bus.statistics.errors == {error.__name__: 1}


@pytest.mark.parametrize(("lie", "error"), LIES)
async def test_a_command_is_sent_exactly_once(
    lie: Behaviour, error: type[LinkError]
) -> None:
    timeout = SHORT if error is ReplyTimeout else SOON
    async with connected(once(lie), timeout) as (bus, peer):
        with pytest.raises(error):
            await bus.ask(write(10_700))
        await up(bus)
        await bus.ask(write(5000))
        assert [value_of(frame) for frame in peer.requests] == [10_700, 5000]


async def test_a_reply_in_single_octets_is_put_together() -> None:
    async def spell(line: Line, frame: bytes) -> None:
        for octet in frame:
            line.send(bytes([octet]))
            await asyncio.sleep(0.001)

    spelling: list[asyncio.Task[None]] = []
    async with connected(
        lambda line, frame: spelling.append(asyncio.create_task(spell(line, frame)))
    ) as (bus, peer):
        assert await bus.ask(write(10_700)) == (10_700,)
        assert await bus.ask(write(5000)) == (5000,)
        assert len(peer.lines) == 1


async def test_registers_are_read() -> None:
    reply = bytes.fromhex("00 01 00 00 00 07 02 04 04 29 cc 0f a0")
    async with connected(lambda line, _: line.send(reply)) as (bus, peer):
        assert await bus.ask(Read(2, Table.INPUT, 0, 2)) == (10_700, 4000)
        assert peer.requests == [bytes.fromhex("00 01 00 00 00 06 02 04 00 00 00 02")]


async def test_a_reply_in_advance_does_not_answer_the_next_request() -> None:
    def hasty(line: Line, frame: bytes) -> None:
        coming = ModbusTcp().encode(write(9999), 2)
        line.send(frame + coming)

    async with connected(once(hasty)) as (bus, peer):
        assert await bus.ask(write(10_700)) == (10_700,)
        with pytest.raises(BadReply, match="octets nobody asked for"):
            await bus.ask(write(9999))
        await up(bus)
        assert await bus.ask(write(5000)) == (5000,)
        # The refused request never went out: nobody knows what line it would meet.
        assert [value_of(frame) for frame in peer.requests] == [10_700, 5000]


async def test_octets_nobody_asked_for_close_the_line(
    eventually: Eventually,
) -> None:
    async with connected(echo) as (bus, peer):
        peer.lines[0].send(b"hello")
        wire = bus._line
        assert wire is not None
        await eventually(lambda: bool(wire.received))
        with pytest.raises(BadReply, match="68 65 6c 6c 6f"):
            await bus.ask(write(10_700))
        await closed(peer.lines[0])
        assert peer.requests == []


async def test_a_late_reply_never_answers_the_next_request() -> None:
    late: list[tuple[Line, bytes]] = []

    def slow(line: Line, frame: bytes) -> None:
        late.append((line, frame))

    async with connected(once(slow), SHORT) as (bus, peer):
        with pytest.raises(ReplyTimeout, match=r"50 ms: write 10700 to holding"):
            await bus.ask(write(10_700))
        line, frame = late[0]
        line.send(frame)
        await up(bus)
        assert await bus.ask(write(5000)) == (5000,)
        await closed(line)
        assert bus.statistics.connections == len(peer.lines) == 2


async def test_a_late_reply_on_the_same_line_is_another_transaction() -> None:
    def mixed_up(line: Line, frame: bytes) -> None:
        if value_of(frame) == 2:
            line.send(peer.requests[0])
        else:
            line.send(frame)

    async with connected(mixed_up) as (bus, peer):
        await bus.ask(write(1))
        with pytest.raises(BadReply, match="another transaction"):
            await bus.ask(write(2))


async def test_a_cancelled_request_closes_the_line() -> None:
    async with connected(once(silence)) as (bus, peer):
        asking = asyncio.create_task(bus.ask(write(10_700)))
        await peer.asked(1)
        asking.cancel()
        with pytest.raises(asyncio.CancelledError):
            await asking
        await closed(peer.lines[0])
        await up(bus)
        assert await bus.ask(write(5000)) == (5000,)
        assert bus.statistics.errors == {"CancelledError": 1}


async def test_a_refusal_of_the_device_leaves_the_line_alone() -> None:
    def refuse(line: Line, frame: bytes) -> None:
        line.send(frame[:4] + b"\0\3\1\x86\3")

    async with connected(once(refuse)) as (bus, peer):
        with pytest.raises(DeviceRefused, match="illegal value"):
            await bus.ask(write(65_535))
        assert await bus.ask(write(5000)) == (5000,)
        assert len(peer.lines) == 1
        assert bus.statistics.errors == {"DeviceRefused": 1}
        assert bus.statistics.requests == 2


async def test_without_a_connection_a_request_fails_at_once() -> None:
    async with listening(echo) as peer:
        port = peer.port
    address = TcpAddress(host="127.0.0.1", port=port)
    async with open_bus(address) as bus:
        with pytest.raises(LinkLost, match=f"no connection to 127.0.0.1:{port}"):
            await bus.ask(write(10_700))
        assert bus.statistics.requests == 0


async def test_it_connects_when_the_peer_comes_and_again_when_it_comes_back(
    eventually: Eventually,
) -> None:
    async with listening(echo) as peer:
        port = peer.port
    address = TcpAddress(host="127.0.0.1", port=port)
    async with open_bus(address) as bus:
        steady(bus)
        for life in (1, 2):
            async with listening(echo, port) as peer:
                await up(bus)
                assert await bus.ask(write(life)) == (life,)
            await eventually(lambda: not bus.up.is_set())
            with pytest.raises(LinkLost):
                await bus.ask(write(99))
        assert bus.statistics.connections == 2


async def test_failed_attempts_to_connect_are_counted(
    eventually: Eventually,
) -> None:
    async with listening(echo) as peer:
        port = peer.port
    async with open_bus(TcpAddress(host="127.0.0.1", port=port)) as bus:
        await eventually(lambda: bus.statistics.errors["connect"] > 0)
        assert bus.statistics.connections == 0


async def test_a_request_in_flight_ends_when_the_bus_is_closed() -> None:
    async with connected(silence) as (bus, peer):
        asking = asyncio.create_task(bus.ask(write(10_700)))
        await peer.asked(1)
        bus.close()
        with pytest.raises(LinkLost):
            await asking


async def test_transactions_wrap_around_without_zero() -> None:
    async with connected(echo) as (bus, peer):
        bus._sequence = 0xFFFE
        for _ in range(3):
            await bus.ask(write(1))
        numbers = [int.from_bytes(frame[:2], "big") for frame in peer.requests]
        assert numbers == [0xFFFF, 1, 2]


async def test_a_wire_that_was_just_lost_says_so() -> None:
    # A request may get its turn between the loss and the supervisor's next step.
    async with listening(echo) as peer:
        address = TcpAddress(host="127.0.0.1", port=peer.port)
        cut = ModbusTcp().frame_length
        line = await TcpConnector(address, cut, BusStatistics()).open()
        await peer.called(1)
        peer.lines[0].hang_up()
        async with asyncio.timeout(SOON):
            await line.closed.wait()
        with pytest.raises(LinkLost):
            await line.send(write(1), b"")
