"""Octets of the vendors' own examples, read back in words."""

import pytest

from gripperd.config.module_library import ModuleLibrary
from gripperd.drivers.address import (
    Address,
    DconAddress,
    ItvAddress,
    RtuAddress,
    TcpAddress,
)
from gripperd.drivers.exchange import Exchange
from gripperd.drivers.traffic import Heard
from gripperd.drivers.transcript import Direction, Spoken, Transcript
from gripperd.drivers.wiring import InputWiring, OutputWiring, SensorWiring
from gripperd.protocol.live_zero import LoopScale
from gripperd.protocol.modules import ModuleDialect

LIBRARY = ModuleLibrary()
TCP = TcpAddress(host="h", port=502)
RTU, DCON, ITV = (
    kind(port="/dev/ttyS9") for kind in (RtuAddress, DconAddress, ItvAddress)
)
SCALE = LoopScale(value_low=0.0, value_high=600e3)


def output(module: str, dialect: ModuleDialect) -> OutputWiring:
    return OutputWiring(
        module=LIBRARY.output(module), unit=1, channel=0, dialect=dialect
    )


VALVE = output("waveshare_ao_8ch", ModuleDialect.MODBUS)
PRESSURE = InputWiring(
    module=LIBRARY.input("waveshare_ai_8ch"),
    unit=2,
    sensors={"pressure": SensorWiring(channel=1, scale=SCALE)},
)


def read(
    address: Address,
    wiring: OutputWiring | InputWiring,
    request: bytes,
    reply: bytes,
    error: str | None = None,
) -> tuple[Spoken, Spoken]:
    exchange = Exchange(time=1.0, request=request, reply=reply, error=error)
    return Transcript(address, [wiring]).read(Heard(1, 1.5, exchange))


def test_a_write_of_10_7_ma_is_read_as_that() -> None:
    octets = bytes.fromhex("0001 0000 0006 01 06 0000 29CC")
    asked, answered = read(TCP, VALVE, octets, octets)
    assert (asked.time, asked.direction) == (1.0, Direction.REQUEST)
    assert (answered.time, answered.direction) == (1.5, Direction.REPLY)
    meaning = asked.meaning
    assert (meaning.unit, meaning.function, meaning.registers) == (1, 6, (10_700,))
    assert meaning.said == "write 10700 to holding register 0 of unit 1"
    assert meaning.currents == {"valve": pytest.approx(10.7e-3)}
    assert answered.meaning.said == "done"
    assert answered.error is None


def test_a_read_of_a_sensor_is_its_current() -> None:
    asked, answered = read(
        TCP,
        PRESSURE,
        bytes.fromhex("0001 0000 0006 02 04 0000 0002"),
        bytes.fromhex("0001 0000 0007 02 04 04 0FA0 2EE0"),
    )
    assert asked.meaning.currents == {}
    assert answered.meaning.registers == (4000, 12_000)
    assert answered.meaning.currents == {"pressure": pytest.approx(12e-3)}


def test_a_register_of_another_table_is_no_sensor() -> None:
    _, answered = read(
        TCP,
        PRESSURE,
        bytes.fromhex("0001 0000 0006 02 03 0000 0002"),
        bytes.fromhex("0001 0000 0007 02 03 04 0FA0 2EE0"),
    )
    assert answered.meaning.registers == (4000, 12_000)
    assert answered.meaning.currents == {}


def test_a_module_that_is_not_wired_is_not_guessed_at() -> None:
    octets = bytes.fromhex("0001 0000 0006 07 06 0000 29CC")
    asked, _ = read(TCP, VALVE, octets, octets)
    assert (asked.meaning.unit, asked.meaning.currents) == (7, {})


def test_the_vendors_rtu_example_is_read() -> None:
    octets = bytes.fromhex("01 06 00 00 03 E8 89 74")
    asked, _ = read(RTU, VALVE, octets, octets)
    assert asked.meaning.currents == {"valve": pytest.approx(1e-3)}


def test_an_exception_is_told_in_words() -> None:
    _, answered = read(
        TCP,
        VALVE,
        bytes.fromhex("0001 0000 0006 01 03 0009 0001"),
        bytes.fromhex("0001 0000 0003 01 83 02"),
        "DeviceRefused",
    )
    assert answered.error == "DeviceRefused"
    assert "illegal address (exception 2)" in answered.meaning.said


def test_silence_is_told_as_that() -> None:
    octets = bytes.fromhex("0001 0000 0006 01 03 0009 0001")
    _, answered = read(TCP, VALVE, octets, b"", "ReplyTimeout")
    assert (answered.meaning.said, answered.error) == ("no reply", "ReplyTimeout")


def test_a_line_of_dcon_is_read() -> None:
    wiring = output("icpdas_i_7024", ModuleDialect.DCON)
    asked, answered = read(DCON, wiring, b"#010+10.700\r", b">\r")
    assert (asked.meaning.said, asked.meaning.unit) == ("#010+10.700", 1)
    assert asked.meaning.currents == {"valve": pytest.approx(10.7e-3)}
    assert (answered.meaning.said, answered.meaning.currents) == (">", {})
    _, back = read(DCON, wiring, b"$0160\r", b"!01+04.000\r")
    assert back.meaning.currents == {"valve": pytest.approx(4e-3)}
    other, _ = read(DCON, wiring, b"#013+10.700\r", b">\r")
    assert other.meaning.currents == {}


def test_a_safe_value_is_not_taken_for_the_output() -> None:
    wiring = output("icpdas_i_7024", ModuleDialect.DCON)
    _, answered = read(DCON, wiring, b"~0140\r", b"!01+04.000\r")
    assert answered.meaning.currents == {}


def test_a_pressure_of_an_itv_is_the_current_that_stands_for_it() -> None:
    wiring = output("smc_itv_rc", ModuleDialect.ITV)
    asked, answered = read(ITV, wiring, b"SET 1023\r\n", b"1023\r\n")
    assert asked.meaning.currents == {"valve": pytest.approx(20e-3)}
    assert answered.meaning.currents == {"valve": pytest.approx(20e-3)}
    _, measured = read(ITV, wiring, b"MON\r\n", b"1023\r\n")
    assert measured.meaning.currents == {}


def test_octets_that_are_no_request_are_shown_as_they_are() -> None:
    asked, _ = read(RTU, VALVE, b"\xff\x00", b"")
    assert asked.meaning.said == "ff 00"
