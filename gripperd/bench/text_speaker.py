"""Lines of text on behalf of the bench's modules: DCON, ADAM ASCII, ITV.

Such a line has no exceptions: one stands for an invalid or unknown command here.
"""

from collections.abc import Callable

from gripperd.bench.itv_device import ItvDevice
from gripperd.bench.modules import Modules
from gripperd.bench.speaker import Speaker
from gripperd.bench.text_device import TextDevice
from gripperd.bench.text_line import Grant
from gripperd.errors import InputError
from gripperd.protocol import dcon, itv
from gripperd.protocol.modules import ModuleDialect

DIALECTS = (ModuleDialect.DCON, ModuleDialect.ADAM_ASCII)
"""What can be spoken on one line of DCON; a module speaks one of them."""
ADDRESSED = 4
"""Octets of the shortest reply that says who sends it: `!01` and its end."""


class DconSpeaker(Speaker):
    """DCON and ADAM ASCII.

    Parameters
    ----------
    modules
        Those on the line.
    checksum
        Whether lines end in their sum.
    """

    name = "dcon"

    def __init__(self, modules: Modules, *, checksum: bool = False) -> None:
        super().__init__(modules)
        modules.spoken(DIALECTS)
        self._codec = dcon.Dcon(checksum=checksum)
        self._devices: dict[int, TextDevice] = {}
        for unit, at in modules.units.items():
            if len(at) > 1:
                names = " and ".join(each.module.name for each in at)
                message = f"{names} are both unit {unit}: give each its own"
                raise InputError(message, key="unit")
            spoken = (d for d in DIALECTS if d in at[0].module.dialects)
            self._devices[unit] = TextDevice(at[0], next(spoken))

    def request_length(self, buffer: bytes | bytearray) -> int | None:
        """Octets of the request at the start of a buffer, None while incomplete."""
        return self._codec.request_length(buffer)

    def heard(self, frame: bytes) -> tuple[frozenset[int], bool]:
        """Units that a line is for, and whether it carries a value."""
        command = self._codec.decode_request(frame)
        if command is None:
            return frozenset(), False
        units = self._devices if command.unit is None else (command.unit,)
        writes = command.lead is dcon.Lead.VALUE and bool(command.text)
        return frozenset(units), writes

    def answer(self, frame: bytes) -> bytes:
        """Do as a line says, and reply; a damaged line has no reply."""
        command = self._codec.decode_request(frame)
        if command is None:
            return b""
        if command.unit is None:
            self._tell_all(command)
            return b""
        if command.unit not in self._devices:
            return b""
        found = self._devices[command.unit].answer(command)
        if isinstance(found, Grant):
            return self._codec.encode_reply(command, found.good, found.text)
        return self._codec.encode_refusal(command, found)

    def refusal(self, frame: bytes, code: int) -> bytes:
        """An invalid command, whatever the code."""
        command = self._codec.decode_request(frame)
        if command is None or command.unit not in self._devices:
            return b""
        return self._codec.encode_refusal(command, dcon.Refusal.INVALID)

    def _tell_all(self, command: dcon.Command) -> None:
        if command.line != dcon.HOST_OK.line:
            return
        for device in self._devices.values():
            device.hear_host()

    def _garbled(self, frame: bytes, reply: bytes) -> bytes:
        return _damaged(reply)

    def _from_another_unit(self, frame: bytes, reply: bytes) -> bytes:
        """The same where a reply says no unit, as after a `>`."""
        if reply[:1] not in (b"!", b"?") or len(reply) < ADDRESSED:
            return reply
        other = b"%02X" % (int(reply[1:3], 16) ^ 0x40)
        return self._changed(reply, lambda line: line[:1] + other + line[3:])

    def _to_another_function(self, frame: bytes, reply: bytes) -> bytes:
        """The other kind of grant; alone it would say that the watchdog has tripped."""
        other = b"!" if reply[:1] == b">" else b">"
        return self._changed(reply, lambda line: other + (line[1:] or b"00"))

    def _with_another_value(self, frame: bytes, reply: bytes) -> bytes:
        """Another last digit, or one where there should be none."""

        def other(line: bytes) -> bytes:
            return line[:-1] + bytes((line[-1] ^ 1,)) if line[1:] else line + b"0"

        return self._changed(reply, other)

    def _shortened(self, frame: bytes, reply: bytes) -> bytes:
        return self._changed(reply, lambda line: line[:-1])

    def _changed(self, reply: bytes, change: Callable[[bytes], bytes]) -> bytes:
        """The reply with another line in it, sound again."""
        line = reply.removesuffix(dcon.END)
        changed = change(line[:-2] if self._codec.checksum else line)
        seal = b"%02X" % (sum(changed) % 256) if self._codec.checksum else b""
        return changed + seal + dcon.END


class ItvSpeaker(Speaker):
    """An SMC regulator, alone on its line.

    Raises
    ------
    InputError
        Another module is on the line.
    """

    name = "itv"

    def __init__(self, modules: Modules) -> None:
        super().__init__(modules)
        modules.spoken((ModuleDialect.ITV,))
        if len(modules.outputs) != 1:
            message = "a line of ITV leads to one regulator alone"
            raise InputError(message, key="module")
        self._codec = itv.Itv()
        self._units = frozenset(modules.units)
        self._device = ItvDevice(modules.outputs[0], modules.rig)

    def request_length(self, buffer: bytes | bytearray) -> int | None:
        """Octets of the request at the start of a buffer, None while incomplete."""
        return self._codec.request_length(buffer)

    def heard(self, frame: bytes) -> tuple[frozenset[int], bool]:
        """Units that a line is for, and whether it carries a value."""
        return self._units, isinstance(self._codec.decode_request(frame), itv.Set)

    def answer(self, frame: bytes) -> bytes:
        """Do as a line says, and reply."""
        found = self._device.answer(self._codec.decode_request(frame))
        if isinstance(found, itv.Refusal):
            return self._codec.encode_refusal(found)
        return self._codec.encode_reply(found)

    def refusal(self, frame: bytes, code: int) -> bytes:
        """An unknown command, whatever the code."""
        return self._codec.encode_refusal(itv.Refusal.UNKNOWN_COMMAND)

    def _garbled(self, frame: bytes, reply: bytes) -> bytes:
        return _damaged(reply)

    def _from_another_unit(self, frame: bytes, reply: bytes) -> bytes:
        """The same: there are no units."""
        return reply

    def _to_another_function(self, frame: bytes, reply: bytes) -> bytes:
        """A line that is no count."""
        return b"OK" + itv.END

    def _with_another_value(self, frame: bytes, reply: bytes) -> bytes:
        count = int(reply.removesuffix(itv.END))
        return self._codec.encode_reply(count ^ 1)

    def _shortened(self, frame: bytes, reply: bytes) -> bytes:
        """No digits at all; fewer of them would be another count."""
        return itv.END


def _damaged(reply: bytes) -> bytes:
    """The first character is no printable one any more, or another."""
    return bytes((reply[0] ^ 0x20,)) + reply[1:]
