"""The simulated bench: put objects between the jaws, break things."""

# ruff: noqa: N815  (names carry units, and units have capitals)

from collections.abc import Mapping
from typing import Annotated

from pydantic import Field

from gripperd.bench.contacts import Contact
from gripperd.bench.faults import HEALTHY, BenchFaults
from gripperd.bench.object import BenchObject
from gripperd.bench.placed import ObjectState
from gripperd.bench.sensors import Channel
from gripperd.config.section import Section
from gripperd.errors import InputError, NotFound
from gripperd.link.bench import (
    BenchState,
    MendWire,
    PlacedState,
    PlaceObject,
    ReadBench,
    RemoveObject,
    Request,
    SetFaults,
)
from gripperd.service.body import router
from gripperd.service.context import Context, Daemon
from gripperd.service.rendering import GIVEN, Document, known, to
from gripperd.service.target import Millimetres
from gripperd.service.wire_faults import (
    WireFaultsDocument,
    WireFaultsRequest,
    wire_faults,
)
from gripperd.units import SI_PER_UNIT, split

routes = router("bench")

MODBUS_TCP = "modbus_tcp"
"""The line that has a host and a port."""

Wired = Annotated[Channel, Field(strict=False)]
Opened = Annotated[Contact, Field(strict=False)]


class ObjectRequest(Section):
    """An object as a profile describes it, or one of its own."""

    profile: str | None = Field(
        default=None, description="Where the other values come from."
    )
    diameter_mm: Millimetres | None = None
    stiffness_N_per_mm: float | None = Field(default=None, gt=0, le=100_000)
    mass_g: float | None = Field(default=None, gt=0, le=100_000)
    friction: float | None = Field(default=None, gt=0, le=5)
    damage_force_N: float | None = Field(default=None, gt=0, le=100_000)


class FaultsRequest(Section):
    """Everything that is to be wrong; what is left out is in order."""

    supply_kPa: float | None = Field(
        default=None,
        ge=0,
        le=2000,
        description="Gauge pressure left before the regulator.",
    )
    valve_offset_kPa: float = Field(default=0, ge=-2000, le=2000)
    leak_per_s: float = Field(
        default=0, ge=0, le=1000, description="50 for a burst muscle."
    )
    valve_stuck: bool = Field(default=False, description="Deaf to the current.")
    jaw_friction_N: float = Field(default=0, ge=0, le=100_000)
    jaws_blocked: bool = Field(default=False, description="Jammed both ways.")
    pad_friction: float = Field(
        default=1, ge=0, le=1, description="Share of the friction that is left."
    )
    pull_N: float = Field(
        default=0, ge=0, le=100_000, description="On the object, besides its weight."
    )
    broken: list[Wired] = Field(default=[], description="Sensors whose wire is cut.")
    shorted: list[Wired] = Field(
        default=[], description="Sensors whose wire touches the supply."
    )
    frozen: list[Wired] = Field(
        default=[], description="Sensors that repeat themselves."
    )
    spiking: list[Wired] = Field(
        default=[], description="Sensors with a wild sample now and then."
    )
    opened: list[Opened] = Field(
        default=[],
        description="Open contacts: no enable, the emergency stop is pressed.",
    )


class FaultsDocument(Document):
    """What is wrong with the bench."""

    supply_kPa: float | None
    valve_offset_kPa: float
    leak_per_s: float
    valve_stuck: bool
    jaw_friction_N: float
    jaws_blocked: bool
    pad_friction: float
    pull_N: float
    broken: tuple[Channel, ...]
    shorted: tuple[Channel, ...]
    frozen: tuple[Channel, ...]
    spiking: tuple[Channel, ...]
    opened: tuple[Contact, ...]


class ObjectDocument(Document):
    """What is between the jaws, and what has become of it."""

    diameter_mm: float
    stiffness_N_per_mm: float
    mass_g: float
    friction: float
    damage_force_N: float
    state: ObjectState
    cracked: bool


class BenchDocument(Document):
    """The truth, which no sensor blurs."""

    time_s: float
    current_mA: float
    pressure_kPa: float
    opening_mm: float
    force_N: float = Field(description="Grip force per jaw.")
    object: ObjectDocument | None
    faults: FaultsDocument
    wire_faults: WireFaultsDocument
    modbus_tcp: str | None = Field(
        description="Where its modules listen; null where they are on a serial line."
    )
    line: str = Field(description="What they speak.")
    address: str = Field(description="Where they speak it.")


@routes.get("/bench")
async def read_bench(daemon: Daemon) -> BenchDocument:
    """The simulated rig as it is."""
    return await _asked(daemon, ReadBench())


@routes.put("/bench/object")
async def place_object(daemon: Daemon, given: ObjectRequest) -> BenchDocument:
    """Put an object between the jaws, in place of what is there."""
    described = _described(given.profile, daemon)
    own = given.model_dump(exclude={"profile"}, exclude_none=True)
    values = {**described, **{split(key)[0]: _si(key, own[key]) for key in own}}
    return await _asked(daemon, PlaceObject(_object(values)))


@routes.delete("/bench/object")
async def remove_object(daemon: Daemon) -> BenchDocument:
    """Pull out what is between the jaws."""
    return await _asked(daemon, RemoveObject())


@routes.put("/bench/faults")
async def set_faults(daemon: Daemon, given: FaultsRequest) -> BenchDocument:
    """Break these things and mend all others."""
    supply = given.supply_kPa
    faults = BenchFaults(
        supply_pressure=None if supply is None else _si("supply_kPa", supply),
        valve_offset=_si("valve_offset_kPa", given.valve_offset_kPa),
        leak_rate=given.leak_per_s,
        valve_stuck=given.valve_stuck,
        jaw_friction=given.jaw_friction_N,
        jaws_blocked=given.jaws_blocked,
        pad_friction=given.pad_friction,
        pull=given.pull_N,
        broken=frozenset(given.broken),
        shorted=frozenset(given.shorted),
        frozen=frozenset(given.frozen),
        spiking=frozenset(given.spiking),
        opened=frozenset(given.opened),
    )
    return await _asked(daemon, SetFaults(faults))


@routes.delete("/bench/faults")
async def mend(daemon: Daemon) -> BenchDocument:
    """Mend everything."""
    return await _asked(daemon, SetFaults(HEALTHY))


@routes.put("/bench/wire-faults")
async def set_wire_faults(daemon: Daemon, given: WireFaultsRequest) -> BenchDocument:
    """Say what the next requests on the wire meet, in place of what was said."""
    return await _asked(daemon, given.request)


@routes.delete("/bench/wire-faults")
async def mend_wire(daemon: Daemon) -> BenchDocument:
    """Let every request go well, and join a wire that was cut."""
    return await _asked(daemon, MendWire())


async def _asked(daemon: Context, request: Request) -> BenchDocument:
    return _document(await daemon.simulated.ask(request, BenchState))


def _si(key: str, value: float) -> float:
    unit = split(key)[1]
    return value * SI_PER_UNIT[unit] if unit else value


def _described(name: str | None, daemon: Context) -> Mapping[str, float]:
    if name is None:
        return {}
    try:
        profile = daemon.library.get(name)
    except NotFound as error:
        raise InputError(str(error), key="profile") from error
    return {
        "diameter": profile.diameter,
        "stiffness": profile.stiffness,
        "mass": profile.mass,
        "friction": profile.pad_friction,
        "damage_force": profile.damage_force,
    }


def _object(values: Mapping[str, float]) -> BenchObject:
    for key in ObjectRequest.model_fields:
        if key != "profile" and split(key)[0] not in values:
            message = f"{key} is missing, and no profile is named to take it from"
            raise InputError(message, key=key)
    return BenchObject(**values)


def _document(state: BenchState) -> BenchDocument:
    return BenchDocument(
        time_s=to("s", state.time, GIVEN),
        current_mA=to("mA", state.current),
        pressure_kPa=to("kPa", state.pressure),
        opening_mm=to("mm", state.opening),
        force_N=to("N", state.grip),
        object=_placed(state.placed) if state.placed else None,
        faults=_faults(state.faults),
        wire_faults=wire_faults(state),
        modbus_tcp=state.address if state.line == MODBUS_TCP else None,
        line=state.line,
        address=state.address,
    )


def _placed(placed: PlacedState) -> ObjectDocument:
    kind = placed.kind
    return ObjectDocument(
        diameter_mm=to("mm", kind.diameter, GIVEN),
        stiffness_N_per_mm=to("N_per_mm", kind.stiffness, GIVEN),
        mass_g=to("g", kind.mass, GIVEN),
        friction=kind.friction,
        damage_force_N=to("N", kind.damage_force, GIVEN),
        state=placed.state,
        cracked=placed.cracked,
    )


def _faults(faults: BenchFaults) -> FaultsDocument:
    return FaultsDocument(
        supply_kPa=known("kPa", faults.supply_pressure, GIVEN),
        valve_offset_kPa=to("kPa", faults.valve_offset, GIVEN),
        leak_per_s=faults.leak_rate,
        valve_stuck=faults.valve_stuck,
        jaw_friction_N=faults.jaw_friction,
        jaws_blocked=faults.jaws_blocked,
        pad_friction=faults.pad_friction,
        pull_N=faults.pull,
        broken=tuple(sorted(faults.broken)),
        shorted=tuple(sorted(faults.shorted)),
        frozen=tuple(sorted(faults.frozen)),
        spiking=tuple(sorted(faults.spiking)),
        opened=tuple(sorted(faults.opened)),
    )
