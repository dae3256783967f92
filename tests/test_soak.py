"""A small part of `make soak`, and that it would see what should not be."""

import pytest

from gripperd.config import Settings, load_settings, shipped
from tests.control.monitors import watched
from tests.control.stage import Stage
from tests.soak.case import Watch, case

UNFELT = 158
"""A grasp of a grape that hangs between the jaws already, too light to be felt."""
SEEDS = (UNFELT, *range(2001, 2021))


@pytest.fixture(scope="module")
def settings() -> Settings:
    return load_settings(shipped("gripperd.yaml"), {})


@pytest.fixture
def egg(settings: Settings) -> Stage:
    """A raw egg, held."""
    (gripper,) = settings.grippers.values()
    return watched.holding(gripper.chain, settings.profiles["raw_egg"])


@pytest.mark.parametrize("seed", SEEDS)
def test_nothing_is_dropped_crushed_or_lost_in_silence(
    settings: Settings, seed: int
) -> None:
    assert case(settings, seed).objections == ()


def test_the_same_seed_is_the_same_case(settings: Settings) -> None:
    assert case(settings, SEEDS[0]) == case(settings, SEEDS[0])


def test_a_drop_would_be_seen(egg: Stage) -> None:
    watch = Watch(egg)
    watch.look()
    egg.rig.write_current(0.004)
    watch.run(2.0)
    assert list(watch.objections("nothing")) == ["dropped"]


def test_a_crushed_egg_would_be_seen(egg: Stage) -> None:
    watch = Watch(egg)
    egg.rig.write_current(0.019)
    watch.run(0.5)
    assert "crushed" in list(watch.objections("nothing"))


def test_a_silent_loss_would_be_seen(egg: Stage) -> None:
    watch = Watch(egg)
    watch.look()
    egg.rig.plant.remove()
    # Nobody looks at the sensors, so the state goes on saying that it is held.
    for _ in range(200):
        egg.pass_time()
        watch.look()
    assert list(watch.objections("pulled out")) == ["lost in silence"]


def test_a_command_past_its_deadline_would_be_seen(egg: Stage) -> None:
    watch = Watch(egg)
    egg.submit(None, deadline=0.5)
    for _ in range(100):
        egg.pass_time()
        watch.look()
    assert "a command outlived its deadline" in list(watch.objections("stop"))
