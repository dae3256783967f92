from collections.abc import Mapping
from dataclasses import replace

import pytest

from gripperd.bench.faults import BenchFaults
from gripperd.bench.placed import ObjectState
from gripperd.bench.sensors import Channel
from gripperd.control.command import GraspOrder, Outcome, Status
from gripperd.control.gripper import Gripper
from gripperd.control.profile import Mode, Profile
from gripperd.control.states import Grip, Machine
from gripperd.control.task import Adjust, Move
from gripperd.errors import Refused
from gripperd.model import Chain
from gripperd.signals import Reading

from .stage import PERIOD, Stage, ordered, real

Profiles = Mapping[str, Profile]


def test_before_anything_is_known_the_state_says_so(stage: Stage) -> None:
    state = stage.state
    assert (state.machine, state.grip) == (Machine.OFFLINE, Grip.UNKNOWN)
    assert (state.current, state.measured, state.age) == (None, None, None)
    assert state.available_transitions == ()


@pytest.mark.parametrize("current", [0.0, 0.004, 0.0107, 0.020])
def test_what_is_found_is_adopted_and_nothing_is_written(
    stage: Stage, current: float
) -> None:
    stage.rig.write_current(current)
    stage.pass_time(1.0)
    stage.run(1.0)
    assert stage.writes == []
    assert stage.state.machine is Machine.READY
    assert stage.state.adopted
    assert stage.state.current == pytest.approx(current)


def test_it_looks_three_times_before_it_believes(stage: Stage) -> None:
    machines = []
    for _ in range(4):
        stage.tick()
        machines.append(stage.state.machine)
    assert machines == [*[Machine.ATTACHING] * 3, Machine.READY]


def test_a_held_object_is_found_held(stage: Stage, apple: GraspOrder) -> None:
    stage.rig.plant.place(real(apple.profile))
    stage.rig.write_current(0.0107)
    stage.pass_time(2.0)
    stage.run(0.5)
    assert stage.state.grip is Grip.HOLDING
    with pytest.raises(Refused, match="an object is being held") as refused:
        stage.submit(apple)
    assert refused.value.code == "object-held"
    assert refused.value.hints == ("release first",)


def test_open_jaws_are_found_open(stage: Stage) -> None:
    stage.run(0.5)
    assert stage.state.grip is Grip.RELEASED


def test_jaws_closed_on_nothing_hold_no_part(stage: Stage) -> None:
    stage.rig.write_current(0.0107)
    stage.pass_time(2.0)
    stage.run(0.5)
    assert stage.state.grip is Grip.NO_PART


def test_without_sensors_nobody_knows_what_is_held_and_no_grasp_lets_go_of_it(
    stage: Stage, apple: GraspOrder
) -> None:
    stage.rig.plant.faults = BenchFaults(broken=frozenset(Channel))
    stage.rig.write_current(0.0107)
    stage.run(0.5)
    assert stage.state.grip is Grip.UNKNOWN
    with pytest.raises(Refused, match="not known what the jaws hold") as refused:
        stage.submit(apple)
    assert refused.value.hints == ("release first",)
    stage.complete(None)
    assert stage.submit(apple).status is Status.QUEUED


def test_without_auto_enable_it_waits_to_be_enabled(
    stage: Stage, chain: Chain, apple: GraspOrder
) -> None:
    stage.gripper = Gripper("g0", chain, auto_enable=False, identify=lambda: "c1")
    stage.run(0.5)
    assert stage.state.machine is Machine.DISABLED
    with pytest.raises(Refused, match="while the gripper is disabled") as refused:
        stage.submit(apple)
    assert refused.value.code == "wrong-state"
    assert "enable" in refused.value.hints[0]
    stage.gripper.enable()
    assert stage.submit(apple).status is Status.QUEUED


def test_a_grasp_succeeds_and_tells_everything(ready: Stage, apple: GraspOrder) -> None:
    ready.rig.plant.place(real(apple.profile))
    queued = ready.submit(apple)
    assert queued.status is Status.QUEUED
    ready.tick()
    assert ready.state.command == queued.id
    assert (ready.state.machine, ready.state.grip) == (
        Machine.EXECUTING,
        Grip.CLOSING,
    )
    ready.until(lambda: ready.command(queued).final)
    command = ready.command(queued)
    assert command.status is Status.SUCCEEDED
    assert command.error is None
    assert command.result is not None
    assert command.result.outcome is Outcome.HELD
    assert command.started_at is not None
    assert command.completed_at is not None
    assert command.created_at < command.started_at < command.completed_at
    state = ready.state
    assert (state.machine, state.grip) == (Machine.READY, Grip.HOLDING)
    assert (state.holding, state.command) == ("apple", None)


def test_a_held_object_is_held_without_another_write(holding: Stage) -> None:
    holding.run(5.0)
    assert holding.writes == []
    assert holding.state.grip is Grip.HOLDING
    placed = holding.rig.plant.placed
    assert placed is not None
    assert placed.state is ObjectState.HELD


def test_a_missed_grasp_fails_but_leaves_the_gripper_ready(
    ready: Stage, apple: GraspOrder
) -> None:
    command = ready.complete(apple)
    assert command.status is Status.FAILED
    failure = ready.failure(command)
    assert (failure.category, failure.code) == ("outcome", "no_object")
    assert command.result is not None
    assert (ready.state.machine, ready.state.grip) == (Machine.READY, Grip.NO_PART)


def test_a_release_opens_the_jaws(holding: Stage) -> None:
    command = holding.complete(None)
    assert command.status is Status.SUCCEEDED
    assert holding.state.grip is Grip.RELEASED
    assert holding.state.holding is None
    assert holding.state.current == pytest.approx(0.004)
    holding.run(0.5)
    assert holding.rig.plant.opening == pytest.approx(0.085)


def test_a_release_that_did_not_open_is_told(holding: Stage) -> None:
    holding.rig.plant.faults = BenchFaults(jaws_blocked=True)
    command = holding.complete(None)
    assert command.status is Status.FAILED
    assert holding.failure(command).code == "not_released"
    assert holding.state.grip is Grip.UNKNOWN


def test_a_reading_the_model_has_no_answer_to_ends_the_command_alone(
    ready: Stage, apple: GraspOrder
) -> None:
    command = ready.submit(apple)
    ready.run(0.5)
    # Jaws 250 mm apart: the strands of the braid would have to be longer than they are.
    for _ in range(4):
        absurd = replace(ready.measure(), grip=Reading(5.0), opening=Reading(0.25))
        ready.write(ready.gripper.period(absurd, PERIOD, ready.instant))
    assert ready.failure(command).code == "no-answer"
    assert "braid" in ready.failure(command).message
    ready.run(1.0)
    assert ready.state.machine is Machine.READY


def test_with_an_object_in_the_jaws_another_grasp_is_refused(
    holding: Stage, apple: GraspOrder
) -> None:
    with pytest.raises(Refused, match="apple is being held"):
        holding.submit(apple)
    assert holding.writes == []


def test_a_grasp_may_wait_behind_a_release(holding: Stage, apple: GraspOrder) -> None:
    holding.submit(None)
    grasp = holding.submit(apple)
    holding.rig.plant.remove()
    holding.until(lambda: holding.command(grasp).final)
    assert holding.failure(grasp).code == "no_object"


def test_what_cannot_go_well_is_refused_before_it_is_queued(
    ready: Stage, profiles: Profiles
) -> None:
    with pytest.raises(Refused, match="raw_egg is damaged at 35 N"):
        ready.submit(ordered(profiles["raw_egg"], Mode.FORCE, 30.0))
    assert ready.gripper.ledger.newest(10) == []


def test_a_part_that_is_taken_away_is_lost(holding: Stage, apple: GraspOrder) -> None:
    holding.rig.plant.remove()
    holding.until(lambda: holding.state.grip is Grip.PART_LOST, 0.5)
    assert holding.state.machine is Machine.READY
    assert holding.submit(apple).status is Status.QUEUED


def test_a_part_is_lost_by_sight_too(ready: Stage, apple: GraspOrder) -> None:
    plant = ready.rig.plant
    plant.faults = BenchFaults(broken=frozenset({Channel.GRIP}))
    plant.place(real(apple.profile))
    assert ready.complete(apple).status is Status.SUCCEEDED
    ready.run(1.0)
    assert ready.state.grip is Grip.HOLDING
    plant.remove()
    ready.until(lambda: ready.state.grip is Grip.PART_LOST, 1.0)


def test_a_lost_part_is_not_held(holding: Stage) -> None:
    holding.rig.plant.remove()
    holding.until(lambda: holding.state.grip is Grip.PART_LOST, 0.5)
    assert holding.state.holding is None


def test_a_light_grip_without_its_sensor_is_not_taken_for_lost(
    ready: Stage, profiles: Profiles
) -> None:
    ready.rig.plant.faults = BenchFaults(broken=frozenset({Channel.GRIP}))
    ready.rig.plant.place(real(profiles["grape"]))
    command = ready.complete(ordered(profiles["grape"], Mode.FORCE))
    assert command.status is Status.SUCCEEDED
    ready.run(0.2)
    assert ready.state.grip is Grip.HOLDING


def test_a_grasp_that_waited_behind_a_grasp_does_not_squeeze_what_is_held(
    ready: Stage, profiles: Profiles
) -> None:
    # Something as tender as a grape where the next in line expects an apple.
    tender = replace(profiles["grape"], diameter=0.065)
    ready.rig.plant.place(real(tender))
    first = ready.submit(ordered(tender, Mode.FORCE, 2.0))
    second = ready.submit(ordered(profiles["apple"], Mode.FORCE))
    ready.until(lambda: ready.command(second).final)
    assert ready.command(first).status is Status.SUCCEEDED
    assert ready.failure(second).category == "precondition"
    assert ready.peak() < tender.damage_force


def test_disabled_it_holds_but_takes_no_command(holding: Stage) -> None:
    holding.gripper.disable(holding.instant)
    holding.run(1.0)
    with pytest.raises(Refused):
        holding.submit(None)
    assert holding.writes == []
    assert holding.state.grip is Grip.HOLDING


def test_enabling_moves_nothing(ready: Stage, apple: GraspOrder) -> None:
    ready.submit(apple)
    ready.gripper.disable(ready.instant)
    ready.run(0.1)
    ready.gripper.enable()
    ready.run(0.5)
    assert ready.writes == []


def test_one_wild_force_sample_does_not_drop_the_egg(
    ready: Stage, profiles: Profiles
) -> None:
    egg = profiles["raw_egg"]
    ready.rig.plant.place(real(egg))
    command = ready.submit(ordered(egg, Mode.FORCE))
    ready.until(lambda: ready.command(command).phase == "verify")
    wild = replace(ready.measure(), grip=Reading(99.0))
    ready.write(ready.gripper.period(wild, PERIOD, ready.instant))
    ready.until(lambda: ready.command(command).final)
    assert ready.command(command).status is Status.SUCCEEDED


def test_one_missing_force_sample_does_not_cost_the_size_check(
    ready: Stage, profiles: Profiles
) -> None:
    ready.rig.plant.place(replace(real(profiles["apple"]), diameter=0.035))
    command = ready.submit(ordered(profiles["apple"], Mode.FORCE))
    ready.until(lambda: ready.command(command).phase == "touch")
    for _ in range(6):
        missing = replace(ready.measure(), grip=Reading.bad("the loop is broken"))
        ready.write(ready.gripper.period(missing, PERIOD, ready.instant))
    ready.until(lambda: ready.command(command).final)
    assert ready.failure(command).code == "too_small"


def test_what_a_person_disabled_a_lost_link_does_not_enable(ready: Stage) -> None:
    ready.gripper.disable(ready.instant)
    ready.gripper.link_lost("gone", ready.instant)
    ready.run(0.5)
    assert ready.state.machine is Machine.DISABLED


def test_a_part_that_an_earlier_life_held_is_missed_when_it_is_gone(
    holding: Stage,
) -> None:
    holding.gripper.link_lost("gone", holding.instant)
    holding.run(0.2)
    assert (holding.state.grip, holding.state.adopted) == (Grip.HOLDING, True)
    holding.rig.plant.remove()
    holding.run(0.2)
    assert holding.state.grip is Grip.PART_LOST


def test_a_short_silence_of_the_force_sensor_is_not_taken_for_an_object(
    ready: Stage, apple: GraspOrder
) -> None:
    command = ready.submit(apple)
    ready.until(lambda: ready.command(command).phase == "touch")
    for _ in range(10):
        ready.pass_time()
        silent = replace(
            ready.measure(),
            grip=Reading.bad("the loop is broken"),
            opening=Reading.bad("the loop is broken"),
        )
        ready.write(ready.gripper.period(silent, PERIOD, ready.instant))
    ready.until(lambda: ready.command(command).final)
    assert ready.failure(command).code == "no_object"


def test_a_measurement_the_model_cannot_explain_is_told_in_the_log(
    ready: Stage, profiles: Profiles
) -> None:
    egg = profiles["raw_egg"]
    # The fixture's chain has no tolerances, so that any difference is beyond them.
    ready.rig.plant.faults = BenchFaults(valve_offset=30e3)
    ready.rig.plant.place(real(egg))
    command = ready.complete(ordered(egg, Mode.FORCE))
    assert command.status is Status.SUCCEEDED
    assert "valve, air, sensor or model is off" in command.log[-1]


@pytest.mark.parametrize("after", range(20, 40, 4))
def test_a_stall_of_the_loop_is_no_time_in_which_nothing_was_felt(
    ready: Stage, profiles: Profiles, after: int
) -> None:
    hasty = replace(profiles["apple"], approach=40e-3, ramp=20e-3)
    ready.rig.plant.place(real(hasty))
    command = ready.submit(ordered(hasty, Mode.CURRENT))
    for _ in range(after):
        ready.tick()
    ready.tick(0.5)
    ready.until(lambda: ready.command(command).final)
    assert ready.command(command).status is Status.SUCCEEDED


@pytest.mark.parametrize("order", [None, Adjust(force=20.0)])
@pytest.mark.parametrize("after", range(0, 60, 5))
def test_a_stall_while_something_is_held_ends_nothing(
    holding: Stage, order: Adjust | None, after: int
) -> None:
    command = holding.submit(order)
    for _ in range(after):
        holding.tick()
    holding.tick(2.0)
    holding.until(lambda: holding.command(command).final)
    assert holding.command(command).status is Status.SUCCEEDED


@pytest.mark.parametrize("after", range(0, 150, 10))
def test_a_stall_on_the_way_ends_no_move(ready: Stage, after: int) -> None:
    command = ready.submit(Move(opening=0.050))
    for _ in range(after):
        ready.tick()
    ready.tick(2.0)
    ready.until(lambda: ready.command(command).final)
    assert ready.command(command).status is Status.SUCCEEDED


@pytest.mark.parametrize("after", range(0, 160, 8))
def test_a_stall_is_no_time_in_which_a_force_could_be_corrected(
    holding: Stage, after: int
) -> None:
    # With another bore the feed-forward alone comes nowhere near.
    holding.gripper.use(holding.chain.varied("muscle.diameter", 0.001))
    command = holding.submit(Adjust(force=20.0))
    for _ in range(after):
        holding.tick()
    holding.tick(6.0)
    holding.until(lambda: holding.command(command).final)
    assert holding.command(command).status is Status.SUCCEEDED
