from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise

import pytest

from gripperd.bench.faults import HEALTHY, BenchFaults
from gripperd.bench.sensors import Channel
from gripperd.control.command import Status
from gripperd.control.profile import Profile
from gripperd.control.states import Grip
from gripperd.control.task import Adjust
from gripperd.control.trust import Level
from gripperd.effects.creep import Creep
from gripperd.model import Chain, StaticMuscle
from gripperd.signals import Quality

from .regulated import grips, holding, largest_step, stage
from .stage import Stage

Profiles = Mapping[str, Profile]
ORDINARY = ("apple", "peach", "raw_egg", "grape")
OVERSHOOT = 0.03
"""Bound of the overshoot of an adjustment, of the step; besides the 3 % of the target
that count as no error. [-]"""
BUMP = 0.1
"""Largest change of the grip when a loop hands over. [N]"""


def creeping(chain: Chain) -> Chain:
    """The same muscle, losing 5 % of its pull over a minute."""
    creep = Creep(fast=-0.01, medium=-0.02, slow=-0.02, time=1.0, leverage=1.0)
    effects = (*chain.static.effects, creep)
    return replace(chain, static=StaticMuscle(chain.muscle, effects))


def level_of(made: Stage) -> str | None:
    """What the pressure is corrected by now."""
    state = made.state.regulation
    return None if state is None else state.level.value


def overshoot(forces: list[float], start: float, target: float) -> float:
    return max(forces) - target if target > start else target - min(forces)


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("name", ORDINARY)
def test_an_adjusted_force_comes_without_overshoot(
    chain: Chain, profiles: Profiles, name: str, seed: int
) -> None:
    profile = profiles[name]
    made = holding(stage(chain, seed), profile)
    for factor in (1.6, 0.8):
        start, target = made.rig.plant.grip, factor * profile.force
        made.truth.clear()
        command = made.complete(Adjust(force=target))
        assert command.status is Status.SUCCEEDED, command.error
        # Three per cent count as there, and the sensor has 0.05 N of noise.
        near = max(0.03 * target, 0.2) + 0.1
        assert made.rig.plant.grip == pytest.approx(target, abs=near)
        over = overshoot(grips(made), start, target)
        assert over <= OVERSHOOT * abs(target - start) + near


@pytest.mark.parametrize("share", [-0.1, 0.1])
def test_a_muscle_that_is_not_the_model_s_is_adjusted_all_the_same(
    chain: Chain, profiles: Profiles, share: float
) -> None:
    # The rubber is softer or stiffer by a tenth: the model is off by 5 N.
    plant = chain.varied("muscle.elastic_modulus", share * 1.3e6)
    made = holding(stage(chain, plant=plant), profiles["raw_egg"])
    for start, target in ((12.0, 20.0), (20.0, 8.0)):
        made.truth.clear()
        assert made.complete(Adjust(force=target)).status is Status.SUCCEEDED
        assert made.rig.plant.grip == pytest.approx(target, abs=0.7)
        over = overshoot(grips(made), start, target)
        assert over <= OVERSHOOT * abs(target - start) + 0.7


def test_a_harder_grip_near_the_limit_never_passes_it(
    chain: Chain, profiles: Profiles
) -> None:
    egg = profiles["raw_egg"]
    made = holding(stage(chain), egg)
    command = made.complete(Adjust(force=0.97 * egg.damage_force / egg.crush_margin))
    assert command.status is Status.SUCCEEDED
    assert max(grips(made)) < egg.damage_force / egg.crush_margin * 1.03


def test_the_ramp_of_the_profile_bounds_how_fast_it_gets_there(
    chain: Chain, profiles: Profiles
) -> None:
    apple = profiles["apple"]
    made = holding(stage(chain), apple)
    made.complete(Adjust(force=40.0))
    # The model's way goes at the ramp; the corrections add less than as much again.
    assert 0.5 * apple.ramp * 0.01 < largest_step(made) < 2 * apple.ramp * 0.01


def test_a_valve_that_gives_too_little_is_corrected(
    chain: Chain, profiles: Profiles
) -> None:
    made = holding(stage(chain), profiles["apple"])
    made.rig.plant.faults = BenchFaults(valve_offset=-8e3)
    command = made.complete(Adjust(force=30.0))
    assert command.status is Status.SUCCEEDED
    assert made.rig.plant.grip == pytest.approx(30.0, abs=1.0)


def test_creep_is_compensated_where_the_profile_allows(
    chain: Chain, profiles: Profiles
) -> None:
    apple, plant = profiles["apple"], creeping(chain)
    left = holding(stage(chain, plant=plant), apple)
    kept = holding(stage(chain, plant=plant), apple, compensate=True)
    for made in (left, kept):
        made.run(30.0)
    assert left.rig.plant.grip < 22.5
    assert not left.writes
    assert kept.rig.plant.grip == pytest.approx(25.0, abs=0.9)
    # 10 % of the pressure in 5 s are 34 uA in a period at most, once; here far less.
    assert largest_step(kept) < 20e-6


def test_corrections_stay_within_the_share_of_the_pressure_that_is_allowed(
    chain: Chain, profiles: Profiles
) -> None:
    modest = replace(profiles["apple"], most_correction=0.01)
    made = holding(stage(chain, plant=creeping(chain)), modest, compensate=True)
    start = made.gripper.state(made.instant).current
    made.run(30.0)
    assert start is not None
    assert made.state.current is not None
    raised = chain.regulator.gain * (made.state.current - start)
    assert 0.0 < raised <= 0.01 * float(chain.regulator.pressure(start)) + 1.0


@pytest.mark.parametrize(
    ("broken", "level", "quality"),
    [
        ({Channel.GRIP}, Level.PRESSURE, Quality.SUBSTITUTED),
        ({Channel.GRIP, Channel.PRESSURE}, Level.MODEL, Quality.BAD),
        ({Channel.PRESSURE}, Level.FORCE, Quality.GOOD),
        (set(Channel), Level.MODEL, Quality.BAD),
    ],
    ids=["force", "force and pressure", "pressure", "all"],
)
def test_a_sensor_that_dies_while_holding_is_not_felt_by_the_object(
    chain: Chain,
    profiles: Profiles,
    broken: set[Channel],
    level: Level,
    quality: Quality,
) -> None:
    made = holding(stage(chain), profiles["apple"], compensate=True)
    made.run(3.0)
    before = made.rig.plant.grip
    made.truth.clear()
    made.rig.plant.faults = BenchFaults(broken=frozenset(broken))
    made.run(3.0)
    state = made.state.regulation
    assert state is not None
    assert (state.level, state.quality) == (level, quality)
    assert (state.cause != "") == (quality is not Quality.GOOD)
    made.rig.plant.faults = HEALTHY
    made.run(3.0)
    assert made.state.regulation is not None
    assert made.state.regulation.level is Level.FORCE
    assert max(abs(force - before) for force in grips(made)) < BUMP


def test_a_correction_outlives_the_sensors_that_asked_for_it(
    chain: Chain, profiles: Profiles
) -> None:
    made = holding(stage(chain), profiles["apple"], compensate=True)
    made.rig.plant.faults = BenchFaults(valve_offset=-8e3)
    made.run(10.0)
    before = made.rig.plant.grip
    made.truth.clear()
    dead = frozenset({Channel.GRIP, Channel.PRESSURE})
    made.rig.plant.faults = BenchFaults(valve_offset=-8e3, broken=dead)
    made.run(3.0)
    assert level_of(made) == "model"
    assert max(abs(force - before) for force in grips(made)) < BUMP


def test_a_force_sensor_that_freezes_moves_nothing(
    chain: Chain, profiles: Profiles
) -> None:
    made = holding(stage(chain), profiles["apple"], compensate=True)
    made.run(2.0)
    before = made.rig.plant.grip
    made.truth.clear()
    made.rig.plant.faults = BenchFaults(frozen=frozenset({Channel.GRIP}))
    made.run(10.0)
    assert max(abs(force - before) for force in grips(made)) < BUMP


def test_a_manual_current_is_taken_over_and_given_back_without_a_bump(
    chain: Chain, profiles: Profiles
) -> None:
    made = holding(stage(chain), profiles["apple"], compensate=True)
    made.run(2.0)
    current = made.state.current
    before = made.rig.plant.grip
    made.truth.clear()
    assert made.complete(Adjust(current=current)).status is Status.SUCCEEDED
    assert level_of(made) == "manual"
    made.run(2.0)
    assert made.state.current == pytest.approx(current)
    assert made.complete(Adjust(force=before)).status is Status.SUCCEEDED
    made.run(2.0)
    assert level_of(made) == "force"
    # Whatever is within 3 % of the wanted force stays as it is.
    assert max(abs(force - before) for force in grips(made)) < 0.03 * before


def test_a_supply_that_sags_winds_nothing_up(chain: Chain, profiles: Profiles) -> None:
    apple = profiles["apple"]
    made = holding(stage(chain), apple, compensate=True)
    made.run(1.0)
    before = made.state.current
    assert before is not None
    # 25 N take 172 kPa: 25 kPa are missing, more than a correction may add.
    made.rig.plant.faults = BenchFaults(supply_pressure=147e3)
    made.run(10.0)
    assert made.state.grip is Grip.HOLDING
    assert made.state.current is not None
    wound = chain.regulator.gain * (made.state.current - before)
    assert wound < 0.05 * float(chain.regulator.pressure(before))
    made.truth.clear()
    made.rig.plant.faults = HEALTHY
    made.run(2.0)
    assert max(grips(made)) < 1.15 * apple.force


def test_a_disabled_gripper_corrects_nothing(chain: Chain, profiles: Profiles) -> None:
    made = holding(
        stage(chain, plant=creeping(chain)), profiles["apple"], compensate=True
    )
    made.gripper.disable(made.instant)
    made.run(10.0)
    assert not made.writes


def test_every_period_writes_what_the_state_says(
    chain: Chain, profiles: Profiles
) -> None:
    made = holding(stage(chain), profiles["apple"])
    command = made.submit(Adjust(force=35.0))
    while not made.command(command).final:
        made.tick()
        if made.writes:
            assert made.state.current == pytest.approx(made.writes[-1][1], abs=1e-6)
    times = [when for when, _ in made.writes]
    assert all(before < after for before, after in pairwise(times))
