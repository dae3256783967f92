"""What the service asks of the simulated rig, past its wire."""

from dataclasses import dataclass
from typing import TypeAlias

import msgspec

from gripperd.bench.faults import BenchFaults
from gripperd.bench.object import BenchObject
from gripperd.bench.placed import ObjectState
from gripperd.bench.rig import Rig
from gripperd.bench.server import BenchServer
from gripperd.bench.wire_faults import WireFault
from gripperd.link.frames import decode


@dataclass(frozen=True, slots=True, kw_only=True)
class PlacedState:
    """The object between the jaws and what has become of it."""

    kind: BenchObject
    state: ObjectState
    cracked: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class BenchState:
    """The truth of the simulated rig, which no sensor blurs. SI values."""

    time: float
    """Bench time since it was started. [s]"""
    current: float
    """What the output module drives. [A]"""
    pressure: float
    opening: float
    grip: float
    """Grip force per jaw. [N]"""
    placed: PlacedState | None
    faults: BenchFaults
    address: str
    """Where its modules listen."""
    line: str
    """What they speak there."""
    wire_faults: tuple[WireFault, ...]
    """Those that no request has met yet."""
    wire_fault_chance: float
    """Probability of one at random once none waits. [-]"""


class ReadBench(msgspec.Struct, frozen=True, tag=True):
    """Ask for the :class:`BenchState`; so do all the others, when done."""


class PlaceObject(msgspec.Struct, frozen=True, tag=True):
    """Put an object between the open jaws, in place of what was there."""

    kind: BenchObject


class RemoveObject(msgspec.Struct, frozen=True, tag=True):
    """Pull out what is between the jaws."""


class SetFaults(msgspec.Struct, frozen=True, tag=True):
    """Break or mend the rig."""

    faults: BenchFaults


class SetWireFaults(msgspec.Struct, frozen=True, tag=True):
    """Say what the next requests on the wire meet, in place of what was said."""

    faults: tuple[WireFault, ...]
    chance: float = 0.0


class MendWire(msgspec.Struct, frozen=True, tag=True):
    """Let no request meet a fault any more, and join a wire that was cut."""


Request: TypeAlias = (
    ReadBench | PlaceObject | RemoveObject | SetFaults | SetWireFaults | MendWire
)


class BenchDesk:
    """Answers the service on behalf of the rig."""

    def __init__(self, server: BenchServer, rig: Rig) -> None:
        self._server = server
        self._rig = rig

    async def respond(self, body: msgspec.Raw) -> BenchState:
        """Do what one request asks for."""
        request: Request = decode(body, Request)  # type: ignore[arg-type]
        self._server.catch_up()
        plant = self._rig.plant
        match request:
            case PlaceObject(kind):
                plant.check_fits(kind)
                plant.remove()
                plant.place(kind)
            case RemoveObject():
                plant.remove()
            case SetFaults(faults):
                plant.faults = faults
            case SetWireFaults(waiting, chance):
                self._server.faults.set(waiting, chance)
            case MendWire():
                self._server.faults.set(())
                self._server.modules.mend()
            case ReadBench():
                pass
        return self._state()

    def _state(self) -> BenchState:
        plant = self._rig.plant
        placed = None
        if plant.placed is not None:
            there = plant.placed
            placed = PlacedState(
                kind=there.kind, state=there.state, cracked=there.cracked
            )
        return BenchState(
            time=plant.time,
            current=plant.current,
            pressure=plant.pressure,
            opening=plant.opening,
            grip=plant.grip,
            placed=placed,
            faults=plant.faults,
            address=self._server.address,
            line=self._server.speaker.name,
            wire_faults=tuple(self._server.faults.waiting),
            wire_fault_chance=self._server.faults.chance,
        )
