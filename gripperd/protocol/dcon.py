"""DCON: the ASCII lines of ADAM-4000, I-7000 and their kin, both halves.

A command is one line, `#010+10.700`: a lead character, the module in two hexadecimal
digits, and text. A module that finds a mistake in a line says nothing at all.
"""

import re
from dataclasses import dataclass
from enum import StrEnum

from gripperd.errors import BadReply, DeviceRefused, InputError, WatchdogTripped
from gripperd.protocol.disbelief import not_believed
from gripperd.protocol.half_duplex import HalfDuplex

END = b"\r"

LONGEST = 128
"""Octets in which a line must end; eight channels of seven characters take 60."""

_COMMAND = re.compile(r"([#$~%])([0-9A-F]{2}|\*\*)([ -~]*)")


class Lead(StrEnum):
    """First character of a command: what kind it is."""

    VALUE = "#"
    SETTING = "$"
    HOST = "~"
    CONFIGURE = "%"


class Good(StrEnum):
    """First character of a reply that grants a command."""

    PROMPT = ">"
    ADDRESS = "!"
    """Followed by the address of the module. Alone it is no grant: the host watchdog
    of the module has tripped."""


class Refusal(StrEnum):
    """What a module says when it does not do as it is told."""

    INVALID = "?AA"
    OUT_OF_RANGE = "?"
    WATCHDOG = "!"


@dataclass(frozen=True, slots=True)
class Command:
    """One line to a module.

    Raises
    ------
    InputError
        It cannot be written as a line.
    """

    unit: int | None
    """Address of the module; None is every module, and none of them answers."""
    text: str
    lead: Lead = Lead.VALUE

    def __post_init__(self) -> None:
        if self.unit is not None and not 0 <= self.unit <= 0xFF:
            message = f"unit {self.unit} is no DCON address: 0 to 255 is"
            raise InputError(message, key="unit")
        if _COMMAND.fullmatch(self.line) is None:
            message = f"{self.text!r} cannot be sent: only printable ASCII can"
            raise InputError(message, key="text")

    @property
    def line(self) -> str:
        """As it is sent, without checksum and end."""
        address = "**" if self.unit is None else f"{self.unit:02X}"
        return f"{self.lead.value}{address}{self.text}"

    def __str__(self) -> str:
        """As it is sent."""
        return self.line


@dataclass(frozen=True, slots=True)
class Ask(Command):
    """A command, and what a good reply to it looks like.

    Modules differ: `#010+10.700` is granted by an I-7024 with `>`, by an ADAM-4024
    with `!01`.
    """

    good: Good = Good.PROMPT
    payload: int | None = 0
    """Characters behind the grant; None where the module decides."""


HOST_OK = Ask(None, "", Lead.HOST)
"""Tells the host watchdogs of all modules that the host lives; has no reply."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Dcon(HalfDuplex[Ask, str]):
    """Lines of DCON.

    A line says neither what it answers nor always who sends it. A late reply of the
    same form cannot be told from the right one: whoever owns the line must let it
    fall silent before asking again.
    """

    checksum: bool = False
    """Lines end in the sum of their characters modulo 256, in hexadecimal."""

    def encode(self, request: Command, sequence: int) -> bytes:
        """Octets of a command; the line carries no `sequence`."""
        return self._sealed(request.line)

    def _reply_length(self, request: Ask, buffer: bytes | bytearray) -> int | None:
        if request.unit is None:
            return 0
        if buffer and buffer[0] not in b">!?":
            raise not_believed(request, "no reply begins so", repr(bytes(buffer)))
        return _line_length(buffer)

    def _decode_reply(self, request: Ask, frame: bytes) -> str:
        """Return the text behind the grant."""
        if request.unit is None:
            if frame:
                raise not_believed(request, "nobody was to answer", repr(frame))
            return ""
        line = self._opened(frame)
        if line is None:
            raise not_believed(request, "it is damaged", repr(frame))
        _raise_refusal(request, line)
        good = request.good.value
        if request.good is Good.ADDRESS:
            good = f"{good}{request.line[1:3]}"
        if not line.startswith(good):
            raise not_believed(request, f"it does not begin with {good}", repr(frame))
        text = line.removeprefix(good)
        if request.payload is not None and len(text) != request.payload:
            why = f"{request.payload} characters were to follow {good}"
            raise not_believed(request, why, repr(frame))
        return text

    def request_length(self, buffer: bytes | bytearray) -> int | None:
        """Octets of the command at the start of a buffer, None while incomplete.

        Raises
        ------
        BadReply
            It does not end; follow the stream again after the next end of a line.
        """
        return _line_length(buffer)

    def decode_request(self, frame: bytes) -> Command | None:
        """What a complete line asks; None where it is damaged and gets no answer."""
        line = self._opened(frame)
        command = None if line is None else _COMMAND.fullmatch(line)
        if command is None:
            return None
        lead, address, text = command.groups()
        return Command(None if address == "**" else int(address, 16), text, Lead(lead))

    def encode_reply(self, request: Command, good: Good, text: str = "") -> bytes:
        """Grant of a command, and the text behind it."""
        address = request.line[1:3] if good is Good.ADDRESS else ""
        return self._sealed(f"{good.value}{address}{text}")

    def encode_refusal(self, request: Command, refusal: Refusal) -> bytes:
        """Refusal of a command."""
        return self._sealed(refusal.value.replace("AA", request.line[1:3]))

    def _sealed(self, line: str) -> bytes:
        octets = line.encode("ascii")
        return octets + (_sum(octets) if self.checksum else b"") + END

    def _opened(self, frame: bytes) -> str | None:
        """The line in a frame, None if it is damaged."""
        octets = frame.removesuffix(END)
        if octets == frame:
            return None
        if self.checksum:
            octets, seal = octets[:-2], octets[-2:]
            if seal != _sum(octets):
                return None
        line = octets.decode("latin-1")
        return line if line.isascii() and line.isprintable() else None


def _line_length(buffer: bytes | bytearray) -> int | None:
    end = buffer.find(END, 0, LONGEST)
    if end >= 0:
        return end + 1
    if len(buffer) >= LONGEST:
        message = f"a line does not end: {bytes(buffer[:32])!r}"
        raise BadReply(message)
    return None


def _sum(octets: bytes) -> bytes:
    return b"%02X" % (sum(octets) % 256)


def _raise_refusal(request: Ask, line: str) -> None:
    if line == Refusal.WATCHDOG:
        message = (
            f"the module ignores '{request}': its host watchdog has tripped, and its"
            " outputs are at their safe values until the watchdog is cleared"
        )
        raise WatchdogTripped(message)
    if line == Refusal.OUT_OF_RANGE:
        message = (
            f"the module refuses '{request}': out of range; its output may have gone"
            " to the end of the range"
        )
        raise DeviceRefused(message)
    if line == f"?{request.line[1:3]}":
        message = f"the module refuses '{request}': an invalid command"
        raise DeviceRefused(message)
