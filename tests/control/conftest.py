from collections.abc import Mapping

import pytest

from gripperd.bench.rig import Rig
from gripperd.control.command import GraspOrder, Status
from gripperd.control.profile import Mode, Profile
from gripperd.model import Chain

from .stage import Stage, ordered, real


@pytest.fixture
def stage(chain: Chain, rig: Rig) -> Stage:
    """The simulated rig under control, just switched on."""
    return Stage(chain, rig, {"pressure": 600e3, "opening": 0.1, "grip": 100.0})


@pytest.fixture
def ready(stage: Stage) -> Stage:
    """The same, attached and enabled."""
    stage.run(0.1)
    return stage


@pytest.fixture
def apple(profiles: Mapping[str, Profile]) -> GraspOrder:
    """25 N on an apple."""
    return ordered(profiles["apple"], Mode.FORCE)


@pytest.fixture
def holding(ready: Stage, apple: GraspOrder) -> Stage:
    """A gripper that holds an apple with 25 N."""
    ready.rig.plant.place(real(apple.profile))
    assert ready.complete(apple).status is Status.SUCCEEDED
    ready.writes.clear()
    return ready
