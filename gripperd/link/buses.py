"""What can be asked of the control process about its buses."""

from collections.abc import Mapping
from typing import TypeAlias

import msgspec

from gripperd.drivers.analog import AnyBus
from gripperd.drivers.statistics import LATENCY_BOUNDS
from gripperd.drivers.traffic import Heard, Traffic
from gripperd.errors import NotFound


class BusFigures(msgspec.Struct, frozen=True, kw_only=True):
    """What has happened on one bus since control was started."""

    name: str
    """Its address, as in the settings; that of the bench where it listens."""
    grippers: tuple[str, ...]
    """Those on it."""
    up: bool
    """Whether the line is open."""
    requests: int
    connections: int
    """Times that the line was opened."""
    discarded: int
    """Octets that belong to no reply that somebody waited for."""
    errors: dict[str, int]
    """By the name of the error; ``connect`` is a failed attempt to open the line."""
    latency_bounds: tuple[float, ...] = LATENCY_BOUNDS
    """Upper bounds of the classes of latency. [s]"""
    latency_counts: tuple[int, ...]
    """Replies in each class; the last is above every bound."""
    latency_total: float
    """Sum of all latencies. [s]"""


class ReadBuses(msgspec.Struct, frozen=True, tag=True):
    """Ask for a list of :class:`BusFigures`."""


class ReadTraffic(msgspec.Struct, frozen=True, tag=True):
    """Ask for a list of :class:`Heard`: what came after one, on a gripper's bus.

    Who has not asked for a while begins anew, with an empty list.
    """

    gripper: str
    after: int = 0


Request: TypeAlias = ReadBuses | ReadTraffic


class BusDesk:
    """Answers for the buses.

    Parameters
    ----------
    buses
        The bus of each gripper; several may share one.
    """

    def __init__(self, buses: Mapping[str, AnyBus]) -> None:
        self._buses = buses
        self._traffic = {id(bus): Traffic(bus) for bus in buses.values()}

    def respond(self, request: Request) -> object:
        """Do what one request asks for."""
        if isinstance(request, ReadBuses):
            owned = {id(bus): bus for bus in self._buses.values()}
            return [self._figures(bus) for bus in owned.values()]
        bus = self._buses.get(request.gripper)
        if bus is None:
            known = ", ".join(self._buses)
            message = f"there is no gripper {request.gripper!r}; there is {known}"
            raise NotFound(message, key="gripper")
        heard: tuple[Heard, ...] = self._traffic[id(bus)].since(request.after)
        return heard

    def _figures(self, bus: AnyBus) -> BusFigures:
        seen = bus.statistics.snapshot()
        return BusFigures(
            name=str(bus.address),
            grippers=tuple(name for name, each in self._buses.items() if each is bus),
            up=bus.up.is_set(),
            requests=seen.requests,
            connections=seen.connections,
            discarded=seen.discarded,
            errors=dict(seen.errors),
            latency_counts=seen.latency_counts,
            latency_total=seen.latency_total,
        )
