from dataclasses import replace

import pytest

from gripperd.control.command import GraspOrder, Status
from gripperd.control.interlocks import Interlocks
from gripperd.control.states import Grip, Machine
from gripperd.errors import Refused
from gripperd.signals import Measurement, Reading

from .stage import PERIOD, Stage

CURRENT = Reading(0.0107)
CLOSED, OPEN = Reading(1.0), Reading(0.0)
NOTHING = Measurement(time=0.0, current=CURRENT)


def seen(*measurements: Measurement) -> Interlocks:
    interlocks = Interlocks()
    for each in measurements:
        interlocks.update(each)
    return interlocks


def control(stage: Stage, seconds: float, **contacts: Reading) -> None:
    """Control for a while, with contacts."""
    for _ in range(round(seconds / PERIOD)):
        stage.pass_time()
        measured = replace(stage.measure(), **contacts)  # type: ignore[arg-type]
        stage.write(stage.gripper.period(measured, PERIOD, stage.instant))


def machine(stage: Stage) -> Machine:
    return stage.state.machine


def test_contacts_that_are_not_fitted_forbid_nothing() -> None:
    interlocks = seen(NOTHING, NOTHING, NOTHING)
    assert interlocks.enabled
    assert not interlocks.estopped


@pytest.mark.parametrize(
    ("reading", "closed"),
    [
        (CLOSED, True),
        (Reading(0.51), True),
        (Reading(0.5), False),
        (OPEN, False),
        (Reading.bad("the loop is broken: 0.000 mA is below 3.6 mA"), False),
    ],
)
def test_only_a_loop_that_says_so_is_closed(reading: Reading, closed: bool) -> None:
    measured = replace(NOTHING, enable=reading, estop=reading)
    interlocks = seen(measured, measured)
    assert interlocks.enabled is closed
    assert interlocks.estopped is not closed


def test_one_sample_is_not_believed() -> None:
    closed, opened = replace(NOTHING, estop=CLOSED), replace(NOTHING, estop=OPEN)
    assert not seen(closed, opened, closed, opened).estopped
    assert seen(closed, opened, opened).estopped
    assert seen(opened, opened, closed).estopped


def test_an_emergency_stop_freezes_what_is_held_and_latches(holding: Stage) -> None:
    current = holding.rig.plant.current
    control(holding, 0.05, estop=CLOSED)
    control(holding, 1.0, estop=OPEN)
    assert machine(holding) is Machine.ESTOPPED
    assert holding.rig.plant.current == pytest.approx(current, abs=2e-4)
    control(holding, 1.0, estop=CLOSED)
    assert machine(holding) is Machine.ESTOPPED
    holding.gripper.reset(holding.instant)
    assert machine(holding) is Machine.DISABLED
    holding.gripper.enable()
    control(holding, 0.5, estop=CLOSED)
    assert holding.state.grip is Grip.HOLDING


def test_an_emergency_stop_ends_every_command(ready: Stage, apple: GraspOrder) -> None:
    running, waiting = ready.submit(apple), ready.submit(None)
    control(ready, 0.3, estop=CLOSED)
    assert ready.command(running).status is Status.RUNNING
    control(ready, 0.03, estop=OPEN)
    assert ready.failure(running).code == ready.failure(waiting).code == "estopped"
    ready.writes.clear()
    control(ready, 1.0, estop=OPEN)
    assert ready.writes == []


def test_an_emergency_stop_that_is_pressed_cannot_be_reset(ready: Stage) -> None:
    control(ready, 0.1, estop=OPEN)
    with pytest.raises(Refused, match="emergency stop is pressed") as refused:
        ready.gripper.reset(ready.instant)
    assert refused.value.code == "estopped"
    assert machine(ready) is Machine.ESTOPPED


def test_the_state_is_adopted_before_an_emergency_stop_that_is_pressed_at_the_start(
    stage: Stage, apple: GraspOrder
) -> None:
    stage.write(0.0107)
    stage.writes.clear()
    control(stage, 0.2, estop=OPEN)
    assert machine(stage) is Machine.ESTOPPED
    assert stage.state.current == pytest.approx(0.0107)
    with pytest.raises(Refused):
        stage.submit(apple)
    assert stage.writes == []


def test_without_the_enable_no_motion_begins(ready: Stage, apple: GraspOrder) -> None:
    control(ready, 0.05, enable=OPEN)
    ready.writes.clear()
    with pytest.raises(Refused, match="enable is open, or its wire is cut") as refused:
        ready.submit(apple)
    assert refused.value.code == "not-enabled"
    assert "close the contact" in refused.value.hints[0]
    control(ready, 0.5, enable=OPEN)
    assert ready.writes == []
    control(ready, 0.05, enable=CLOSED)
    assert ready.submit(apple).status is Status.QUEUED


def test_a_motion_ends_when_the_enable_goes(ready: Stage, apple: GraspOrder) -> None:
    command = ready.submit(apple)
    control(ready, 0.3, enable=CLOSED)
    control(ready, 0.03, enable=OPEN)
    assert ready.failure(command).code == "not-enabled"
    assert machine(ready) is Machine.STOPPING
    control(ready, 0.5, enable=OPEN)
    assert machine(ready) is Machine.READY


def test_what_is_held_stays_held_without_the_enable(holding: Stage) -> None:
    current = holding.rig.plant.current
    control(holding, 2.0, enable=OPEN)
    assert holding.state.grip is Grip.HOLDING
    assert holding.rig.plant.current == pytest.approx(current, abs=2e-4)


def test_an_emergency_stop_takes_back_the_current_that_is_ahead_of_the_pressure(
    ready: Stage, apple: GraspOrder
) -> None:
    ready.submit(apple)
    while ready.rig.plant.current < 7e-3:
        control(ready, PERIOD, estop=CLOSED)
    ahead = ready.rig.plant.current
    control(ready, 0.5, estop=OPEN)
    regulator = ready.chain.regulator
    wanted = float(regulator.pressure(ready.rig.plant.current))
    assert ready.rig.plant.current < ahead
    assert ready.rig.plant.pressure == pytest.approx(wanted, abs=3e3)
