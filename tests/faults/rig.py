"""Faults of sensors, valve, air, jaws and part, in the time of the simulated rig."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from functools import partial

from gripperd.bench.faults import HEALTHY, BenchFaults
from gripperd.bench.sensors import Channel
from gripperd.config import load_settings, shipped
from gripperd.control.command import Outcome
from gripperd.control.monitors.policy import DETECTION, POLICIES, Cause
from gripperd.control.profile import Mode, Profile
from gripperd.control.states import Grip, Machine
from gripperd.model import Chain
from gripperd.signals import Quality, Reading
from tests.control.monitors.watched import (
    SPANS,
    appeared,
    faults,
    holding,
    noticed,
    pressing,
    stage,
)
from tests.control.stage import Stage, ordered, real
from tests.faults.row import Row, counted

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
        for channel in Channel
        for one in (frozenset({channel}),)
    ),
    *(
        (f"{channel.value} wire shorted", Cause.SENSOR_FAILED, BenchFaults(shorted=one))
        for channel in Channel
        for one in (frozenset({channel}),)
    ),
    *(
        (f"{channel.value} frozen", Cause.SENSOR_FAILED, BenchFaults(frozen=one))
        for channel in Channel
        for one in (frozenset({channel}),)
    ),
)
OBJECTS = ("apple", "peach", "raw_egg", "grape")
SPIKES_WITHIN = 2.0
"""Longest until three spikes have come within a second, of ten in a second. [s]"""
SINGLE = 5
"""Wild samples of each sensor and object that come alone."""
WILD = 0.05
"""Share of the span by which a sample is wild. [-]"""
RIGHT = 6 * 5e-4
"""Share of the span within which a value is right: six sigma of the sensors. [-]"""
KEPT = 0.02
"""Share by which the force may differ. [-]"""

OTHER_SIZE = 0.012
"""How much another object differs from its profile, beyond every tolerance. [m]"""


def rows() -> Iterator[Row]:
    """Each fault while each object is held, then those of a motion."""
    settings = load_settings(shipped("gripperd.yaml"), {})
    (gripper,) = settings.grippers.values()
    chain, profiles = gripper.chain, settings.profiles
    held = partial(_held, chain, profiles)
    for name, cause, broken in BROKEN:
        yield _row(name, cause, [_noticed(made, cause, broken) for made in held()])
    for channel in Channel:
        yield spiking(held(), channel)
        yield single(held(), channel)
    yield _row("object taken away", Cause.PART_LOST, [_taken(made) for made in held()])
    egg, apple = profiles["raw_egg"], profiles["apple"]
    yield over_force(chain, egg)
    yield drift(chain, apple)
    yield deaf_valve(chain, [profiles[name] for name in OBJECTS])
    yield blocked(chain, [profiles[name] for name in OBJECTS])
    yield restarted(chain, [profiles[name] for name in OBJECTS])
    yield other_sizes(chain, [profiles[name] for name in OBJECTS])


def spiking(held: Iterable[Stage], channel: Channel) -> Row:
    """A sensor of which a tenth of the samples is wild, while an object is held."""
    took, wrong = [], set[str]()
    instead = Quality.SUBSTITUTED if channel is Channel.GRIP else Quality.BAD
    for made in held:
        force = made.rig.plant.grip
        broken = BenchFaults(spiking=frozenset({channel}))
        took.append(noticed(made, Cause.SENSOR_FAILED, broken, PATIENCE)[0])
        made.run(5.0)
        shown = _shown(made, channel)
        if shown.quality is not instead or "spikes" not in shown.cause:
            wrong.add(f"{shown.quality}: {shown.cause}")
        wrong |= _changed(made, force)
        if {fault.cause for fault in faults(made)} != {Cause.SENSOR_FAILED}:
            wrong.add("other faults")
    return Row(
        fault=f"{channel.value} spiking",
        noticed=f"{Cause.SENSOR_FAILED}: {instead}",
        took=tuple(took),
        limit=SPIKES_WITHIN,
        wrong=tuple(sorted(wrong)),
    )


def single(held: Iterable[Stage], channel: Channel, tries: int = SINGLE) -> Row:
    """One wild sample at a time: nothing comes of it, and nobody is shown it."""
    found = []
    for made in held:
        force = made.rig.plant.grip
        for _ in range(tries):
            made.rig.plant.faults = BenchFaults(spiking=frozenset({channel}))
            made.until(lambda: _wild(made, channel), 60.0)  # noqa: B023
            made.rig.plant.faults = HEALTHY
            shown = [_shown(made, channel)]
            for _ in range(3):
                made.tick()
                shown.append(_shown(made, channel))
            made.run(1.5)
            found += [
                f"shown as {each.quality}"
                for each in shown
                if each.quality is not Quality.SUBSTITUTED
                and not _right(made, channel, each)
            ] or ["not shown"]
            found += sorted(_changed(made, force))
            found += [each.message for each in faults(made)]
    return counted(f"{channel.value}: one wild sample", found, {"not shown"})


def _changed(made: Stage, force: float) -> set[str]:
    """What is not as it was when the object was held. [N]."""
    wrong = set[str]()
    if (made.state.machine, made.state.grip) != (Machine.READY, Grip.HOLDING):
        wrong.add(f"{made.state.machine}, {made.state.grip}")
    if abs(made.rig.plant.grip - force) > KEPT * force:
        wrong.add("another force")
    return wrong


def _shown(made: Stage, channel: Channel) -> Reading:
    """What a client is shown."""
    measured = made.state.measured
    assert measured is not None
    found: Reading = getattr(measured, channel.value)
    return found


def _wild(made: Stage, channel: Channel) -> bool:
    """Whether the modules said something wild just now."""
    said: Reading = getattr(made.raw, channel.value)
    return said.value is None or not _near(made, channel, said.value, WILD)


def _right(made: Stage, channel: Channel, shown: Reading) -> bool:
    return shown.value is not None and _near(made, channel, shown.value, RIGHT)


def _near(made: Stage, channel: Channel, value: float, share: float) -> bool:
    true: float = getattr(made.rig.plant, channel.value)
    return abs(value - true) <= share * SPANS[channel.value]


def over_force(chain: Chain, egg: Profile) -> Row:
    """The valve gives more than it is told, more than an egg can bear for long."""
    made = holding(chain, egg)
    took = _noticed(made, Cause.OVER_FORCE, BenchFaults(valve_offset=40e3))
    made.until(lambda: made.state.machine is Machine.FAULT)
    eased = egg.slip_force < made.rig.plant.grip < egg.damage_force / 1.3
    wrong = () if eased and made.peak() < egg.damage_force else ("not eased in time",)
    return _row("held too hard", Cause.OVER_FORCE, [took], wrong)


def drift(chain: Chain, apple: Profile) -> Row:
    """Less air gets lost than counts as a leak, and still the force goes away."""
    made = holding(chain, apple)
    took = _noticed(made, Cause.FORCE_DRIFT, BenchFaults(leak_rate=3.0))
    return _row("force goes away slowly", Cause.FORCE_DRIFT, [took])


def deaf_valve(chain: Chain, profiles: list[Profile]) -> Row:
    """The valve ignores a release."""
    took = []
    for profile in profiles:
        made = holding(chain, profile)
        made.rig.plant.faults = BenchFaults(valve_stuck=True)
        made.submit(None)
        took.append(appeared(made, Cause.VALVE_NOT_FOLLOWING, PATIENCE)[0])
    return _row("valve deaf to a release", Cause.VALVE_NOT_FOLLOWING, took)


def blocked(chain: Chain, profiles: list[Profile]) -> Row:
    """Something is jammed in the linkage when a grasp begins."""
    took, wrong = [], set[str]()
    for profile in profiles:
        made = stage(chain, 1)
        made.rig.plant.faults = BenchFaults(jaws_blocked=True)
        made.submit(ordered(profile, Mode.FORCE))
        pressing(made, POLICIES[Cause.JAW_BLOCKED].limit or 0.0, PATIENCE)
        took.append(appeared(made, Cause.JAW_BLOCKED, PATIENCE)[0])
        made.until(lambda: made.state.machine is Machine.FAULT)  # noqa: B023
        made.run(0.5)
        if made.rig.plant.pressure > 5e3:
            wrong.add("not let down")
    return _row("jaws blocked", Cause.JAW_BLOCKED, took, tuple(wrong))


def restarted(chain: Chain, profiles: list[Profile]) -> Row:
    """The output module is back at its power-on value, and must not be driven."""
    took, wrong = [], set[str]()
    for profile in profiles:
        made = holding(chain, profile)
        made.writes.clear()
        made.rig.write_current(0.0)
        took.append(appeared(made, Cause.MODULE_RESTARTED, PATIENCE)[0])
        made.run(3.0)
        if made.writes or made.state.machine is not Machine.FAULT:
            wrong.add("driven again")
    return _row("output module restarted", Cause.MODULE_RESTARTED, took, tuple(wrong))


def other_sizes(chain: Chain, profiles: list[Profile]) -> Row:
    """Objects that are not as their profile says: an outcome, and no fault."""
    found = []
    for profile in profiles:
        for differs, outcome in (
            (-OTHER_SIZE, Outcome.TOO_SMALL),
            (OTHER_SIZE, Outcome.TOO_LARGE),
        ):
            made = stage(chain, 1)
            size = profile.diameter + differs
            made.rig.plant.place(replace(real(profile), diameter=size))
            done = made.complete(ordered(profile, Mode.FORCE))
            good = done.result is not None and done.result.outcome is outcome
            calm = made.state.machine is Machine.READY and not faults(made)
            kept = made.state.grip is Grip.HOLDING
            found.append(outcome if good and calm and kept else f"{done.result}")
    allowed = (Outcome.TOO_SMALL, Outcome.TOO_LARGE)
    return counted("another size than the profile's, held lightly", found, allowed)


def _held(chain: Chain, profiles: Mapping[str, Profile]) -> Iterator[Stage]:
    for profile in OBJECTS:
        yield holding(chain, profiles[profile])


def _noticed(made: Stage, cause: Cause, broken: BenchFaults) -> float:
    return noticed(made, cause, broken, PATIENCE)[0]


def _taken(made: Stage) -> float:
    made.rig.plant.remove()
    return appeared(made, Cause.PART_LOST, PATIENCE)[0]


def _row(
    name: str, cause: Cause, took: list[float], wrong: tuple[str, ...] = ()
) -> Row:
    return Row(
        fault=name,
        noticed=cause.value,
        took=tuple(took),
        limit=DETECTION[cause],
        wrong=wrong,
    )
