"""Asking a line who is there. Only reads, and never longer than was said."""

import asyncio
from collections import Counter
from collections.abc import Awaitable, Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Protocol, TypeAlias, TypeVar

from gripperd.doctor.attempt import Attempt
from gripperd.doctor.fit import identify
from gripperd.doctor.identity import (
    AnyModule,
    Certainty,
    Identity,
    Match,
    matched,
    named,
)
from gripperd.drivers.address import (
    Address,
    DconAddress,
    ItvAddress,
    RtuAddress,
    TcpAddress,
)
from gripperd.drivers.bus import Bus, DconBus, ItvBus, ModbusBus, open_bus
from gripperd.drivers.registers import Unit
from gripperd.errors import (
    BadReply,
    DeviceRefused,
    LinkError,
    LinkLost,
    LocalEcho,
    ReplyTimeout,
)
from gripperd.protocol.engineering import from_engineering
from gripperd.protocol.itv import Query
from gripperd.protocol.modbus import Read, Refusal, Table
from gripperd.protocol.modules import OutputModule
from gripperd.protocol.phrase import CURRENT, Phrase

OPEN_WITHIN = 1.0
"""Longest wait for a line to open, beyond its own time-out. [s]"""
ANY_NAME = "!{unit}"
"""What goes before the name in a reply."""
NOBODY = frozenset({Refusal.NO_PATH, Refusal.NO_RESPONSE})
"""What a gateway says of a unit that is not there."""

Q = TypeVar("Q")
R = TypeVar("R")

Look: TypeAlias = Callable[
    [Bus[Q, R], int, Sequence[AnyModule]], Awaitable[Identity | None]
]
"""Identity of a unit; None where nobody is."""


@dataclass(frozen=True, slots=True)
class Found:
    """Something that answers."""

    address: Address
    unit: int
    identity: Identity


class Opening(Protocol):
    """A bus, as far as waiting for it goes."""

    address: Address
    up: asyncio.Event


class Probe:
    """Tries one way of asking after another.

    Parameters
    ----------
    modules
        Every description that is known.
    tell
        Is told what is tried, and the share that is done.
    """

    def __init__(
        self, modules: Sequence[AnyModule], tell: Callable[[str, float], None]
    ) -> None:
        self._modules = modules
        self._tell = tell
        self.notes: list[str] = []
        """What was odd on the way."""

    async def search(self, attempts: Iterable[Attempt]) -> list[Found]:
        """Everything that answers the first attempt that anybody answers.

        Raises
        ------
        LinkLost
            The line does not open.
        """
        planned = list(attempts)
        for place, attempt in enumerate(planned):
            self._tell(str(attempt), place / len(planned))
            try:
                found = await self._ask(attempt)
            except LocalEcho:
                self.notes.append(f"{attempt}: the line echoes what is sent on it")
                echoing = replace(attempt, address=_echoing(attempt.address))
                found = await self._ask(echoing)
            if found:
                return found
        return []

    async def _ask(self, attempt: Attempt) -> list[Found]:
        match attempt.address:
            case TcpAddress() | RtuAddress() as address:
                async with open_bus(address) as modbus:
                    return await self._each(attempt, modbus, _over_modbus)
            case DconAddress() as address:
                async with open_bus(address) as dcon:
                    return await self._each(attempt, dcon, _over_dcon)
            case ItvAddress() as address:
                async with open_bus(address) as itv:
                    return await self._each(attempt, itv, _over_itv)

    async def _each(
        self, attempt: Attempt, bus: Bus[Q, R], look: Look[Q, R]
    ) -> list[Found]:
        found = []
        await opened(bus)
        for unit in attempt.units:
            try:
                identity = await look(bus, unit, self._modules)
            except LocalEcho:
                raise
            except LinkError as error:
                await self._recover(bus, error)
                continue
            if identity is not None:
                found.append(Found(attempt.address, unit, identity))
        return found

    async def _recover(self, bus: Bus[Q, R], error: LinkError) -> None:
        """Note what is more than silence, and wait until the line is open again."""
        await opened(bus)
        if isinstance(error, LinkLost) and not bus.up.is_set():
            raise error
        if not isinstance(error, ReplyTimeout):
            self.notes.append(str(error))


async def opened(bus: Opening) -> None:
    """Return when the line is open, or has had its time: then the next request says."""
    with suppress(TimeoutError):
        async with asyncio.timeout(bus.address.timeout + OPEN_WITHIN):
            await bus.up.wait()


async def _over_modbus(
    bus: ModbusBus, number: int, modules: Sequence[AnyModule]
) -> Identity | None:
    try:
        await bus.ask(Read(number, Table.HOLDING, 0))
    except DeviceRefused as error:
        if error.exception_code in NOBODY:
            return None
    return await identify(Unit(bus, number), modules)


async def _over_dcon(
    bus: DconBus, unit: int, modules: Sequence[AnyModule]
) -> Identity | None:
    """Ask for the name in every way described, and without one what it puts out."""
    said = None
    for ask in _names(modules):
        # The first that nobody answers ends it: nobody is there.
        question = Phrase(ask, ANY_NAME).question(unit, {}, None)
        try:
            said = (await bus.ask(question)).strip()
        except DeviceRefused:
            continue
        if bearing := tuple(_bearing(ask, said, modules)):
            return named(said, bearing)
    return await _nameless(bus, unit, modules) if said is None else named(said, ())


def _names(modules: Sequence[AnyModule]) -> Sequence[str]:
    """Questions for a name, that of most modules first."""
    asks = Counter(
        phrases.type_name.ask
        for module in modules
        for phrases in module.phrases.values()
        if phrases.type_name is not None
    )
    return [ask for ask, _ in asks.most_common()]


def _bearing(ask: str, said: str, modules: Sequence[AnyModule]) -> Iterator[AnyModule]:
    for module in modules:
        for phrases in module.phrases.values():
            if phrases.type_name == Phrase(ask, f"{ANY_NAME}{said}"):
                yield module


async def _nameless(bus: DconBus, unit: int, modules: Sequence[AnyModule]) -> Identity:
    """Whose read-back is understood; a line to an input could move an output."""
    answered = []
    for module in modules:
        spoken = module.phrases.values() if isinstance(module, OutputModule) else ()
        for phrases in spoken:
            filled = {"unit": f"{unit:02X}", "channel": "0"}
            question = phrases.read_back.question(unit, filled, CURRENT)
            try:
                said = phrases.read_back.value(await bus.ask(question), filled)
                from_engineering(said)
            except (DeviceRefused, BadReply):
                continue
            answered.append(Match(module, ()))
    found = matched(answered)
    return replace(found, grounds=f"it tells no name; {found.grounds}")


async def _over_itv(
    bus: ItvBus, unit: int, modules: Sequence[AnyModule]
) -> Identity | None:
    try:
        pressure, aim = [await bus.ask(query) for query in Query]
    except DeviceRefused:
        return Identity(Certainty.UNKNOWN, (), "it knows no MON and no REQ")
    regulators = tuple(
        each for each in modules if isinstance(each, OutputModule) and each.itv
    )
    grounds = f"MON and REQ answer {pressure} and {aim}"
    return Identity(Certainty.LIKELY, regulators, grounds)


def _echoing(address: Address) -> Address:
    if isinstance(address, RtuAddress | DconAddress):
        return replace(address, local_echo=True)
    return address
