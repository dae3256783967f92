"""Stages whose faults are of interest."""

from collections.abc import Callable, Mapping
from random import Random

from gripperd.bench.faults import BenchFaults
from gripperd.bench.rig import Rig
from gripperd.bench.sensors import Sensor, SensorSettings
from gripperd.control.command import Status
from gripperd.control.fault import Fault
from gripperd.control.monitors.policy import AS_SHIPPED, Cause, Monitoring
from gripperd.control.profile import Mode, Profile
from gripperd.model import Chain
from gripperd.protocol.live_zero import LoopScale
from tests.control.stage import Stage, ordered, real

SPANS: Mapping[str, float] = {"pressure": 600e3, "opening": 0.1, "grip": 100.0}


def stage(chain: Chain, seed: int, monitoring: Monitoring = AS_SHIPPED) -> Stage:
    """The shipped rig, attached and enabled."""
    channels = {
        name: Sensor(LoopScale(value_low=0.0, value_high=span), 5e-4)
        for name, span in SPANS.items()
    }
    rig = Rig(chain, Random(seed), sensors=SensorSettings(**channels))
    made = Stage(chain, rig, SPANS, monitoring)
    made.run(0.1)
    return made


def holding(
    chain: Chain,
    profile: Profile,
    seed: int = 1,
    monitoring: Monitoring = AS_SHIPPED,
) -> Stage:
    """The same, holding something for two seconds without any fault."""
    made = stage(chain, seed, monitoring)
    made.rig.plant.place(real(profile))
    assert made.complete(ordered(profile, Mode.FORCE)).status is Status.SUCCEEDED
    made.run(2.0)
    assert faults(made) == []
    return made


def faults(made: Stage) -> list[Fault]:
    """Every fault so far, oldest first."""
    return made.gripper.faults.newest(100)[::-1]


def causes(made: Stage) -> set[Cause]:
    """What has gone wrong so far."""
    return {fault.cause for fault in faults(made)}


def noticed(
    made: Stage, cause: Cause, broken: BenchFaults, within: float
) -> tuple[float, Fault]:
    """Break the bench; how long it takes until that is noticed, and as what."""
    made.rig.plant.faults = broken
    return appeared(made, cause, within)


def appeared(made: Stage, cause: Cause, within: float) -> tuple[float, Fault]:
    """How long it takes from now until a fault is raised, and the fault."""
    start = made.now
    found: Callable[[], list[Fault]] = lambda: [  # noqa: E731
        fault for fault in faults(made) if fault.cause is cause
    ]
    made.until(lambda: bool(found()), within)
    return made.now - start, found()[0]


def pressing(made: Stage, force: float, within: float) -> None:
    """Wait until the jaws ought to press with a force, by the pressure there is. [N]"""
    plant = made.rig.plant
    ought: Callable[[], float] = lambda: float(  # noqa: E731
        made.chain.grip_at(plant.pressure, plant.opening)
    )
    made.until(lambda: ought() > force, within)
