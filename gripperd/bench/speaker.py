"""What a line of the bench says: honest answers, and answers gone wrong."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import ClassVar, TypeAlias

from gripperd.bench.channels import Outputs
from gripperd.bench.modules import Modules
from gripperd.bench.wire_faults import Asked, WireFault, WireFaultKind

NOISE = b"\x00\xff"
"""What a line picks up when a driver switches on."""
Spoil: TypeAlias = Callable[[bytes, bytes], bytes]
"""Makes another reply of a request and its honest reply."""
CUT_OFF = 3
"""Octets missing from a reply that is cut."""


class Speaker(ABC):
    """One grammar, spoken on behalf of every module of a line.

    Raises
    ------
    InputError
        A module does not speak it.
    """

    name: ClassVar[str]
    """Of the grammar, as settings and logs have it."""
    parted_by_silence: ClassVar[bool] = False
    """Whether silence alone parts frames: what it finds incomplete is dropped."""

    def __init__(self, modules: Modules) -> None:
        self.modules = modules
        self._spoilt: dict[WireFaultKind, Spoil] = {
            WireFaultKind.LOST: lambda frame, reply: b"",
            WireFaultKind.CUT: lambda frame, reply: reply[:-CUT_OFF],
            WireFaultKind.NOISE: lambda frame, reply: NOISE + reply,
            WireFaultKind.LOCAL_ECHO: lambda frame, reply: frame + reply,
            WireFaultKind.GARBLED: self._garbled,
            WireFaultKind.WRONG_UNIT: self._from_another_unit,
            WireFaultKind.WRONG_FUNCTION: self._to_another_function,
            WireFaultKind.WRONG_ECHO: self._with_another_value,
            WireFaultKind.SHORT: self._shortened,
        }

    @abstractmethod
    def request_length(self, buffer: bytes | bytearray) -> int | None:
        """Octets of the request at the start of a buffer, None while incomplete.

        Raises
        ------
        BadReply
            No request begins so.
        """

    @abstractmethod
    def heard(self, frame: bytes) -> tuple[frozenset[int], bool]:
        """Units that a complete request is for, and whether it writes."""

    @abstractmethod
    def answer(self, frame: bytes) -> bytes:
        """Do as a request says, and reply; nothing where nobody answers."""

    @abstractmethod
    def refusal(self, frame: bytes, code: int) -> bytes:
        """Refuse a request with a Modbus exception, or what stands for it."""

    def asked(self, frame: bytes) -> Asked:
        """What a complete request asks, as far as faults tell requests apart."""
        units, writes = self.heard(frame)
        asked = (self.modules.units.get(unit, ()) for unit in units)
        drives = any(isinstance(each, Outputs) for at in asked for each in at)
        return Asked(units, writes, drives)

    def spoilt(self, fault: WireFault, frame: bytes) -> bytes:
        """Reply to a request that meets a fault."""
        if fault.kind is WireFaultKind.EXCEPTION:
            return self.refusal(frame, fault.code)
        reply = self.answer(frame)
        spoil = self._spoilt.get(fault.kind)
        if spoil is None or not (reply or fault.kind is WireFaultKind.LOCAL_ECHO):
            return reply
        return spoil(frame, reply)

    @abstractmethod
    def _garbled(self, frame: bytes, reply: bytes) -> bytes:
        """The reply with one damaged octet."""

    @abstractmethod
    def _from_another_unit(self, frame: bytes, reply: bytes) -> bytes:
        """The reply as the next unit would give it."""

    @abstractmethod
    def _to_another_function(self, frame: bytes, reply: bytes) -> bytes:
        """The reply to a request of another kind."""

    @abstractmethod
    def _with_another_value(self, frame: bytes, reply: bytes) -> bytes:
        """The confirmation of another value."""

    @abstractmethod
    def _shortened(self, frame: bytes, reply: bytes) -> bytes:
        """A sound reply with less in it."""
