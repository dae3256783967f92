"""Faults of sensors, valve, air, jaws and part, in the time of the simulated rig."""

from collections.abc import Iterator, Mapping
from functools import partial

from gripperd.bench.faults import BenchFaults
from gripperd.bench.sensors import Channel
from gripperd.config import load_settings, shipped
from gripperd.control.monitors.policy import DETECTION, Cause
from gripperd.control.profile import Profile
from gripperd.model import Chain
from tests.control.monitors.watched import appeared, holding, noticed
from tests.control.stage import Stage
from tests.faults.row import Row

PATIENCE = 10.0
"""Of the simulated rig. [s]"""

BROKEN: tuple[tuple[str, Cause, BenchFaults], ...] = (
    ("pads on ice", Cause.SLIP, BenchFaults(pad_friction=0.0)),
    ("object torn at", Cause.SLIP, BenchFaults(pull=200.0)),
    ("supply sags", Cause.SUPPLY_SAG, BenchFaults(supply_pressure=80e3)),
    ("muscle leaks", Cause.LEAK, BenchFaults(leak_rate=8.0)),
    ("muscle bursts", Cause.BURST, BenchFaults(leak_rate=50.0)),
    ("valve is off", Cause.VALVE_NOT_FOLLOWING, BenchFaults(valve_offset=60e3)),
    *(
        (f"{channel.value} wire cut", Cause.SENSOR_FAILED, BenchFaults(broken=one))
        for channel in (Channel.PRESSURE, Channel.OPENING, Channel.GRIP)
        for one in (frozenset({channel}),)
    ),
    *(
        (f"{channel.value} frozen", Cause.SENSOR_FAILED, BenchFaults(frozen=one))
        for channel in (Channel.PRESSURE, Channel.OPENING, Channel.GRIP)
        for one in (frozenset({channel}),)
    ),
)
OBJECTS = ("apple", "peach", "raw_egg", "grape")


def rows() -> Iterator[Row]:
    """Each fault while each object is held."""
    settings = load_settings(shipped("gripperd.yaml"), {})
    (gripper,) = settings.grippers.values()
    held = partial(_held, gripper.chain, settings.profiles)
    for name, cause, broken in BROKEN:
        yield _row(name, cause, [_noticed(made, cause, broken) for made in held()])
    yield _row("object taken away", Cause.PART_LOST, [_taken(made) for made in held()])


def _held(chain: Chain, profiles: Mapping[str, Profile]) -> Iterator[Stage]:
    for profile in OBJECTS:
        yield holding(chain, profiles[profile])


def _noticed(made: Stage, cause: Cause, broken: BenchFaults) -> float:
    return noticed(made, cause, broken, PATIENCE)[0]


def _taken(made: Stage) -> float:
    made.rig.plant.remove()
    return appeared(made, Cause.PART_LOST, PATIENCE)[0]


def _row(name: str, cause: Cause, took: list[float]) -> Row:
    return Row(
        fault=name, noticed=cause.value, took=tuple(took), limit=DETECTION[cause]
    )
