from collections.abc import Mapping

import pytest

from gripperd.bench.faults import BenchFaults
from gripperd.bench.placed import ObjectState
from gripperd.control.command import GraspOrder, Status
from gripperd.control.profile import Mode, Profile
from gripperd.control.states import Grip, Machine
from gripperd.errors import NotFound, Refused

from .stage import PERIOD, Stage, ordered, real

Profiles = Mapping[str, Profile]
CREEP = 1e-3
"""Slower than this the jaws are at rest. [m/s]"""


@pytest.mark.parametrize("periods", [1, 30, 60, 90, 100, 110, 120, 140, 170])
@pytest.mark.parametrize("name", ["apple", "raw_egg"])
def test_a_stop_freezes_the_jaws_within_100_ms(
    ready: Stage, profiles: Profiles, name: str, periods: int
) -> None:
    ready.rig.plant.place(real(profiles[name]))
    command = ready.submit(ordered(profiles[name], Mode.FORCE))
    ready.run(periods * PERIOD)
    force, since = ready.rig.plant.grip, ready.now
    ready.stop()
    assert ready.command(command).status is Status.CANCELLED
    assert ready.failure(command).code == "stopped"
    ready.run(1.0)
    assert ready.speed(since + 0.1) < CREEP
    assert ready.state.machine is Machine.READY
    # What is felt stays held, with about the force it had.
    assert ready.rig.plant.grip == pytest.approx(force, rel=0.1, abs=1.0)
    assert (ready.state.grip is Grip.HOLDING) == (force > 1.0)
    held = ready.state.held
    assert (held and held.profile.name) == (name if force > 1.0 else None)


@pytest.mark.parametrize("periods", [100, 110, 120])
def test_a_stop_is_written_at_once(
    ready: Stage, apple: GraspOrder, periods: int
) -> None:
    ready.submit(apple)
    ready.run(periods * PERIOD)
    moving = ready.writes[-1][1]
    change = ready.gripper.stop(ready.instant)
    assert change is not None
    assert change < moving


def test_a_stop_while_holding_changes_nothing(holding: Stage) -> None:
    force = holding.rig.plant.grip
    for _ in range(20):
        holding.stop()
        holding.run(0.1)
    assert holding.writes == []
    assert holding.rig.plant.grip == force
    assert (holding.state.grip, holding.state.holding) == (Grip.HOLDING, "apple")


@pytest.mark.parametrize("offset", [-30e3, 0.0, 30e3])
def test_a_stop_at_rest_writes_nothing(
    ready: Stage, apple: GraspOrder, offset: float
) -> None:
    ready.complete(apple)
    ready.rig.plant.faults = BenchFaults(valve_offset=offset)
    ready.run(1.0)
    ready.writes.clear()
    for _ in range(20):
        ready.stop()
        ready.run(0.4)
    assert ready.writes == []


@pytest.mark.parametrize("periods", [1, 3, 5, 7, 9])
@pytest.mark.parametrize("name", ["apple", "raw_egg"])
def test_a_stop_during_a_release_keeps_what_is_still_held(
    ready: Stage, profiles: Profiles, name: str, periods: int
) -> None:
    ready.rig.plant.place(real(profiles[name]))
    ready.complete(ordered(profiles[name], Mode.FORCE))
    ready.submit(None)
    ready.run(periods * PERIOD)
    assert ready.rig.plant.grip > 3 * profiles[name].slip_force
    ready.stop()
    ready.run(2.0)
    placed = ready.rig.plant.placed
    assert placed is not None
    assert placed.state is ObjectState.HELD
    assert (ready.state.grip, ready.state.holding) == (Grip.HOLDING, name)
    held = ready.state.held
    assert held is not None
    # The current stays as it is by now; nobody goes back to the force it had.
    assert (held.profile.name, held.force) == (name, None)


def test_a_stop_empties_the_queue(ready: Stage, apple: GraspOrder) -> None:
    commands = [ready.submit(apple), ready.submit(None), ready.submit(None)]
    ready.run(0.5)
    ready.stop()
    assert {ready.command(each).status for each in commands} == {Status.CANCELLED}
    ready.run(3.0)
    assert ready.state.machine is Machine.READY
    assert ready.rig.plant.opening > 0.08


def test_while_stopping_nothing_can_be_started(ready: Stage, apple: GraspOrder) -> None:
    ready.stop()
    with pytest.raises(Refused, match="while the gripper is stopping"):
        ready.submit(apple)


def test_without_a_link_a_stop_is_refused_not_claimed(stage: Stage) -> None:
    with pytest.raises(Refused, match="while the gripper is offline"):
        stage.gripper.stop(stage.instant)


@pytest.mark.parametrize("offset", [-30e3, 30e3])
def test_a_stop_trusts_no_valve_that_is_off(
    ready: Stage, profiles: Profiles, offset: float
) -> None:
    egg = profiles["raw_egg"]
    ready.rig.plant.faults = BenchFaults(valve_offset=offset)
    ready.rig.plant.place(real(egg))
    ready.submit(ordered(egg, Mode.FORCE))
    ready.run(1.7)
    since = ready.now
    ready.stop()
    ready.run(1.0)
    assert ready.speed(since + 0.1) < CREEP
    assert ready.peak() < egg.damage_force


def test_a_cancelled_motion_freezes(ready: Stage, apple: GraspOrder) -> None:
    command = ready.submit(apple)
    ready.run(1.1)
    assert ready.rig.plant.velocity > CREEP
    since = ready.now
    ready.write(ready.gripper.cancel(command.id, ready.instant))
    assert ready.command(command).status is Status.CANCELLED
    ready.run(1.0)
    assert ready.speed(since + 0.1) < CREEP
    assert ready.state.machine is Machine.READY


def test_a_cancelled_command_in_the_queue_never_starts(
    ready: Stage, apple: GraspOrder
) -> None:
    first, second = ready.submit(apple), ready.submit(None)
    ready.tick()
    assert ready.gripper.cancel(second.id, ready.instant) is None
    assert ready.command(first).status is Status.RUNNING
    ready.until(lambda: ready.command(first).final)
    ready.run(0.5)
    assert ready.command(second).status is Status.CANCELLED
    assert ready.command(second).started_at is None


def test_what_is_over_cannot_be_cancelled(ready: Stage) -> None:
    command = ready.complete(None)
    with pytest.raises(Refused, match="is over: succeeded") as refused:
        ready.gripper.cancel(command.id, ready.instant)
    assert refused.value.code == "already-final"


def test_what_is_not_there_cannot_be_cancelled(ready: Stage) -> None:
    with pytest.raises(NotFound, match="'c99'") as missing:
        ready.gripper.cancel("c99", ready.instant)
    assert missing.value.key == "id"


@pytest.mark.parametrize("deadline", [0.005, 0.5, 1.1, 1.3])
def test_every_command_ends_by_its_deadline_and_the_jaws_with_it(
    ready: Stage, apple: GraspOrder, deadline: float
) -> None:
    ready.rig.plant.place(real(apple.profile))
    command = ready.submit(apple, deadline=deadline)
    since = ready.now
    ready.run(deadline + 2 * PERIOD)
    ended = ready.command(command)
    assert ended.status is Status.FAILED
    failure = ready.failure(command)
    assert (failure.category, failure.code) == ("fault", "deadline")
    assert f"within {deadline:g} s" in failure.message
    assert ended.completed_at is not None
    assert ended.completed_at - ended.created_at <= deadline + 1.5 * PERIOD
    ready.run(1.0)
    assert ready.speed(since + deadline + 0.12) < CREEP
    assert ready.state.machine is Machine.READY
    # What was written last is where it stays: nobody else has touched the output.
    assert not ready.state.adopted or not ready.writes


def test_a_command_that_waits_too_long_ends_too(
    ready: Stage, apple: GraspOrder
) -> None:
    first = ready.submit(apple)
    second = ready.submit(None, deadline=0.1)
    ready.run(0.2)
    assert ready.failure(second).code == "deadline"
    assert ready.command(first).status is Status.RUNNING
