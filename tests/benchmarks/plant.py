"""The simulated rig against real time."""

import time
from math import pi, sin
from random import Random

from rich.table import Table

from gripperd.bench.object import BenchObject
from gripperd.bench.rig import STEP, Rig
from gripperd.config import reference_chain

APPLE = BenchObject(
    diameter=0.065, stiffness=40e3, mass=0.18, friction=0.5, damage_force=90
)
SECONDS = 20.0


def grasping(t: float) -> float:
    """Ramp, hold, open: 10 s a cycle. [A]."""
    t %= 10
    return 0.004 + 0.0067 * min(t / 2, 1.0) if t < 8 else 0.004


def swinging(t: float) -> float:
    """Never at rest. [A]."""
    return 0.009 + 0.003 * sin(2 * pi * 0.5 * t)


def speed(current: "object", rig: Rig) -> float:
    """Simulated time per time. [-]."""
    assert callable(current)
    start = time.perf_counter()
    for period in range(int(SECONDS / 0.01)):
        rig.write_current(current(period * 0.01))
        rig.advance(period * 0.01)
        rig.read_inputs()
    return SECONDS / (time.perf_counter() - start)


def table() -> Table:
    found = Table(f"rig, {STEP * 1e3:g} ms steps", "times real time", "goal")
    for name, current in (("grasp, hold, open", grasping), ("always moving", swinging)):
        rig = Rig(reference_chain(), Random(1))
        rig.plant.place(APPLE)
        found.add_row(name, f"{speed(current, rig):,.0f}x", ">= 300x")
    return found
