from collections.abc import Callable, Mapping
from dataclasses import replace

import pytest

from gripperd.bench.faults import HEALTHY, BenchFaults
from gripperd.bench.sensors import Channel
from gripperd.control.command import GraspOrder, Status
from gripperd.control.monitors.policy import Cause
from gripperd.control.profile import Mode, Profile
from gripperd.control.states import Grip, Machine
from gripperd.errors import Refused

from .stage import Stage, ordered, real

Profiles = Mapping[str, Profile]


def test_a_current_set_by_others_is_adopted_not_fought(holding: Stage) -> None:
    holding.rig.write_current(0.0100)
    holding.run(0.5)
    assert holding.writes == []
    assert holding.rig.plant.current == 0.0100
    assert holding.state.adopted
    assert holding.state.current == pytest.approx(0.0100)
    assert holding.state.grip is Grip.HOLDING


def test_others_who_let_go_are_noticed(holding: Stage) -> None:
    holding.rig.write_current(0.004)
    holding.run(1.0)
    assert holding.writes == []
    assert holding.state.grip in {Grip.RELEASED, Grip.PART_LOST}


def test_others_who_grasp_are_noticed(ready: Stage, apple: GraspOrder) -> None:
    ready.rig.plant.place(real(apple.profile))
    ready.rig.write_current(0.0107)
    ready.run(2.0)
    assert ready.writes == []
    assert ready.state.grip is Grip.HOLDING
    with pytest.raises(Refused, match="an object is being held"):
        ready.submit(apple)


def test_others_on_the_output_end_the_command(ready: Stage, profiles: Profiles) -> None:
    apple = ordered(profiles["apple"], Mode.CURRENT)
    ready.rig.plant.place(real(apple.profile))
    command = ready.submit(apple)
    ready.until(lambda: ready.state.current == 0.0107)
    ready.writes.clear()
    ready.rig.write_current(0.0090)
    ready.run(0.5)
    ended = ready.command(command)
    assert ended.status is Status.FAILED
    failure = ready.failure(command)
    assert (failure.category, failure.code) == ("fault", "output-changed")
    assert "9.000 mA, not the 10.700 mA" in failure.message
    assert ready.writes == []
    assert ready.rig.plant.current == 0.0090
    assert ready.state.machine is Machine.READY


def test_a_lost_link_ends_every_command(ready: Stage, apple: GraspOrder) -> None:
    running, waiting = ready.submit(apple), ready.submit(None)
    ready.run(0.5)
    ready.gripper.link_lost("the peer closed the connection", ready.instant)
    for each in (running, waiting):
        assert ready.command(each).status is Status.FAILED
        failure = ready.failure(each)
        assert (failure.category, failure.code) == ("fault", "link-lost")
    state = ready.state
    assert (state.machine, state.grip) == (Machine.OFFLINE, Grip.UNKNOWN)
    assert state.current is None
    assert state.link == "the peer closed the connection"


def test_without_a_link_nobody_knows_what_is_held(holding: Stage) -> None:
    holding.gripper.link_lost("gone", holding.instant)
    assert holding.state.grip is Grip.UNKNOWN


def test_after_a_lost_link_what_is_held_is_adopted(holding: Stage) -> None:
    force = holding.rig.plant.grip
    for _ in range(3):
        holding.gripper.link_lost("gone", holding.instant)
    holding.pass_time(2.0)
    holding.run(1.0)
    assert holding.writes == []
    assert holding.rig.plant.grip == force
    state = holding.state
    assert (state.machine, state.grip, state.link) == (
        Machine.READY,
        Grip.HOLDING,
        "up",
    )
    assert state.adopted


def test_after_a_lost_link_what_has_not_moved_is_what_it_was(holding: Stage) -> None:
    before = holding.state.held
    assert before is not None
    holding.run(0.5)
    for _ in range(2):
        holding.gripper.link_lost("gone", holding.instant)
        holding.pass_time(2.0)
        holding.run(1.0)
    state = holding.state
    assert state.held is not None
    assert (state.holding, state.held.profile) == ("apple", before.profile)
    # Its current was found, not commanded: it is left alone.
    assert (state.held.force, holding.writes) == (None, [])


def swapped(stage: Stage) -> None:
    apple = stage.rig.plant.placed
    assert apple is not None
    stage.rig.plant.remove()
    stage.rig.plant.place(replace(apple.kind, diameter=60e-3))


def driven_by_others(stage: Stage) -> None:
    stage.rig.write_current(0.0105)


@pytest.mark.parametrize("happened", [swapped, driven_by_others])
def test_after_a_lost_link_what_has_changed_is_not_known(
    holding: Stage, happened: Callable[[Stage], None]
) -> None:
    holding.run(0.5)
    holding.gripper.link_lost("gone", holding.instant)
    happened(holding)
    holding.pass_time(2.0)
    holding.run(1.0)
    state = holding.state
    assert (state.grip, state.holding, state.held) == (Grip.HOLDING, None, None)


def test_what_moved_while_the_link_came_and_went_is_not_known(holding: Stage) -> None:
    holding.run(0.5)
    holding.gripper.link_lost("gone", holding.instant)
    swapped(holding)
    holding.pass_time(2.0)
    # Too short to be attached.
    holding.run(0.02)
    assert holding.state.machine is Machine.ATTACHING
    holding.gripper.link_lost("gone", holding.instant)
    holding.run(1.0)
    assert (holding.state.grip, holding.state.held) == (Grip.HOLDING, None)


def test_what_was_lost_without_a_link_is_missed(holding: Stage) -> None:
    holding.rig.plant.remove()
    for _ in range(2):
        holding.gripper.link_lost("gone", holding.instant)
        holding.pass_time(2.0)
        holding.run(0.5)
    state = holding.state
    assert (state.machine, state.grip) == (Machine.READY, Grip.PART_LOST)
    (fault,) = state.faults
    assert (fault.cause, fault.latched) == (Cause.PART_LOST, False)


def test_a_link_lost_while_closing_recovers_by_adoption(
    ready: Stage, apple: GraspOrder
) -> None:
    ready.submit(apple)
    ready.run(1.0)
    left = ready.rig.plant.current
    ready.gripper.link_lost("gone", ready.instant)
    ready.pass_time(1.0)
    ready.writes.clear()
    ready.run(1.0)
    assert ready.writes == []
    assert ready.state.current == pytest.approx(left)


def test_a_measurement_grows_old_while_the_link_is_down(ready: Stage) -> None:
    ready.gripper.link_lost("gone", ready.instant)
    ready.pass_time(2.0)
    assert ready.state.age == pytest.approx(2.0, abs=2e-3)


@pytest.mark.parametrize("broken", [frozenset(), frozenset(Channel)])
def test_a_grasp_and_a_release_repeat(
    ready: Stage, apple: GraspOrder, broken: frozenset[Channel]
) -> None:
    plant = ready.rig.plant
    plant.faults = BenchFaults(broken=broken) if broken else HEALTHY
    for _ in range(3):
        plant.place(real(apple.profile))
        ready.complete(apple)
        assert plant.grip == pytest.approx(25.0, abs=0.6)
        assert ready.complete(None).status is Status.SUCCEEDED
        ready.run(0.5)
        plant.remove()
