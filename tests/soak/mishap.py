"""What happens to a grasp, at a moment that chance has chosen."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from random import Random

from gripperd.bench.faults import BenchFaults
from gripperd.bench.sensors import Channel
from gripperd.control.gripper import Gripper
from gripperd.errors import Refused
from tests.control.stage import Stage

Mishap = Callable[[Stage, Random], None]


def nothing(stage: Stage, rng: Random) -> None:
    pass


def stopped(stage: Stage, rng: Random) -> None:
    stage.stop()


def cancelled(stage: Stage, rng: Random) -> None:
    (newest,) = stage.gripper.ledger.newest(1)
    if not newest.final:
        stage.write(stage.gripper.cancel(newest.id, stage.instant))


def asked_twice(stage: Stage, rng: Random) -> None:
    """Somebody else wants the same thing: refused, or queued and refused later."""
    (newest,) = stage.gripper.ledger.newest(1)
    try:
        stage.submit(newest.order)
    except Refused:
        return


def control_killed(stage: Stage, rng: Random) -> None:
    """A new life on the same hardware, after some time without any."""
    stage.pass_time(rng.uniform(0.1, 3.0))
    ids = iter(range(1000, 2000))
    stage.gripper = Gripper(
        "g0", stage.chain, auto_enable=True, identify=lambda: f"c{next(ids)}"
    )


def loop_stalled(stage: Stage, rng: Random) -> None:
    stage.tick(rng.uniform(0.05, 5.0))


def link_lost(stage: Stage, rng: Random) -> None:
    stage.gripper.link_lost("cut", stage.instant)
    stage.pass_time(rng.uniform(0.01, 2.0))


def foreign_write(stage: Stage, rng: Random) -> None:
    """Another master sets a little more; the program must not fight over it."""
    stage.rig.write_current(stage.rig.plant.current + 0.1e-3)


def faulty(change: Callable[[BenchFaults, Random], BenchFaults]) -> Mishap:
    def happen(stage: Stage, rng: Random) -> None:
        stage.rig.plant.faults = change(stage.rig.plant.faults, rng)

    return happen


def pulled_out(stage: Stage, rng: Random) -> None:
    stage.rig.plant.remove()


HARMLESS: Mapping[str, Mishap] = {
    "nothing": nothing,
    "stop": stopped,
    "cancel": cancelled,
    "a second command": asked_twice,
    "control killed": control_killed,
    "loop stalled": loop_stalled,
    "link lost": link_lost,
    "foreign write": foreign_write,
    "valve offset": faulty(
        lambda faults, rng: replace(faults, valve_offset=rng.uniform(-10e3, 20e3))
    ),
    "slow leak": faulty(
        lambda faults, rng: replace(faults, leak_rate=rng.uniform(0.0, 1 / 66))
    ),
    "linkage friction": faulty(
        lambda faults, rng: replace(faults, jaw_friction=rng.uniform(0.0, 1.0))
    ),
    "valve stuck": faulty(lambda faults, rng: replace(faults, valve_stuck=True)),
    "jaws blocked": faulty(lambda faults, rng: replace(faults, jaws_blocked=True)),
    "sensor broken": faulty(
        lambda faults, rng: replace(
            faults, broken=frozenset({rng.choice(list(Channel)[:3])})
        )
    ),
    "sensor frozen": faulty(
        lambda faults, rng: replace(
            faults, frozen=frozenset({rng.choice(list(Channel)[:3])})
        )
    ),
}
"""While these happen there is air and power, so nothing may fall."""

LOSING: Mapping[str, Mishap] = {
    "pulled out": pulled_out,
    "air lost": faulty(lambda faults, rng: replace(faults, supply_pressure=0.0)),
    "muscle burst": faulty(lambda faults, rng: replace(faults, leak_rate=50.0)),
    "pads on ice": faulty(lambda faults, rng: replace(faults, pad_friction=0.05)),
    "torn at": faulty(lambda faults, rng: replace(faults, pull=200.0)),
}
"""These take the object away, and the loss must be told."""
