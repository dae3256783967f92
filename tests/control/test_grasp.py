from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import pytest

from gripperd.bench.faults import HEALTHY, BenchFaults
from gripperd.bench.placed import ObjectState
from gripperd.bench.sensors import Channel
from gripperd.control.command import Outcome
from gripperd.control.evaluation import check
from gripperd.control.grasp import Grasp
from gripperd.control.profile import Mode, Profile
from gripperd.model import Chain, Linkage
from gripperd.signals import Quality

from .stage import PERIOD, Stage, grasped, ordered

Profiles = Mapping[str, Profile]
BLIND = frozenset(Channel)


@pytest.mark.parametrize(
    ("name", "mode"),
    [(name, mode) for name in ("apple", "peach", "raw_egg", "grape") for mode in Mode],
)
def test_each_object_of_the_paper_is_held_as_predicted(
    stage: Stage, profiles: Profiles, name: str, mode: Mode
) -> None:
    profile = profiles[name]
    result = grasped(stage, profile, mode)
    placed = stage.rig.plant.placed
    assert result.outcome is Outcome.HELD
    assert placed is not None
    assert placed.state is ObjectState.HELD
    assert not placed.cracked
    assert result.force == pytest.approx(stage.rig.plant.grip, rel=0.02, abs=0.05)
    assert result.force == pytest.approx(result.predicted_force, rel=0.05)
    assert result.force_quality is Quality.GOOD
    assert result.size == pytest.approx(profile.diameter, abs=5e-4)
    assert result.slip_margin is not None
    assert result.slip_margin >= 1.5
    assert result.crush_margin is not None
    assert result.crush_margin >= 1.3
    if mode is Mode.FORCE:
        assert result.force == pytest.approx(profile.force, rel=0.03, abs=0.1)
    else:
        assert result.current == pytest.approx(0.0107)


class Case(NamedTuple):
    """What is between the jaws, or wrong with the rig, and what comes of it."""

    outcome: Outcome
    different: Mapping[str, float] = {}
    faults: BenchFaults = HEALTHY
    name: str = "apple"


CASES = {
    "as the profile says": Case(Outcome.HELD),
    "too small": Case(Outcome.TOO_SMALL, {"diameter": 0.0555}),
    "too large": Case(Outcome.TOO_LARGE, {"diameter": 0.0745}),
    "slippery and heavy": Case(Outcome.SLIPPED, {"mass": 3.0, "friction": 0.15}),
    "no sensor": Case(Outcome.UNKNOWN, faults=BenchFaults(broken=BLIND)),
}


@pytest.mark.parametrize(
    ("mode", "outcome"),
    # By force, what is felt decides; by current nothing holds the valve back.
    [(Mode.CURRENT, Outcome.CRUSH_LIMIT), (Mode.FORCE, Outcome.HELD)],
)
def test_a_valve_that_gives_too_much_does_not_crack_the_egg(
    stage: Stage, profiles: Profiles, mode: Mode, outcome: Outcome
) -> None:
    egg = profiles["raw_egg"]
    result = grasped(stage, egg, mode, BenchFaults(valve_offset=60e3))
    assert result.outcome is outcome
    assert stage.peak() < egg.damage_force


@pytest.mark.parametrize("mode", Mode)
@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_what_comes_of_a_grasp_is_told(
    stage: Stage, profiles: Profiles, case: Case, mode: Mode
) -> None:
    profile = profiles[case.name]
    result = grasped(stage, profile, mode, case.faults, **case.different)
    assert result.outcome is case.outcome
    placed = stage.rig.plant.placed
    assert placed is not None
    assert not placed.cracked


@pytest.mark.parametrize("mode", Mode)
@pytest.mark.parametrize("name", ["apple", "raw_egg", "grape"])
def test_closing_on_nothing_is_no_object(
    stage: Stage, profiles: Profiles, name: str, mode: Mode
) -> None:
    result = stage.grasp(ordered(profiles[name], mode))
    assert result.outcome is Outcome.NO_OBJECT
    assert result.size is None


def test_an_object_of_the_wrong_size_is_held_lightly(
    stage: Stage, profiles: Profiles
) -> None:
    grasped(stage, profiles["apple"], Mode.FORCE, diameter=0.0555)
    stage.pass_time(1.0)
    assert 0.0 < stage.rig.plant.grip < 5.0


@pytest.mark.parametrize("mode", Mode)
@pytest.mark.parametrize(
    ("smaller", "larger"), [(0.0028, 0.0), (0.0, 0.0038)], ids=["small", "large"]
)
def test_sizes_within_the_tolerance_are_held(
    stage: Stage, profiles: Profiles, mode: Mode, smaller: float, larger: float
) -> None:
    egg = profiles["raw_egg"]
    diameter = egg.diameter - smaller + larger
    result = grasped(stage, egg, mode, diameter=diameter)
    assert result.outcome is Outcome.HELD
    assert result.size == pytest.approx(diameter, abs=5e-4)


def test_the_ramp_is_no_faster_than_the_profile_allows(
    stage: Stage, profiles: Profiles
) -> None:
    egg = profiles["raw_egg"]
    grasped(stage, egg, Mode.FORCE)
    # The second rate counts from a diameter of 47 mm on, CLEARANCE included.
    near = float(stage.chain.current(0.0, 0.047))
    writes = [current for _, current in stage.writes]
    for before, now in pairwise(writes):
        rate = egg.approach if now <= near + 1e-9 else egg.ramp
        assert now - before <= rate * PERIOD + 1e-9
    assert max(writes) > near


def test_it_takes_the_time_it_says(stage: Stage, profiles: Profiles) -> None:
    result = grasped(stage, profiles["apple"], Mode.CURRENT)
    assert result.duration == pytest.approx(stage.now)


def test_an_empty_grip_has_no_margins(stage: Stage, profiles: Profiles) -> None:
    for profile in profiles.values():
        result = stage.grasp(ordered(profile, Mode.CURRENT))
        assert result.outcome is Outcome.NO_OBJECT
        assert (result.slip_margin, result.crush_margin) == (None, None)


def test_a_stall_does_not_make_the_current_jump(
    stage: Stage, profiles: Profiles
) -> None:
    apple = profiles["apple"]
    grasp = Grasp(ordered(apple, Mode.FORCE), stage.chain, 0.004)
    grasp.step(stage.measure(), 1.0)
    assert grasp.ramp.current <= 0.004 + apple.approach * 0.1


def test_jaws_that_cannot_close_all_the_way_grasp_all_the_same(
    chain: Chain, profiles: Profiles
) -> None:
    linkage = Linkage(
        open_width=0.085, ratio=0.9, spring_preload=100.0, spring_rate=100.0
    )
    order = ordered(profiles["apple"], Mode.FORCE)
    check(order, replace(chain, linkage=linkage))
    Grasp(order, replace(chain, linkage=linkage), 0.004)
