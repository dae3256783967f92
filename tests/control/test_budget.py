from collections.abc import Mapping
from dataclasses import replace
from math import exp, inf, log

import pytest

from gripperd.bench.faults import BenchFaults
from gripperd.bench.sensors import Channel
from gripperd.control.budget import (
    WORST_LEAK,
    Budget,
    Cause,
    FailMode,
    budget,
)
from gripperd.control.profile import Profile
from gripperd.effects.creep import Creep
from gripperd.effects.leak import Leak
from gripperd.model import Chain, StaticMuscle

from .regulated import holding, stage
from .stage import Stage

Profiles = Mapping[str, Profile]
NAMES = ("apple", "peach", "raw_egg", "grape")


def of(made: Stage, chain: Chain, fail_mode: FailMode) -> Budget:
    state = made.state
    assert state.held is not None
    assert state.measured is not None
    found = budget(state.held, state.measured, chain, fail_mode=fail_mode)
    assert found is not None
    return found


def time_to_slip(made: Stage, profile: Profile, step: float) -> float:
    """How long the bench takes until the grip is under the slip limit. [s]."""
    start = made.now
    while made.rig.plant.grip > profile.slip_force:
        assert made.now < start + 120.0
        made.pass_time(step)
    return made.now - start


@pytest.mark.parametrize("name", NAMES)
def test_trapped_air_lasts_as_long_as_said_and_at_most_two_seconds_longer(
    chain: Chain, profiles: Profiles, name: str
) -> None:
    # The friction of the braid, which the budget does not count on, gives the rest.
    profile = profiles[name]
    made = holding(stage(chain, 3), profile)
    said = of(made, chain, FailMode.FREEZE)
    made.rig.plant.faults = BenchFaults(tube_shut=True, leak_rate=1 / 66)
    real = time_to_slip(made, profile, 0.05)
    assert said.air == said.power
    assert said.limited_by is Cause.LEAK
    assert said.air <= real <= said.air + 2.0


@pytest.mark.parametrize("name", NAMES)
def test_a_muscle_that_vents_lasts_as_long_as_said_and_at_most_40_ms_longer(
    chain: Chain, profiles: Profiles, name: str
) -> None:
    profile = profiles[name]
    made = holding(stage(chain, 3), profile)
    said = of(made, chain, FailMode.VENT)
    made.rig.plant.faults = BenchFaults(supply_pressure=0.0)
    real = time_to_slip(made, profile, 0.001)
    assert said.limited_by is Cause.VENT
    assert said.air <= real <= said.air + 0.040


def test_without_a_bus_the_regulator_goes_on_holding(
    chain: Chain, profiles: Profiles
) -> None:
    made = holding(stage(chain), profiles["apple"])
    assert of(made, chain, FailMode.FREEZE).bus == inf
    made.gripper.link_lost("cut", made.instant)
    made.pass_time(60.0)
    assert made.rig.plant.grip > profiles["apple"].slip_force


def test_a_spring_that_closes_holds_for_ever(chain: Chain, profiles: Profiles) -> None:
    made = holding(stage(chain), profiles["apple"])
    said = of(made, chain, FailMode.SPRING_CLOSE)
    assert (said.air, said.power, said.limited_by) == (inf, inf, None)


def test_the_leak_of_the_model_counts_instead_of_the_worst_one(
    chain: Chain, profiles: Profiles
) -> None:
    made = holding(stage(chain), profiles["apple"])
    worst = of(made, chain, FailMode.FREEZE)
    tight = replace(chain, effects=(Leak(rate=WORST_LEAK / 10, early=0.0),))
    known = of(made, tight, FailMode.FREEZE)
    assert known.air == pytest.approx(10 * worst.air, rel=0.01)
    assert known.bus == pytest.approx(known.air)
    droops = replace(chain, effects=(Leak(rate=WORST_LEAK, early=0.05),))
    lost = -66 * log(1 - 0.05)
    assert of(made, droops, FailMode.FREEZE).bus == pytest.approx(
        worst.air - lost, rel=0.02
    )


def test_air_that_goes_with_the_square_of_its_pressure_lasts_longer_below_300_kpa(
    chain: Chain, profiles: Profiles
) -> None:
    made = holding(stage(chain), profiles["apple"])
    pressure = made.rig.plant.pressure
    worst = of(made, chain, FailMode.FREEZE).air
    gap = replace(chain, effects=(Leak(rate=WORST_LEAK, exponent=1.0),))
    # One over the pressure grows by k t / 300 kPa.
    longer = 300e3 / pressure * (exp(worst * WORST_LEAK) - 1) / WORST_LEAK
    assert of(made, gap, FailMode.FREEZE).air == pytest.approx(longer, rel=0.02)


def test_creep_that_may_come_shortens_it(chain: Chain, profiles: Profiles) -> None:
    creep = Creep(fast=-0.02, medium=0.0, slow=0.05, time=1.0, leverage=1.0)
    static = StaticMuscle(chain.muscle, (*chain.static.effects, creep))
    made = holding(stage(chain), profiles["apple"])
    plain = of(made, chain, FailMode.FREEZE)
    assert of(made, replace(chain, static=static), FailMode.FREEZE).air < plain.air


def test_creep_that_would_take_the_grip_is_named(
    chain: Chain, profiles: Profiles
) -> None:
    creep = Creep(fast=-0.15, medium=-0.15, slow=-0.15, time=1.0, leverage=1.0)
    static = StaticMuscle(chain.muscle, (*chain.static.effects, creep))
    made = holding(stage(chain), profiles["apple"])
    said = of(made, replace(chain, static=static), FailMode.FREEZE)
    assert (said.bus, said.limited_by) == (0.0, Cause.CREEP)


def test_a_force_that_is_only_computed_shortens_it(
    chain: Chain, profiles: Profiles
) -> None:
    unsure = replace(chain, tolerances={"muscle.elastic_modulus": 0.15e6})
    made = holding(stage(chain), profiles["apple"])
    measured = of(made, unsure, FailMode.FREEZE)
    made.rig.plant.faults = BenchFaults(broken=frozenset({Channel.GRIP}))
    made.run(0.2)
    assert of(made, unsure, FailMode.FREEZE).air < 0.9 * measured.air


def test_nothing_is_said_without_a_pressure(chain: Chain, profiles: Profiles) -> None:
    made = holding(stage(chain), profiles["apple"])
    made.rig.plant.faults = BenchFaults(broken=frozenset({Channel.PRESSURE}))
    made.run(0.2)
    state = made.state
    assert state.held is not None
    assert state.measured is not None
    assert budget(state.held, state.measured, chain, fail_mode=FailMode.FREEZE) is None
