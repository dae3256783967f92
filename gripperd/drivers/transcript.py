"""Exchanges on a bus as a person reads them: who asked what, and what it means."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from typing import TypeAlias

from gripperd.drivers.address import (
    Address,
    DconAddress,
    ItvAddress,
    RtuAddress,
    TcpAddress,
)
from gripperd.drivers.exchange import Exchange
from gripperd.drivers.traffic import Heard
from gripperd.drivers.wiring import InputWiring, OutputWiring
from gripperd.errors import LinkError
from gripperd.protocol.dcon import Dcon, Lead
from gripperd.protocol.encoding import Registers
from gripperd.protocol.engineering import CURRENT
from gripperd.protocol.itv import Itv, Query, Set
from gripperd.protocol.mbap import ModbusTcp
from gripperd.protocol.modbus import Read, Refusal, Request, Table, Write
from gripperd.protocol.rtu import ModbusRtu
from gripperd.units import MILLI

VALVE = "valve"
"""What the output's current is called; those of sensors have their sensor's name."""

Wiring: TypeAlias = OutputWiring | InputWiring


class Direction(StrEnum):
    """Which way octets went."""

    REQUEST = "request"
    REPLY = "reply"


@dataclass(frozen=True, slots=True, kw_only=True)
class Meaning:
    """What octets say."""

    said: str
    """In words."""
    unit: int | None = None
    function: int | None = None
    """Function code of Modbus."""
    registers: tuple[int, ...] = ()
    """Written, or read; bits as 0 and 1."""
    currents: Mapping[str, float] = field(default_factory=dict)
    """By sensor, or `VALVE`, where a channel that is wired was touched. [A]"""


@dataclass(frozen=True, slots=True, kw_only=True)
class Spoken:
    """One half of an exchange."""

    time: float
    """On the monotonic clock. [s]"""
    direction: Direction
    octets: bytes
    meaning: Meaning
    error: str | None = None
    """Name of the error; None unless it is a reply that was not believed."""


class Transcript:
    """Reads the exchanges of one bus.

    Parameters
    ----------
    address
        What is spoken on it.
    wirings
        What is known to be connected there.
    """

    def __init__(self, address: Address, wirings: Sequence[Wiring]) -> None:
        self._address = address
        self._wirings = wirings

    def read(self, heard: Heard) -> tuple[Spoken, Spoken]:
        """Request and reply of one exchange."""
        exchange = heard.exchange
        asked, answered = self._meanings(exchange)
        if not exchange.reply:
            answered = Meaning(said="no reply", unit=asked.unit)
        return (
            Spoken(
                time=exchange.time,
                direction=Direction.REQUEST,
                octets=exchange.request,
                meaning=asked,
            ),
            Spoken(
                time=heard.ended,
                direction=Direction.REPLY,
                octets=exchange.reply,
                meaning=answered,
                error=exchange.error,
            ),
        )

    def _meanings(self, exchange: Exchange) -> tuple[Meaning, Meaning]:
        match self._address:
            case TcpAddress():
                transaction = int.from_bytes(exchange.request[:2], "big")
                return self._modbus(ModbusTcp(), transaction, exchange)
            case RtuAddress(local_echo=echo):
                return self._modbus(ModbusRtu(local_echo=echo), 0, exchange)
            case DconAddress(local_echo=echo, checksum=checksum):
                return self._dcon(Dcon(local_echo=echo, checksum=checksum), exchange)
            case ItvAddress():
                return self._itv(exchange)

    def _modbus(
        self, dialect: ModbusTcp | ModbusRtu, sequence: int, exchange: Exchange
    ) -> tuple[Meaning, Meaning]:
        request = dialect.decode_request(exchange.request)
        if request is None or isinstance(request, Refusal):
            return _illegible(exchange.request), _illegible(exchange.reply)
        written = request.values if isinstance(request, Write) else ()
        asked = self._told(request, str(request), written)
        try:
            found = dialect.decode(request, sequence, exchange.reply)
        except LinkError as error:
            return asked, self._told(request, str(error), ())
        read = ", ".join(map(str, found)) if isinstance(request, Read) else "done"
        return asked, self._told(request, read, found)

    def _told(self, request: Request, said: str, values: tuple[int, ...]) -> Meaning:
        return Meaning(
            said=said,
            unit=request.unit,
            function=request.function,
            registers=values,
            currents=dict(self._touched(request, values)),
        )

    def _touched(
        self, request: Request, values: tuple[int, ...]
    ) -> Iterator[tuple[str, float]]:
        """Currents of the channels whose registers all were written or read."""
        table = request.table if isinstance(request, Read) else Table.HOLDING
        for wiring in self._wirings:
            registers = wiring.module.modbus
            if registers is None or wiring.unit != request.unit:
                continue
            width = registers.encoding.words
            for name, place, channel in _channels(wiring):
                start = place.of(channel) - request.address
                words = values[start : start + width] if start >= 0 else ()
                if place.table is table and len(words) == width:
                    count = registers.encoding.decode(words)
                    yield name, wiring.range.current(count)

    def _dcon(self, dialect: Dcon, exchange: Exchange) -> tuple[Meaning, Meaning]:
        command = dialect.decode_request(exchange.request)
        if command is None:
            return _illegible(exchange.request), _illegible(exchange.reply)
        reply = exchange.reply
        if dialect.local_echo:
            reply = reply.removeprefix(exchange.request)
        answer = _line(reply)
        values = command.lead in {Lead.VALUE, Lead.SETTING}
        sent, came = (
            dict(self._said(command.unit, command.text, line)) if values else {}
            for line in (command.text, answer)
        )
        return (
            Meaning(said=command.line, unit=command.unit, currents=sent),
            Meaning(said=answer, unit=command.unit, currents=came),
        )

    def _said(
        self, unit: int | None, command: str, line: str
    ) -> Iterator[tuple[str, float]]:
        """Currents in a line that belongs to a command."""
        found = CURRENT.findall(line)
        # A channel is the last digit before the value, or of a command without one.
        channel = CURRENT.split(command)[0][-1:]
        for wiring in self._wirings:
            if wiring.unit != unit:
                continue
            if isinstance(wiring, InputWiring):
                for name, sensor in wiring.sensors.items():
                    if sensor.channel < len(found):
                        yield name, float(found[sensor.channel]) * MILLI
            elif found and channel == f"{wiring.channel:X}":
                yield VALVE, float(found[0]) * MILLI

    def _itv(self, exchange: Exchange) -> tuple[Meaning, Meaning]:
        request = Itv().decode_request(exchange.request)
        sent, came = _line(exchange.request), _line(exchange.reply)
        aim = request.count if isinstance(request, Set) else None
        aimed = isinstance(request, Set) or request == Query.SET_POINT
        found = int(came) if aimed and came.isdecimal() else None
        return (
            Meaning(said=sent, currents=dict(self._aim(aim))),
            Meaning(said=came, currents=dict(self._aim(found))),
        )

    def _aim(self, count: int | None) -> Iterator[tuple[str, float]]:
        for wiring in self._wirings:
            if count is not None and isinstance(wiring, OutputWiring):
                yield VALVE, wiring.range.current(count)


def _channels(wiring: Wiring) -> Iterator[tuple[str, Registers, int]]:
    """Name, registers and channel of everything that is wired to a Modbus module."""
    if isinstance(wiring, InputWiring):
        registers = wiring.module.modbus
        if registers is not None:
            for name, sensor in wiring.sensors.items():
                yield name, registers.values, sensor.channel
    elif wiring.module.modbus is not None:
        for place in (wiring.module.modbus.read_back, wiring.module.modbus.values):
            yield VALVE, place, wiring.channel


def _line(octets: bytes) -> str:
    """Text without its end, what cannot be printed escaped."""
    return octets.rstrip(b"\r\n").decode("ascii", "backslashreplace")


def _illegible(octets: bytes) -> Meaning:
    return Meaning(said=octets.hex(" "))
