"""A simulated module as Modbus sees it."""

from collections.abc import Iterator, Mapping, Sequence

from gripperd.bench.banks import Bank, Fixed, Format, Place, RangeCodes, Statuses, Words
from gripperd.bench.channels import Inputs, Outputs
from gripperd.bench.current_banks import Currents, Outlets, SetPoints
from gripperd.bench.watchdog_bank import WatchdogBank
from gripperd.errors import InputError
from gripperd.protocol.encoding import Registers
from gripperd.protocol.modbus import Read, Refusal, Request, Table, WriteCoil
from gripperd.protocol.modules import OutputMap, RegisterMap

VERSION = 100
"""Firmware version of every simulated module, times 100."""


class RegisterDevice:
    """Everything that answers at one unit: a module, or several behind a coupler.

    Raises
    ------
    InputError
        A module has no registers, or two have the same.
    """

    def __init__(self, *modules: Outputs | Inputs) -> None:
        self.outputs = [each for each in modules if isinstance(each, Outputs)]
        self._banks: dict[Place, Bank] = {}
        for module in modules:
            for bank in _banks(module):
                self._add(bank, module.module.name)
        self._tables = {table for table, _ in self._banks}

    def answer(self, request: Request) -> Sequence[int] | Refusal:
        """Registers read, nothing for a write, or why not."""
        self._hear()
        places = _places(request)
        if places[0][0] not in self._tables:
            return Refusal.ILLEGAL_FUNCTION
        if not self._banks.keys() >= set(places):
            return Refusal.ILLEGAL_ADDRESS
        banks = list(dict.fromkeys(self._banks[place] for place in places))
        if isinstance(request, Read):
            return _read(banks, places)
        return _write(banks, dict(zip(places, _values(request), strict=True)))

    def _hear(self) -> None:
        for outputs in self.outputs:
            watched = outputs.module.modbus
            if watched and watched.watchdog and not watched.watchdog.keep:
                outputs.watchdog.hear()

    def _add(self, bank: Bank, name: str) -> None:
        for place in bank.places:
            if place in self._banks and self._banks[place] is not bank:
                where = Registers(*place)
                message = f"{name} shares {where} with another: give it a unit"
                raise InputError(message, key="unit")
            self._banks[place] = bank


def _places(request: Request) -> list[Place]:
    if isinstance(request, Read):
        table, count = request.table, request.count
    elif isinstance(request, WriteCoil):
        table, count = Table.COILS, 1
    else:
        table, count = Table.HOLDING, len(request.values)
    return [(table, request.address + n) for n in range(count)]


def _values(request: Request) -> Sequence[int]:
    if isinstance(request, Read):
        return ()
    return (int(request.on),) if isinstance(request, WriteCoil) else request.values


def _read(banks: Sequence[Bank], places: Sequence[Place]) -> Sequence[int] | Refusal:
    found: dict[Place, int] = {}
    for bank in banks:
        found.update(bank.read())
    if not found.keys() >= set(places):
        return Refusal.ILLEGAL_ADDRESS
    return [found[place] for place in places]


def _write(banks: Sequence[Bank], news: Words) -> Sequence[int] | Refusal:
    """All of it, or nothing."""
    shares: Mapping[Bank, Words] = {
        bank: {place: news[place] for place in bank.places if place in news}
        for bank in banks
    }
    for bank, share in shares.items():
        refusal = bank.check(share)
        if refusal is not None:
            return refusal
    for bank, share in shares.items():
        bank.write(share)
    return ()


def _banks(module: Outputs | Inputs) -> Iterator[Bank]:
    map_ = module.module.modbus
    if map_ is None:
        message = f"{module.module.name} does not speak modbus"
        raise InputError(message, key="module")
    if isinstance(module, Outputs):
        assert isinstance(map_, OutputMap)
        yield from _output_banks(module, map_)
    else:
        yield _measured(module, map_)
    if map_.range_code is not None:
        yield RangeCodes(map_.range_code, module.module, module.ranges, module.choose)
    if map_.required is not None:
        yield Format(map_.required)
    if map_.type_name is not None:
        yield Fixed(map_.type_name.registers, map_.type_name.code)
    if map_.version is not None:
        yield Fixed(map_.version, VERSION)
    if map_.status is not None and map_.status.registers is not None:
        channels = module.module.channels
        status = map_.status
        yield Statuses(map_.status.registers, status, channels, module.conditions)


def _output_banks(module: Outputs, map_: OutputMap) -> Iterator[Bank]:
    yield Outlets(module, map_)
    if map_.read_back != map_.values:
        back = module.currents if map_.echo else module.delivered
        yield Currents(map_.read_back, map_.encoding, module.ranges, back)
    if map_.safe is not None:
        yield SetPoints(
            map_.safe,
            map_.encoding,
            module.ranges,
            lambda: module.safe,
            module.safe.__setitem__,
        )
    if map_.watchdog is not None:
        yield WatchdogBank(map_.watchdog, module.watchdog)


def _measured(module: Inputs, map_: RegisterMap) -> Bank:
    status = map_.status
    if status is None or status.registers is not None:
        return Currents(map_.values, map_.encoding, module.ranges, module.currents)

    def marked(channel: int, current: float, word: int) -> int:
        said = module.condition(status, channel, current)
        return said if said in status.codes else word | said

    return Currents(map_.values, map_.encoding, module.ranges, module.currents, marked)
