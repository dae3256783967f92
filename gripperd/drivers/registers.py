"""Reading registers, and comparing how a module is set up with what is expected."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from gripperd.drivers.bus import ModbusBus
from gripperd.errors import DeviceRefused, ModuleMismatch
from gripperd.protocol.encoding import Range, Registers
from gripperd.protocol.modbus import Read, Refusal
from gripperd.protocol.modules import Module, RegisterMap
from gripperd.protocol.watchdog import Setting

PASSING = frozenset({Refusal.ACKNOWLEDGE, Refusal.BUSY, Refusal.NO_RESPONSE})
"""Refusals that may be over a moment later."""


@dataclass(frozen=True, slots=True)
class Unit:
    """One Modbus device on a bus."""

    bus: ModbusBus
    number: int

    async def look(self, request: Read) -> tuple[int, ...]:
        """Read, and once more from a busy device; a write is never repeated."""
        try:
            return await self.bus.ask(request)
        except DeviceRefused as error:
            if error.exception_code not in PASSING:
                raise
            return await self.bus.ask(request)

    async def fetch(
        self, registers: Registers, channels: Iterable[int], words: int = 1
    ) -> Mapping[int, Sequence[int]]:
        """Words of several channels by channel, in one request."""
        starts = {channel: registers.of(channel) for channel in channels}
        first, last = min(starts.values()), max(starts.values())
        count = last - first + words
        read = await self.look(Read(self.number, registers.table, first, count))
        return {
            channel: read[start - first : start - first + words]
            for channel, start in starts.items()
        }

    async def one(self, registers: Registers, channel: int = 0) -> int:
        """One register or bit of one channel."""
        words = await self.fetch(registers, (channel,))
        return words[channel][0]

    async def set(self, setting: Setting) -> None:
        """Write a register or coil, and see that it was taken.

        Raises
        ------
        ModuleMismatch
            It reads back as something else.
        """
        await self.bus.ask(setting.write(self.number))
        if not await self.holds(setting):
            message = f"unit {self.number}: {setting} was written and does not hold"
            raise ModuleMismatch(message)

    async def holds(self, setting: Setting) -> bool:
        """Whether a register has that value."""
        place = Registers(setting.table, setting.address)
        return await self.one(place) == setting.value


async def check_setup(
    unit: Unit,
    module: Module,
    expected: RegisterMap,
    chosen: Range,
    channels: Sequence[int],
    *,
    set_range: bool,
) -> bool:
    """Compare what decides on the meaning of a module's registers.

    Parameters
    ----------
    unit, module
        Which device, and what it is said to be.
    expected
        Where range code and format stand, if anywhere.
    chosen
        Range that every channel must have.
    channels
        Those in use.
    set_range
        Set what differs, which may change the output at once.

    Returns
    -------
    Whether the ranges were compared; False where the module does not tell.

    Raises
    ------
    ModuleMismatch
        Something differs and was not to be set, or cannot be.
    LinkError
        No trustworthy answer came.
    """
    if expected.required is not None:
        place, code = expected.required.registers, expected.required.code
        found = await unit.one(place)
        if found != code:
            message = (
                f"{module.name}, unit {unit.number}: {place} is {found}, {code} is"
                f" wanted ({expected.required.meaning}); write {code} to it"
            )
            raise ModuleMismatch(message)
    codes = expected.range_code
    if codes is None or chosen.code is None:
        return False
    for channel, (found, *_) in (await unit.fetch(codes, channels)).items():
        setting = Setting(codes.table, codes.of(channel), chosen.code)
        if found == chosen.code:
            continue
        if not set_range:
            message = (
                f"channel {channel} of {module.name}, unit {unit.number}, has range"
                f" code {called(module, found)}, {called(module, chosen.code)} is"
                f" wanted: set {setting}, or say `set_range: true` to have it done"
            )
            raise ModuleMismatch(message)
        await unit.set(setting)
    return True


def called(module: Module, code: int, digits: int = 4) -> str:
    """Code of a range, and its name where it is described."""
    names = [each.name for each in module.ranges.values() if each.code == code]
    return f"0x{code:0{digits}X} ({names[0] if names else 'not one described'})"
