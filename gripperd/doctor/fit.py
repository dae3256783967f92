"""Whether the registers of a unit are those of a description. Only reads.

A description fits when all its places can be read and hold what they may hold. What
speaks for it beyond that are codes that another module would hardly have there.
"""

import math
from collections.abc import Iterator, Sequence

from gripperd.doctor.identity import (
    AnyModule,
    Identity,
    Match,
    matched,
    named,
)
from gripperd.drivers.registers import Unit
from gripperd.errors import LinkError, LinkLost
from gripperd.protocol.encoding import Range, Registers
from gripperd.protocol.modbus import Read, Table
from gripperd.protocol.modules import InputModule, OutputMap, RegisterMap

VERSIONS = range(100, 1000)
"""Firmware versions that are taken for one: 1.00 to 9.99."""
OVERRANGE = 0.05
"""What a value may lie beyond its range, relative to the span. [-]"""


class Registry:
    """Registers of one unit, each read once.

    Parameters
    ----------
    unit
        Which device.
    """

    def __init__(self, unit: Unit) -> None:
        self._unit = unit
        self._known: dict[tuple[Table, int, int], tuple[int, ...] | None] = {}

    async def read(self, table: Table, address: int, count: int) -> Sequence[int]:
        """Registers, or nothing where they cannot be read.

        Raises
        ------
        LinkLost
            The line is gone.
        """
        key = (table, address, count)
        if key not in self._known:
            self._known[key] = await self._ask(Read(self._unit.number, *key))
        return self._known[key] or ()

    async def channels(
        self, place: Registers, channels: int, words: int = 1
    ) -> list[Sequence[int]]:
        """Words of every channel, or nothing where they cannot be read."""
        count = place.stride * (channels - 1) + words
        read = await self.read(place.table, place.address, count)
        starts = (place.stride * channel for channel in range(channels))
        return [read[start : start + words] for start in starts] if read else []

    async def _ask(self, request: Read) -> tuple[int, ...] | None:
        try:
            return await self._unit.look(request)
        except LinkLost:
            raise
        except LinkError:
            return None


async def identify(unit: Unit, modules: Sequence[AnyModule]) -> Identity:
    """Find the description that a unit fits.

    Raises
    ------
    LinkLost
        The line is gone.
    """
    registers = Registry(unit)
    bearing = [each for each in modules if await _says_its_name(registers, each)]
    if bearing:
        return named(bearing[0].title.partition(",")[0], bearing)
    matches = []
    for module in modules:
        comparison = _Comparison(registers, module)
        if not await comparison.holds():
            continue
        matches.append(Match(module, tuple(comparison.agreements)))
    return matched(matches)


async def _says_its_name(registers: Registry, module: AnyModule) -> bool:
    name = module.modbus.type_name if module.modbus else None
    if name is None:
        return False
    found = await registers.read(name.registers.table, name.registers.address, 1)
    return list(found) == [name.code]


class _Comparison:
    """Holds one description against the registers."""

    def __init__(self, registers: Registry, module: AnyModule) -> None:
        self.agreements: list[str] = []
        """What speaks for it."""
        self._registers = registers
        self._module = module
        self._ranges = list(module.ranges.values())

    async def holds(self) -> bool:
        """Whether nothing speaks against it."""
        expected = self._module.modbus
        return (
            expected is not None
            and await self._readable(expected)
            and await self._required(expected)
            and await self._coded(expected)
            and await self._valued(expected)
            and await self._versioned(expected)
        )

    async def _readable(self, expected: RegisterMap) -> bool:
        for place, words in _places(expected):
            if not await self._registers.channels(place, self._module.channels, words):
                return False
        watchdog = expected.watchdog if isinstance(expected, OutputMap) else None
        if watchdog is None:
            return True
        return bool(await self._registers.read(Table.HOLDING, watchdog.time, 1))

    async def _required(self, expected: RegisterMap) -> bool:
        if expected.required is None:
            return True
        place, code = expected.required.registers, expected.required.code
        found = await self._registers.read(place.table, place.address, 1)
        # What is zero everywhere says nothing.
        if code and list(found) == [code]:
            self.agreements.append(f"{place} is {code}")
        return list(found) == [code]

    async def _coded(self, expected: RegisterMap) -> bool:
        codes = expected.range_code
        if codes is None:
            return True
        read = await self._registers.channels(codes, self._module.channels)
        found = {code for code, *_ in read}
        self._ranges = [each for each in self._ranges if each.code in found]
        if found - {0} and self._ranges:
            chosen = self._ranges[0]
            self.agreements.append(f"{codes} has the code of {chosen.name}")
        return bool(self._ranges)

    async def _valued(self, expected: RegisterMap) -> bool:
        place, encoding = expected.values, expected.encoding
        read = await self._registers.channels(
            place, self._module.channels, encoding.words
        )
        return all(
            any(self._plausible(count, each) for each in self._ranges)
            for count in map(encoding.decode, read)
        )

    async def _versioned(self, expected: RegisterMap) -> bool:
        """Count a firmware version as an agreement; without one nothing is said."""
        if expected.version is not None:
            place = expected.version
            found = await self._registers.read(place.table, place.address, 1)
            if found and found[0] in VERSIONS:
                self.agreements.append(f"its firmware is {found[0] / 100:.2f}")
        return True

    def _plausible(self, count: float, chosen: Range) -> bool:
        """Whether a value can be one of a range; a broken loop is below any."""
        margin = OVERRANGE * abs(chosen.count_high - chosen.count_low)
        low, high = chosen.count_low - margin, chosen.count_high + margin
        if isinstance(self._module, InputModule):
            low = -math.inf
        return math.isfinite(count) and low <= count <= high


def _places(expected: RegisterMap) -> Iterator[tuple[Registers, int]]:
    """Where each channel has so many words."""
    width = expected.encoding.words
    yield expected.values, width
    if expected.range_code is not None:
        yield expected.range_code, 1
    if expected.status is not None and expected.status.registers is not None:
        yield expected.status.registers, expected.status.words
    if isinstance(expected, OutputMap):
        yield expected.read_back, width
        if expected.safe is not None:
            yield expected.safe, width
