"""Serial lines of the bench: ports, pace, and streams that are not clean."""

import asyncio
import os
import termios
import time
import tty
from collections.abc import AsyncIterator, Callable, Sequence
from contextlib import asynccontextmanager
from pathlib import Path
from typing import TypeVar

import pytest
import serial
from pymodbus.client import ModbusSerialClient

from gripperd.bench.modbus_speaker import RtuSpeaker
from gripperd.bench.modules import Modules
from gripperd.bench.pace import Pace
from gripperd.bench.rig import Rig
from gripperd.bench.serial_server import serve_serial
from gripperd.bench.server import BenchServer
from gripperd.bench.text_speaker import DconSpeaker
from gripperd.drivers.bus import RtuAddress, open_bus
from gripperd.errors import InputError, Refused
from gripperd.protocol.modbus import Read, Table, Write
from gripperd.protocol.rtu import crc
from tests.interop.programs import needed

from ..drivers.steady import steady  # noqa: TID252
from .line import PATIENT, SOON, fitted

T = TypeVar("T")
OUTPUT_AND_INPUT = ("waveshare_ao_8ch", "waveshare_ai_8ch")


@asynccontextmanager
async def rtu(
    rig: Rig, path: Path, pace: Pace | None = None
) -> AsyncIterator[BenchServer]:
    speaker = RtuSpeaker(Modules(rig, *fitted(*OUTPUT_AND_INPUT)))
    async with serve_serial(speaker, path, pace) as bench:
        yield bench


async def elsewhere(path: Path, talk: Callable[[serial.Serial], T]) -> T:
    """Talk raw octets to a port, in a thread of its own."""

    def conversation() -> T:
        with serial.Serial(str(path), timeout=PATIENT) as port:
            return talk(port)

    return await asyncio.to_thread(conversation)


def sealed(*octets: int) -> bytes:
    frame = bytes(octets)
    return frame + crc(frame).to_bytes(2, "little")


async def test_the_reference_frame_of_the_maker_is_echoed(
    rig: Rig, tmp_path: Path
) -> None:
    # Waveshare prints it: channel 1 to 1 mA.
    frame = bytes.fromhex("01 06 00 00 03 E8 89 74")

    def talk(port: serial.Serial) -> bytes:
        port.write(frame)
        return port.read(8)

    async with rtu(rig, tmp_path / "line"):
        assert await elsewhere(tmp_path / "line", talk) == frame
    assert rig.plant.current == pytest.approx(0.001)


async def test_pymodbus_writes_and_reads(rig: Rig, tmp_path: Path) -> None:
    def conversation() -> tuple[Sequence[int], Sequence[int], int]:
        client = ModbusSerialClient(str(tmp_path / "line"), timeout=PATIENT, retries=0)
        assert client.connect()
        try:
            # Before the jaws move.
            sensed = client.read_input_registers(0, count=3, device_id=2)
            written = client.write_register(0, 10_700, device_id=1)
            several = client.write_registers(1, [1, 2], device_id=1)
            assert not written.isError()
            assert not several.isError()
            read = client.read_holding_registers(0, count=3, device_id=1)
            refused = client.write_register(0, 20_001, device_id=1)
            return read.registers, sensed.registers, refused.exception_code
        finally:
            client.close()  # type: ignore[no-untyped-call]

    async with rtu(rig, tmp_path / "line"):
        read, sensed, code = await asyncio.to_thread(conversation)
    assert read == [10_700, 1, 2]
    assert sensed[1] == pytest.approx(17_600, abs=40)
    assert code == 3


async def test_mbpoll_writes_and_reads(rig: Rig, tmp_path: Path) -> None:
    program = needed("mbpoll")

    async def mbpoll(*more: str) -> str:
        line = ("-m", "rtu", "-b", "9600", "-P", "none", "-a", "1", "-0", "-r", "0")
        process = await asyncio.create_subprocess_exec(
            program,
            *line,
            *("-t", "4", "-1", "-q", str(tmp_path / "line"), *more),
            stdout=asyncio.subprocess.PIPE,
            stderr=asyncio.subprocess.STDOUT,
        )
        output, _ = await process.communicate()
        return output.decode()

    async with rtu(rig, tmp_path / "line"):
        assert "Written 1 references." in await mbpoll("10700")
        assert "[0]: \t10700" in await mbpoll()


async def test_a_broadcast_is_obeyed_and_not_answered(rig: Rig, tmp_path: Path) -> None:
    def talk(port: serial.Serial) -> bytes:
        port.write(sealed(0, 6, 0, 0, 0x29, 0xCC))
        port.write(sealed(9, 3, 0, 0, 0, 1))
        port.write(sealed(1, 3, 0, 0, 0, 1))
        return port.read(7)

    async with rtu(rig, tmp_path / "line"):
        # The first reply is to the read: nobody answered before.
        reply = await elsewhere(tmp_path / "line", talk)
    assert reply == sealed(1, 3, 2, 0x29, 0xCC)


async def test_a_damaged_request_is_neither_obeyed_nor_answered(
    rig: Rig, tmp_path: Path
) -> None:
    def talk(port: serial.Serial) -> bytes:
        good = sealed(1, 6, 0, 0, 0x29, 0xCC)
        port.write(good[:-1] + bytes((good[-1] ^ 1,)))
        port.write(sealed(1, 3, 0, 0, 0, 1))
        return port.read(7)

    async with rtu(rig, tmp_path / "line"):
        reply = await elsewhere(tmp_path / "line", talk)
    assert reply == sealed(1, 3, 2, 0, 0)


async def test_a_piece_of_a_frame_is_forgotten_after_a_silence(
    rig: Rig, tmp_path: Path
) -> None:
    def talk(port: serial.Serial) -> bytes:
        port.write(sealed(1, 3, 0, 0, 0, 1)[:5])
        time.sleep(1.0)
        port.write(sealed(1, 3, 0, 0, 0, 1))
        return port.read(7)

    async with rtu(rig, tmp_path / "line"):
        reply = await elsewhere(tmp_path / "line", talk)
    assert reply == sealed(1, 3, 2, 0, 0)


@pytest.mark.parametrize("parity", [False, True])
async def test_octets_take_their_time_on_the_line(
    rig: Rig, tmp_path: Path, parity: bool
) -> None:
    pace = Pace(baud=9600, parity=parity, silence=4e-3)

    def talk(port: serial.Serial) -> float:
        start = time.monotonic()
        port.write(sealed(1, 3, 0, 0, 0, 8))
        assert len(port.read(21)) == 21
        return time.monotonic() - start

    async with rtu(rig, tmp_path / "line", pace):
        took = await elsewhere(tmp_path / "line", talk)
    bits = 11 if parity else 10
    # 8 octets there, the silence, 21 octets back.
    assert took >= (8 + 21) * bits / 9600 + 4e-3


async def test_a_line_of_text_takes_its_time_as_well(rig: Rig, tmp_path: Path) -> None:
    def talk(port: serial.Serial) -> tuple[bytes, float]:
        start = time.monotonic()
        port.write(b"$0160\r")
        return port.read_until(b"\r"), time.monotonic() - start

    speaker = DconSpeaker(Modules(rig, *fitted("icpdas_i_7024")))
    async with serve_serial(speaker, tmp_path / "line", Pace(baud=1200)):
        reply, took = await elsewhere(tmp_path / "line", talk)
    assert reply == b"!01+04.000\r"
    # 6 octets there, 11 back.
    assert took >= (6 + 11) * 10 / 1200


async def test_our_bus_drives_the_valve_at_its_pace(rig: Rig, tmp_path: Path) -> None:
    address = RtuAddress(port=str(tmp_path / "line"), baud=115_200, timeout=0.5)
    async with (
        rtu(rig, tmp_path / "line", Pace(baud=115_200, silence=1.75e-3)),
        open_bus(address) as bus,
    ):
        steady(bus)
        await bus.up.wait()
        assert await bus.ask(Read(1, Table.HOLDING, 0)) == (0,)
        assert await bus.ask(Write(1, 0, (10_700,))) == (10_700,)
    assert rig.plant.current == pytest.approx(0.0107)


async def test_clients_come_and_go(rig: Rig, tmp_path: Path) -> None:
    def talk(port: serial.Serial) -> bytes:
        port.write(sealed(1, 3, 0, 0, 0, 1))
        return port.read(7)

    async with rtu(rig, tmp_path / "line"):
        for _ in range(3):
            reply = await elsewhere(tmp_path / "line", talk)
            assert reply == sealed(1, 3, 2, 0, 0)


async def test_the_link_goes_with_the_bench_and_a_dead_one_is_replaced(
    rig: Rig, tmp_path: Path
) -> None:
    path = tmp_path / "line"
    path.symlink_to("/dev/pts/nobody")
    async with rtu(rig, path) as bench:
        assert bench.address == str(path)
        assert path.is_char_device()
    assert not path.is_symlink()


def end_of(link: Path) -> Path:
    return link.readlink()


async def is_left_alone(link: Path, rig: Rig) -> None:
    end = end_of(link)
    with pytest.raises(Refused, match=f"{link} is in the way: a link to {end}"):
        async with rtu(rig, link):
            pass
    assert end_of(link) == end


async def test_a_link_to_something_else_is_left_alone(rig: Rig, tmp_path: Path) -> None:
    path = tmp_path / "line"
    path.symlink_to(tmp_path / "disk that is not mounted")
    await is_left_alone(path, rig)


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can give a link away")
async def test_a_dead_link_of_another_user_is_left_alone(
    rig: Rig, tmp_path: Path
) -> None:
    path = tmp_path / "line"
    path.symlink_to("/dev/pts/nobody")
    os.lchown(path, 65534, 65534)
    await is_left_alone(path, rig)


async def test_what_was_put_in_place_of_the_link_outlives_the_bench(
    rig: Rig, tmp_path: Path
) -> None:
    path = tmp_path / "line"
    async with rtu(rig, path):
        path.unlink()
        path.write_text("precious")
    assert path.read_text() == "precious"


async def test_what_is_no_port_is_left_alone(rig: Rig, tmp_path: Path) -> None:
    path = tmp_path / "line"
    path.write_text("precious")
    with pytest.raises(Refused, match="it is no serial port"):
        async with rtu(rig, path):
            pass
    assert path.read_text() == "precious"
    with pytest.raises(Refused, match="cannot be used"):
        async with rtu(rig, tmp_path / "nowhere" / "line"):
            pass


async def test_a_port_that_is_there_is_opened(rig: Rig, tmp_path: Path) -> None:
    near, far = os.openpty()
    tty.setraw(near)
    tty.setraw(far)
    try:
        async with rtu(rig, Path(os.ttyname(far)), Pace(baud=19_200)):
            speed = termios.tcgetattr(far)[5]
            assert speed == termios.B19200
            os.write(near, sealed(1, 3, 0, 0, 0, 1))
            reply = b""
            async with asyncio.timeout(SOON):
                while len(reply) < 7:
                    reply += await asyncio.to_thread(os.read, near, 64)
        assert reply == sealed(1, 3, 2, 0, 0)
        # It is not the bench's, and stays.
        os.fstat(far)
    finally:
        os.close(near)
        os.close(far)


def test_a_speed_that_is_none_is_refused() -> None:
    with pytest.raises(InputError, match="baud = 0 Bd"):
        Pace(baud=0)
