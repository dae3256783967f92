from collections.abc import Mapping
from dataclasses import replace

import pytest

from gripperd.bench.faults import HEALTHY, BenchFaults
from gripperd.bench.rig import Rig
from gripperd.bench.sensors import Channel
from gripperd.control.command import GraspOrder, Outcome
from gripperd.control.monitors.policy import Cause
from gripperd.control.profile import Mode, Profile
from gripperd.control.states import Grip
from gripperd.effects.supply_saturation import SupplySaturation
from gripperd.model import Chain
from gripperd.signals import Quality

from .stage import Stage, grasped, ordered, real

Profiles = Mapping[str, Profile]
BLIND = frozenset(Channel)
SHORT_OF_AIR = BenchFaults(supply_pressure=150e3)


def test_a_force_the_air_cannot_give_is_not_reached(
    stage: Stage, profiles: Profiles
) -> None:
    result = grasped(stage, profiles["apple"], Mode.FORCE, SHORT_OF_AIR)
    assert result.outcome is Outcome.FORCE_NOT_REACHED
    assert result.force == pytest.approx(12.1, abs=0.3)


def test_a_grip_under_the_slip_limit_is_not_held(
    stage: Stage, profiles: Profiles
) -> None:
    # 170 kPa give the egg 1.2 N; it needs 1.07 N, and 1.61 N with its margin.
    short = BenchFaults(supply_pressure=170e3)
    result = grasped(stage, profiles["raw_egg"], Mode.CURRENT, short)
    assert result.outcome is Outcome.FORCE_NOT_REACHED


@pytest.mark.parametrize("mode", Mode)
@pytest.mark.parametrize("offset", [-20e3, 0.0, 20e3, 60e3, 100e3])
def test_the_egg_never_feels_its_damage_force(
    stage: Stage, profiles: Profiles, mode: Mode, offset: float
) -> None:
    egg = profiles["raw_egg"]
    grasped(stage, egg, mode, BenchFaults(valve_offset=offset))
    stage.pass_time(1.0)
    assert stage.peak() < egg.damage_force


def test_a_grip_that_was_cut_short_is_not_dropped(
    stage: Stage, profiles: Profiles
) -> None:
    egg = profiles["raw_egg"]
    result = grasped(stage, egg, Mode.CURRENT, BenchFaults(valve_offset=60e3))
    assert result.current < stage.writes[-2][1]
    stage.pass_time(1.0)
    assert stage.rig.plant.grip > egg.slip_force * egg.slip_margin


def test_a_grip_that_was_cut_short_is_eased_to_its_margin(
    stage: Stage, profiles: Profiles
) -> None:
    egg = profiles["raw_egg"]
    grasped(stage, egg, Mode.CURRENT, BenchFaults(valve_offset=60e3))
    stage.pass_time(1.0)
    safe = egg.damage_force / egg.crush_margin
    assert stage.rig.plant.grip == pytest.approx(safe, rel=0.05)


@pytest.mark.parametrize("mode", Mode)
@pytest.mark.parametrize("name", ["apple", "raw_egg"])
def test_without_its_force_sensor_the_model_stands_in(
    stage: Stage, profiles: Profiles, name: str, mode: Mode
) -> None:
    faults = BenchFaults(broken=frozenset({Channel.GRIP}))
    result = grasped(stage, profiles[name], mode, faults)
    assert result.outcome is Outcome.HELD
    assert result.force_quality is Quality.SUBSTITUTED
    assert result.force == pytest.approx(stage.rig.plant.grip, rel=0.03)


@pytest.mark.parametrize("mode", Mode)
def test_without_an_opening_a_force_is_held_but_no_size_told(
    stage: Stage, profiles: Profiles, mode: Mode
) -> None:
    faults = BenchFaults(broken=frozenset({Channel.OPENING}))
    result = grasped(stage, profiles["apple"], mode, faults)
    assert result.outcome is Outcome.HELD
    assert result.size is result.opening is result.predicted_force is None
    assert result.force == pytest.approx(stage.rig.plant.grip, rel=0.02)


@pytest.mark.parametrize("mode", Mode)
def test_blind_it_goes_where_the_model_says(
    stage: Stage, profiles: Profiles, mode: Mode
) -> None:
    egg = profiles["raw_egg"]
    result = grasped(stage, egg, mode, BenchFaults(broken=BLIND))
    assert result.force is result.slip_margin is result.crush_margin is None
    expected = egg.force if mode is Mode.FORCE else 22.3
    assert stage.rig.plant.grip == pytest.approx(expected, rel=0.02)


def test_air_that_comes_back_does_not_crush_what_is_held(
    stage: Stage, profiles: Profiles
) -> None:
    grasped(stage, profiles["apple"], Mode.FORCE, SHORT_OF_AIR)
    stage.rig.plant.faults = HEALTHY
    stage.pass_time(1.0)
    assert stage.peak() < profiles["apple"].damage_force


@pytest.mark.parametrize("mode", Mode)
def test_jaws_that_never_closed_do_not_say_there_is_no_object(
    stage: Stage, profiles: Profiles, mode: Mode
) -> None:
    short = BenchFaults(supply_pressure=120e3)
    result = grasped(stage, profiles["apple"], mode, short)
    assert result.outcome is Outcome.FORCE_NOT_REACHED


@pytest.mark.parametrize(
    ("broken", "grip"),
    [(frozenset(), Grip.NO_PART), (frozenset({Channel.GRIP}), Grip.UNKNOWN)],
    ids=["felt", "not felt"],
)
def test_what_was_never_touched_is_neither_held_nor_lost(
    ready: Stage, apple: GraspOrder, broken: frozenset[Channel], grip: Grip
) -> None:
    ready.rig.plant.faults = BenchFaults(supply_pressure=120e3, broken=broken)
    ready.rig.plant.place(real(apple.profile))
    missed = ready.complete(apple)
    assert missed.result is not None
    assert missed.result.outcome is Outcome.FORCE_NOT_REACHED
    assert (ready.state.grip, ready.state.holding) == (grip, None)
    ready.run(1.0)
    assert ready.state.grip is grip
    causes = {fault.cause for fault in ready.gripper.faults.newest(9)}
    assert Cause.PART_LOST not in causes


def test_what_is_held_with_too_little_force_is_held(
    ready: Stage, apple: GraspOrder
) -> None:
    ready.rig.plant.faults = SHORT_OF_AIR
    ready.rig.plant.place(real(apple.profile))
    weak = ready.complete(apple)
    assert weak.result is not None
    assert weak.result.outcome is Outcome.FORCE_NOT_REACHED
    assert (ready.state.grip, ready.state.holding) == (Grip.HOLDING, "apple")


def test_a_force_sensor_that_is_stuck_does_not_cost_an_egg(
    stage: Stage, profiles: Profiles
) -> None:
    stage.measure()
    egg = profiles["raw_egg"]
    grasped(stage, egg, Mode.FORCE, BenchFaults(frozen=frozenset({Channel.GRIP})))
    assert stage.peak() < egg.damage_force


def test_a_strong_valve_hardly_overshoots_a_force(
    stage: Stage, profiles: Profiles
) -> None:
    apple = profiles["apple"]
    result = grasped(stage, apple, Mode.FORCE, BenchFaults(valve_offset=80e3))
    assert result.outcome is Outcome.HELD
    assert stage.peak() < apple.force * 1.5


def test_soft_and_tough_things_are_held_too(stage: Stage, profiles: Profiles) -> None:
    # Foam: no valve could squeeze it to its limit.
    foam = replace(
        profiles["apple"], diameter=0.060, stiffness=2e3, damage_force=1000.0
    )
    assert grasped(stage, foam, Mode.FORCE).outcome is Outcome.HELD


def test_a_model_that_knows_the_air_is_short_ends_the_grasp_with_an_outcome(
    chain: Chain, rig: Rig, profiles: Profiles
) -> None:
    # 12 N take 190.1 kPa on an egg of 41 mm, 194.3 kPa on one of 38.5 mm.
    limit = 191.5 / 500
    knows = replace(chain, effects=(SupplySaturation(share=1.0, limit=limit),))
    stage = Stage(knows, rig, {"pressure": 600e3, "opening": 0.1, "grip": 100.0})
    short = BenchFaults(supply_pressure=191.5e3)
    result = grasped(stage, profiles["raw_egg"], Mode.FORCE, short, diameter=0.0385)
    assert result.outcome is Outcome.FORCE_NOT_REACHED
    assert result.force == pytest.approx(10.4, abs=0.5)


def test_closed_jaws_are_told_by_the_pressure_that_the_model_s_valve_gives(
    chain: Chain, rig: Rig, profiles: Profiles
) -> None:
    # 10.7 mA are 209 kPa on the line; this supply ends at 150 kPa, and it is known.
    knows = replace(chain, effects=(SupplySaturation(share=1.0, limit=0.3),))
    stage = Stage(knows, rig, {"pressure": 600e3, "opening": 0.1, "grip": 100.0})
    rig.plant.faults = BenchFaults(
        supply_pressure=150e3, broken=frozenset({Channel.OPENING})
    )
    result = stage.grasp(ordered(profiles["raw_egg"], Mode.CURRENT))
    assert result.outcome is Outcome.NO_OBJECT
