"""Every effect of the library runs in the simulated rig."""

from dataclasses import replace
from random import Random

import pytest

from gripperd.bench.faults import BenchFaults
from gripperd.bench.hidden import DEAD, HiddenEffects, lively
from gripperd.bench.object import BenchObject
from gripperd.bench.plant import Plant
from gripperd.bench.rig import Rig
from gripperd.bench.sensors import SensorSettings
from gripperd.bench.settings import PlantSettings
from gripperd.effects import EFFECTS
from gripperd.effects.ambient_pressure import AmbientPressure
from gripperd.effects.channel_delay import ChannelDelay
from gripperd.effects.coulomb_friction import CoulombFriction
from gripperd.effects.creep import Creep
from gripperd.effects.fatigue import Fatigue
from gripperd.effects.jaw_compliance import JawCompliance
from gripperd.effects.leak import Leak
from gripperd.effects.linkage_backlash import LinkageBacklash
from gripperd.effects.linkage_friction import LinkageFriction
from gripperd.effects.presliding_hysteresis import PreslidingHysteresis
from gripperd.effects.pressure_hysteresis import PressureHysteresis
from gripperd.effects.pressure_sensor_bias import PressureSensorBias
from gripperd.effects.series_compliance import SeriesCompliance
from gripperd.effects.supply_saturation import SupplySaturation
from gripperd.effects.temperature_stiffness import TemperatureStiffness
from gripperd.effects.valve_dead_band import ValveDeadBand
from gripperd.effects.valve_lag import ValveLag
from gripperd.effects.viscous_friction import ViscousFriction
from gripperd.model import Chain, Direction, PressedObject
from gripperd.model.effect import Effect, MuscleEffect, Signal, acts_in_muscle
from gripperd.model.parameter import parameters

CURRENT = 0.0107
SIZE, STIFFNESS = 0.041, 2e4
OBJECT = BenchObject(
    diameter=SIZE, stiffness=STIFFNESS, mass=0.05, friction=0.5, damage_force=500.0
)
UNPREDICTED = {
    "creep", "first_cycle", "leak", "linkage_backlash", "valve_dead_band", "valve_lag",
}  # fmt: skip
"""What a prediction does not know of, or not so soon."""


def with_effect(chain: Chain, *effects: Effect) -> Chain:
    inside: tuple[MuscleEffect, ...] = tuple(filter(acts_in_muscle, effects))
    static = replace(chain.static, effects=(*chain.static.effects, *inside))
    elsewhere = tuple(each for each in effects if not acts_in_muscle(each))
    return replace(chain, static=static, effects=elsewhere)


def typical(name: str) -> Effect:
    known = parameters(EFFECTS[name])
    sizes = {key: each.scale for key, each in known.items() if each.is_amplitude}
    return replace(EFFECTS[name](), **sizes)


def run(plant: Plant, seconds: float) -> None:
    for _ in range(round(seconds / 2e-3)):
        plant.step(2e-3)


def grasping(chain: Chain, *effects: Effect, seconds: float = 1.5) -> Plant:
    plant = Plant(with_effect(chain, *effects), PlantSettings())
    plant.place(OBJECT)
    plant.current = CURRENT
    run(plant, seconds)
    return plant


@pytest.mark.parametrize(
    "name",
    [
        name
        for name in EFFECTS
        if name not in UNPREDICTED | {"rubber_elasticity", "braid_friction"}
    ],
)
def test_a_settled_grasp_is_what_the_same_effect_predicts(
    chain: Chain, name: str
) -> None:
    effect = typical(name)
    plant = grasping(chain, effect)
    seen = with_effect(chain, effect).predict(CURRENT, PressedObject(SIZE, STIFFNESS))
    assert plant.grip == pytest.approx(seen.grip_force, rel=2e-3)
    assert plant.pressure == pytest.approx(seen.pressure, abs=1.0)
    assert plant.opening == pytest.approx(seen.opening, abs=5e-6)
    assert plant.at_rest


def test_effects_of_the_moment_alone_are_left_to_the_table(chain: Chain) -> None:
    kinds = [kind for kind in EFFECTS.values() if kind.stage == "muscle"]
    effects = tuple(filter(acts_in_muscle, (typical(kind.name) for kind in kinds)))
    assert {effect.name for effect in lively(effects, chain.muscle)} == {
        "coulomb_friction",
        "pressure_friction",
        "temperature_stiffness",
        "presliding_hysteresis",
        "pressure_hysteresis",
        "viscous_friction",
        "creep",
        "fatigue",
        "first_cycle",
    }


def test_a_lagging_valve_fills_late(chain: Chain) -> None:
    lagging = ValveLag(share=1.0, time=0.5)
    plant = grasping(chain, lagging, seconds=0.5)
    assert 0.5 * 209_375 < plant.pressure < 0.66 * 209_375
    run(plant, 6.0)
    assert plant.pressure == pytest.approx(209_375, rel=1e-4)


@pytest.mark.parametrize("rest", [0.0, 10.0])
@pytest.mark.parametrize("dead_time", [0.002, 0.03, 0.3])
def test_a_valve_that_waits_fills_all_the_same(
    chain: Chain, rest: float, dead_time: float
) -> None:
    waiting = ValveLag(share=1.0, time=0.05, dead_time=dead_time)
    plant = Plant(with_effect(chain, waiting), PlantSettings())
    run(plant, rest)
    plant.current = CURRENT
    run(plant, dead_time)
    assert plant.pressure < 0.05 * 209_375
    run(plant, 2.0)
    assert plant.pressure == pytest.approx(209_375, rel=1e-4)
    assert plant.at_rest
    # What comes at rest waits as long.
    plant.current = 0.004
    run(plant, dead_time)
    assert plant.pressure > 0.9 * 209_375
    run(plant, 3.0)
    assert plant.pressure < 500.0


def test_the_bench_waits_as_long_as_any_valve() -> None:
    assert parameters(ValveLag)["dead_time"].high <= DEAD


def test_friction_that_goes_by_the_rate_alone_is_none_at_rest(chain: Chain) -> None:
    friction = CoulombFriction(20.0, slip=3e-3)
    plant = grasping(chain, friction)
    seen = with_effect(chain, friction).predict(CURRENT, PressedObject(SIZE, STIFFNESS))
    assert plant.grip == pytest.approx(seen.grip_force, rel=5e-3)


def test_friction_that_turns_over_a_distance_keeps_hold_of_what_was_closed(
    chain: Chain,
) -> None:
    friction = CoulombFriction(20.0, distance=1e-3, slip=3e-3)
    pressed = PressedObject(SIZE, STIFFNESS)
    free = chain.predict(CURRENT, pressed).grip_force
    held = free - with_effect(chain, friction).predict(CURRENT, pressed).grip_force
    # The end of the way is slow: a part of it wanes there, which no prediction knows.
    kept = free - grasping(chain, friction).grip
    assert 0.85 * held < kept < held


def test_a_creeping_muscle_goes_on_pulling_harder_at_constant_pressure(
    chain: Chain,
) -> None:
    plant = grasping(chain, Creep(fast=0.03, medium=0.03), seconds=1.5)
    early, pressure = plant.grip, plant.pressure
    run(plant, 6.0)
    assert plant.pressure == pytest.approx(pressure, abs=0.2)
    assert plant.grip > early + 1.0
    assert not plant.at_rest


def test_a_leaking_line_lets_the_grip_sink(chain: Chain) -> None:
    plant = grasping(chain, Leak(rate=0.02), seconds=1.5)
    early = plant.grip
    run(plant, 5.0)
    assert plant.pressure == pytest.approx(209_375 * 0.878, rel=2e-3)
    assert plant.grip < early - 3.0


def test_a_leak_too_slow_to_see_in_a_step_is_not_rest(chain: Chain) -> None:
    plant = grasping(chain, Leak(rate=1e-4), seconds=6.0)
    assert plant.pressure == pytest.approx(209_375 * (1 - 6e-4), abs=10)
    assert not plant.at_rest


def test_a_dead_band_keeps_the_pressure_at_a_small_reversal(chain: Chain) -> None:
    plant = grasping(chain, ValveDeadBand(width=20e3))
    high = plant.pressure
    plant.current = CURRENT - 0.3e-3
    run(plant, 1.0)
    assert plant.pressure == high
    plant.current = CURRENT - 2e-3
    run(plant, 1.0)
    assert plant.pressure < high - 40e3


def test_the_pressure_sinks_with_a_supply_that_sags(chain: Chain) -> None:
    plant = grasping(chain, SupplySaturation(share=0.0, sag=0.1))
    healthy = plant.pressure
    plant.faults = BenchFaults(supply_pressure=600e3)
    run(plant, 1.0)
    place = 209_375 / 500e3
    assert plant.pressure == pytest.approx(healthy - 0.1 * 100e3 * place, abs=1.0)


def test_a_warm_muscle_is_softer_or_stiffer(chain: Chain) -> None:
    effect = with_effect(chain, TemperatureStiffness(modulus=-0.01))
    grips = []
    for temperature in (293.15, 313.15):
        plant = Plant(effect, PlantSettings(temperature=temperature))
        plant.place(OBJECT)
        plant.current = CURRENT
        run(plant, 1.5)
        grips.append(plant.grip)
    assert grips[1] > grips[0] + 1.0


def test_a_viscous_muscle_closes_later(chain: Chain) -> None:
    quick, slow = (
        grasping(chain, *effects, seconds=0.1)
        for effects in ((), (ViscousFriction(damping=400.0),))
    )
    assert slow.opening > quick.opening + 2e-3


def test_friction_that_grows_with_the_rate_comes_to_rest(chain: Chain) -> None:
    plant = grasping(chain, ViscousFriction(sublinear=200.0), seconds=3.0)
    seen = chain.predict(CURRENT, PressedObject(SIZE, STIFFNESS))
    assert plant.at_rest
    assert plant.grip == pytest.approx(seen.grip_force, rel=2e-3)
    plant.current = CURRENT - 1e-3
    run(plant, 3.0)
    eased = chain.predict(
        CURRENT - 1e-3, PressedObject(SIZE, STIFFNESS), Direction.EXTENDING
    )
    assert plant.at_rest
    assert plant.grip == pytest.approx(eased.grip_force, rel=5e-3)


def test_every_inflation_tires_the_muscle(chain: Chain) -> None:
    plant = grasping(chain, Fatigue(loss=0.02), seconds=1.0)
    fresh = plant.grip
    for _ in range(3):
        for current in (0.016, 0.0):
            plant.current = current
            run(plant, 1.0)
    plant.current = CURRENT
    run(plant, 1.0)
    assert plant.grip < fresh - 2.0


def test_the_jaws_lag_by_the_play_and_stand_still_when_it_reverses(
    chain: Chain,
) -> None:
    width = 2e-3
    free = Plant(with_effect(chain, LinkageBacklash(width=width)), PlantSettings())
    bare = Plant(chain, PlantSettings())
    for plant in (free, bare):
        plant.current = 0.012
        run(plant, 1.5)
    assert free.opening == pytest.approx(bare.opening + width / 2, abs=1e-6)
    for plant in (free, bare):
        plant.current = 0.004
        run(plant, 2.0)
    assert free.opening == pytest.approx(bare.opening - width / 2, abs=1e-6)


@pytest.mark.parametrize("stiffening", [0.0, 0.04])
def test_rub_and_bend_together_grip_as_predicted(
    chain: Chain, stiffening: float
) -> None:
    effects = (
        LinkageFriction(loss=0.1),
        JawCompliance(compliance=2e-5, stiffening=stiffening),
        SeriesCompliance(compliance=2e-6, shortening=2e-5, stiffening=stiffening / 4),
    )
    plant = grasping(chain, *effects)
    seen = with_effect(chain, *effects).predict(CURRENT, PressedObject(SIZE, STIFFNESS))
    assert plant.grip == pytest.approx(seen.grip_force, rel=2e-3)
    assert plant.opening == pytest.approx(SIZE - plant.grip / STIFFNESS, abs=5e-6)


@pytest.mark.parametrize(
    "effect",
    [
        PreslidingHysteresis(near=30.0, middle=30.0, far=30.0, contraction=0.1),
        PressureHysteresis(near=30.0, middle=30.0, far=30.0, pressure=300e3),
    ],
    ids=lambda effect: effect.name,
)
def test_springs_carry_what_a_grasp_has_wound_them_up(
    chain: Chain, effect: Effect
) -> None:
    """The way to the object is too short to make them slip: 90 N they never carry."""
    plant = grasping(chain, effect)
    pressed = PressedObject(SIZE, STIFFNESS)
    seen = with_effect(chain, effect).predict(CURRENT, pressed)
    assert plant.grip == pytest.approx(seen.grip_force, rel=3e-3)
    lost = chain.predict(CURRENT, pressed).muscle_force - seen.muscle_force
    assert 20 < lost < 70
    again = with_effect(chain, effect).current_for(seen.grip_force, pressed)
    assert again == pytest.approx(CURRENT, rel=1e-9)


def test_joints_that_carry_the_pull_take_from_the_grip(chain: Chain) -> None:
    pressed, loss = PressedObject(SIZE, STIFFNESS), 0.02
    plant = grasping(chain, LinkageFriction(pull_loss=loss))
    seen = with_effect(chain, LinkageFriction(pull_loss=loss)).predict(CURRENT, pressed)
    assert plant.grip == pytest.approx(seen.grip_force, rel=2e-3)
    free = chain.predict(CURRENT, pressed)
    # What the object yields less for it is little: the joints take 2 % of the pull.
    lost = free.grip_force - seen.grip_force
    assert lost == pytest.approx(loss * seen.muscle_force, rel=0.2)


def test_a_mount_that_stretches_lets_the_muscle_shorten(chain: Chain) -> None:
    pressed, effect = PressedObject(SIZE, STIFFNESS), SeriesCompliance(shortening=3e-5)
    plant = grasping(chain, effect)
    seen = with_effect(chain, effect).predict(CURRENT, pressed)
    assert plant.grip == pytest.approx(seen.grip_force, rel=2e-3)
    inside = seen.contraction + 3e-5 * seen.muscle_force
    tension = chain.static.tension(seen.pressure, inside)
    assert seen.muscle_force == pytest.approx(float(tension), rel=1e-6)
    assert chain.predict(CURRENT, pressed).grip_force > 1.1 * seen.grip_force


def test_joints_that_rub_hold_harder_once_the_pressure_is_eased(chain: Chain) -> None:
    rubbing = LinkageFriction(loss=0.1)
    plant = grasping(chain, rubbing)
    plant.current = CURRENT - 1e-3
    run(plant, 1.5)
    seen = with_effect(chain, rubbing).predict(
        CURRENT - 1e-3, PressedObject(SIZE, STIFFNESS), Direction.EXTENDING
    )
    assert plant.direction is Direction.EXTENDING
    assert plant.grip == pytest.approx(seen.grip_force, rel=5e-3)


def test_what_only_bends_is_left_to_the_stiffness(chain: Chain) -> None:
    bending = with_effect(chain, JawCompliance(compliance=2e-5))
    assert not HiddenEffects(bending).any
    assert HiddenEffects(with_effect(chain, LinkageBacklash(width=1e-3))).any


def quiet(chain: Chain, *effects: Effect, **settings: float) -> Rig:
    """A rig whose sensors have no noise but the effects."""
    sensors = {
        name: replace(getattr(SensorSettings(), name), noise=0.0)
        for name in ("pressure", "opening", "grip")
    }
    return Rig(
        with_effect(chain, *effects),
        Random(1),
        settings=PlantSettings(**settings),
        sensors=SensorSettings(**sensors),
    )


def shown_pressure(rig: Rig) -> float:
    """What the pressure transmitter says. [Pa]."""
    return (rig.read_inputs()[0] - 0.004) / 0.016 * 600e3


def test_a_biased_transmitter_misleads_the_reader_and_not_the_plant(
    chain: Chain,
) -> None:
    rig = quiet(chain, PressureSensorBias(bias=20e3))
    assert shown_pressure(rig) == pytest.approx(20e3, abs=50)
    rig.write_current(CURRENT)
    rig.advance(1.5)
    assert shown_pressure(rig) == pytest.approx(229_375, abs=50)
    assert rig.plant.pressure == pytest.approx(209_375, abs=1)


def test_an_absolute_transducer_follows_the_weather(chain: Chain) -> None:
    rig = quiet(chain, AmbientPressure(share=1.0), ambient_pressure=111_325.0)
    assert shown_pressure(rig) == pytest.approx(10e3, abs=50)


def test_a_late_channel_shows_the_past(chain: Chain) -> None:
    rig = quiet(chain, ChannelDelay(delay=0.05, channel=Signal.PRESSURE))
    rig.write_current(CURRENT)
    rig.advance(0.05)
    past = rig.plant.pressure
    rig.advance(0.10)
    assert past > 50e3
    assert shown_pressure(rig) == pytest.approx(past, abs=50)
    assert rig.plant.pressure > past + 20e3


def test_after_a_long_rest_a_late_channel_still_shows_the_past(chain: Chain) -> None:
    rig = quiet(chain, ChannelDelay(delay=0.05, channel=Signal.PRESSURE))
    rig.advance(3600.0)
    rig.write_current(CURRENT)
    rig.advance(3600.04)
    assert shown_pressure(rig) == pytest.approx(0.0, abs=50)
    assert rig.plant.pressure > 50e3
