from collections.abc import Mapping
from dataclasses import replace

import pytest

from gripperd.bench.faults import BenchFaults
from gripperd.bench.sensors import Channel
from gripperd.control.command import GraspOrder, Status
from gripperd.control.profile import Mode, Profile
from gripperd.control.states import Machine
from gripperd.control.swap import swap
from gripperd.errors import Refused
from gripperd.model import Chain

from .stage import Stage, ordered, real


@pytest.fixture
def other(chain: Chain) -> Chain:
    """The same rig with a stiffer return spring: 20 N less pull, 5 N less grip."""
    linkage = replace(chain.linkage, spring_preload=260.0)
    return replace(chain, name="reference-1", linkage=linkage)


def refused(stage: Stage, other: Chain) -> Refused:
    """Why a swap is refused; the model is as it was then."""
    with pytest.raises(Refused) as refusal:
        swap([stage.gripper], other)
    assert stage.state.model == "reference"
    return refusal.value


def test_a_swap_at_rest_writes_nothing(ready: Stage, other: Chain) -> None:
    swap([ready.gripper], other)
    ready.run(0.5)
    assert ready.writes == []
    assert ready.state.model == "reference-1"
    assert ready.state.machine is Machine.READY


def test_the_next_grasp_goes_by_the_new_model(
    ready: Stage, other: Chain, profiles: Mapping[str, Profile]
) -> None:
    egg = profiles["raw_egg"]
    forces = []
    for chain in (ready.chain, other):
        swap([ready.gripper], chain)
        ready.rig.plant.place(real(egg))
        held = ready.complete(ordered(egg, Mode.CURRENT))
        assert held.status is Status.SUCCEEDED
        assert held.order is not None
        assert held.order.model == chain.name
        assert held.result is not None
        assert held.result.predicted_force is not None
        forces.append(held.result.predicted_force)
        ready.complete(None)
    assert forces[0] - forces[1] == pytest.approx(5.0, abs=0.2)


def test_a_broken_sensor_is_replaced_by_the_new_model(
    ready: Stage, other: Chain
) -> None:
    ready.rig.plant.faults = BenchFaults(broken=frozenset({Channel.GRIP}))
    measured = ready.measure()
    read = replace(
        measured,
        pressure=replace(measured.pressure, value=209_375.0),
        opening=replace(measured.opening, value=0.065),
    )
    swap([ready.gripper], other)
    # A single sample that leaps so far is not believed.
    for _ in range(3):
        ready.gripper.period(read, 0.01, ready.instant)
    state = ready.state.measured
    assert state is not None
    # The paper's 47.6 N on a rigid object of 65 mm, less the 5 N of the spring.
    assert state.grip.value == pytest.approx(42.6, abs=0.05)


def test_no_swap_while_an_object_is_held(holding: Stage, other: Chain) -> None:
    refusal = refused(holding, other)
    assert refusal.code == "object-held"
    assert str(refusal).startswith("g0 is ready, holding: its model stays")
    assert refusal.hints == ("release first",)


def test_no_swap_while_an_object_is_held_and_commands_are_not_allowed(
    holding: Stage, other: Chain
) -> None:
    holding.gripper.disable(holding.instant)
    assert refused(holding, other).code == "object-held"


def test_no_swap_while_nobody_knows_what_is_held(stage: Stage, other: Chain) -> None:
    stage.rig.plant.faults = BenchFaults(broken=frozenset(Channel))
    stage.rig.write_current(0.0107)
    stage.run(0.5)
    assert refused(stage, other).code == "object-held"


def test_no_swap_before_it_is_known_what_is_there(stage: Stage, other: Chain) -> None:
    for machine in (Machine.OFFLINE, Machine.ATTACHING):
        assert stage.state.machine is machine
        assert refused(stage, other).code == "wrong-state"
        stage.tick()


def test_no_swap_while_a_command_waits_runs_or_was_just_stopped(
    ready: Stage, other: Chain, apple: GraspOrder
) -> None:
    machines = []
    for happens in (lambda: ready.submit(apple), ready.tick, ready.stop):
        happens()
        machines.append(ready.state.machine)
        assert refused(ready, other).code == "wrong-state"
    assert machines == [Machine.READY, Machine.EXECUTING, Machine.STOPPING]


def test_of_two_grippers_both_go_by_it_or_none(
    ready: Stage, chain: Chain, other: Chain
) -> None:
    busy = Stage(chain, ready.rig, {"pressure": 600e3, "opening": 0.1, "grip": 100.0})
    with pytest.raises(Refused, match="g0 is offline"):
        swap([ready.gripper, busy.gripper], other)
    assert ready.state.model == busy.state.model == "reference"
