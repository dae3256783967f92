from collections.abc import Mapping

import pytest

from gripperd.bench.faults import BenchFaults
from gripperd.bench.sensors import Channel
from gripperd.control.profile import Mode, Profile
from gripperd.control.release import Release

from .stage import PERIOD, Stage, ordered, real


@pytest.fixture
def holding(stage: Stage, profiles: Mapping[str, Profile]) -> Stage:
    """An apple in the jaws, at 10.7 mA."""
    stage.rig.plant.place(real(profiles["apple"]))
    stage.grasp(ordered(profiles["apple"], Mode.CURRENT))
    return stage


def release(stage: Stage, *broken: Channel) -> bool:
    stage.rig.plant.faults = BenchFaults(broken=frozenset(broken))
    motion = Release(stage.chain, stage.rig.plant.current)
    opened = None
    start = stage.now
    while opened is None:
        assert stage.now < start + 10.0
        stage.pass_time()
        opened = motion.step(stage.measure(), PERIOD)
        stage.write(motion.ramp.current)
    return opened


@pytest.mark.parametrize(
    "broken",
    [
        (),
        (Channel.GRIP,),
        (Channel.PRESSURE,),
        (Channel.OPENING,),
        (Channel.GRIP, Channel.OPENING),
        tuple(Channel),
    ],
    ids=lambda broken: "+".join(broken) or "all sensors",
)
def test_the_jaws_let_go_whatever_sensor_is_broken(
    holding: Stage, broken: tuple[Channel, ...]
) -> None:
    assert release(holding, *broken)
    holding.pass_time(0.5)
    assert holding.rig.plant.grip == 0.0
    assert holding.rig.plant.current == pytest.approx(0.004)
    assert holding.rig.plant.opening == pytest.approx(0.085)


def test_the_current_never_goes_below_the_live_zero(holding: Stage) -> None:
    start = holding.now
    release(holding)
    released = [current for when, current in holding.writes if when > start]
    assert min(released) == pytest.approx(0.004)
    assert released == sorted(released, reverse=True)


def test_jaws_that_do_not_let_go_are_told(holding: Stage) -> None:
    # A valve that is stuck open: 30 kPa too much, whatever the current.
    motion = Release(holding.chain, holding.rig.plant.current)
    holding.rig.plant.faults = BenchFaults(valve_offset=30e3)
    opened = None
    while opened is None:
        holding.pass_time()
        opened = motion.step(holding.measure(), PERIOD)
        holding.write(motion.ramp.current)
    assert not opened


def test_a_module_at_zero_is_brought_to_the_live_zero(stage: Stage) -> None:
    assert stage.rig.plant.current == 0.0
    assert release(stage)
    assert stage.rig.plant.current == pytest.approx(0.004)
