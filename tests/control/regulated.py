"""Holds on the simulated rig, with other seeds, profiles and faults."""

from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise
from random import Random

from gripperd.bench.rig import Rig
from gripperd.bench.sensors import Sensor, SensorSettings
from gripperd.control.command import Status
from gripperd.control.profile import Mode, Profile
from gripperd.model import Chain
from gripperd.protocol.live_zero import LoopScale

from .stage import Stage, ordered, real

SPANS: Mapping[str, float] = {"pressure": 600e3, "opening": 0.1, "grip": 100.0}
NOISE = 5e-4


def stage(
    chain: Chain, seed: int = 1, plant: Chain | None = None, zero: float = 0.0
) -> Stage:
    """A rig under control, attached and enabled.

    The plant may differ from the model, and the force sensor be off by some newtons.
    """
    channels = {
        name: Sensor(LoopScale(value_low=0.0, value_high=span), NOISE)
        for name, span in SPANS.items()
    }
    off = LoopScale(value_low=-zero, value_high=SPANS["grip"] - zero)
    channels["grip"] = Sensor(off, NOISE)
    rig = Rig(plant or chain, Random(seed), sensors=SensorSettings(**channels))
    made = Stage(chain, rig, SPANS)
    made.run(0.1)
    return made


def holding(made: Stage, profile: Profile, *, compensate: bool = False) -> Stage:
    """The same with the object of a profile in its jaws, at the profile's force."""
    made.rig.plant.place(real(profile))
    order = ordered(replace(profile, compensate=compensate), Mode.FORCE)
    assert made.complete(order).status is Status.SUCCEEDED
    made.writes.clear()
    made.truth.clear()
    return made


def grips(made: Stage, since: float = 0.0) -> list[float]:
    """True grip force at every millisecond from a time on. [N]."""
    return [truth.grip for truth in made.truth if truth.time >= since]


def largest_step(made: Stage) -> float:
    """Largest change of the current between two writes. [A]."""
    currents = [current for _, current in made.writes]
    steps = (abs(after - before) for before, after in pairwise(currents))
    return max(steps, default=0.0)
