"""What a latched fault does to the jaws, and the way out of it."""

from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise

import pytest

from gripperd.bench.faults import HEALTHY, BenchFaults
from gripperd.control.command import Status
from gripperd.control.monitors.policy import (
    POLICIES,
    Cause,
    Monitoring,
    Reaction,
)
from gripperd.control.profile import Mode, Profile
from gripperd.control.states import Grip, Machine
from gripperd.errors import Refused
from gripperd.model import Chain
from tests.control.stage import Stage, ordered, real

from .monitors.watched import causes, faults, holding, stage

Profiles = Mapping[str, Profile]
LEAKS = BenchFaults(leak_rate=8.0)


def reacting(reaction: Reaction) -> Monitoring:
    """A leak is latched, with a reaction; nothing else is."""
    policies = {cause: replace(each, latched=False) for cause, each in POLICIES.items()}
    leak = replace(POLICIES[Cause.LEAK], reaction=reaction, latched=True)
    return Monitoring(policies={**policies, Cause.LEAK: leak})


def faulty(chain: Chain, profile: Profile, reaction: Reaction = Reaction.HOLD) -> Stage:
    """Holding, with a leak that was noticed and reacted to."""
    made = holding(chain, profile, monitoring=reacting(reaction))
    made.writes.clear()
    made.rig.plant.faults = LEAKS
    made.until(lambda: made.state.machine is Machine.FAULT, 5.0)
    return made


def acknowledged(made: Stage) -> None:
    for fault in faults(made):
        made.gripper.faults.acknowledge(fault.id, "Ada", made.instant)


@pytest.mark.parametrize("reaction", [Reaction.HOLD, Reaction.FREEZE])
def test_hold_and_freeze_leave_the_current_where_it_is(
    chain: Chain, profiles: Profiles, reaction: Reaction
) -> None:
    made = faulty(chain, profiles["apple"], reaction)
    made.run(2.0)
    assert made.writes == []
    assert made.state.grip is Grip.HOLDING


def test_a_controlled_release_ramps_down_and_opens(
    chain: Chain, profiles: Profiles
) -> None:
    made = faulty(chain, profiles["apple"], Reaction.CONTROLLED_RELEASE)
    currents = [current for _, current in made.writes]
    assert currents == sorted(currents, reverse=True)
    # 20 mA/s at 100 Hz.
    steps = [a - b for a, b in pairwise(currents)]
    assert max(steps) == pytest.approx(0.2e-3)
    assert currents[-1] == pytest.approx(0.004)
    assert made.state.grip is Grip.RELEASED
    assert made.rig.plant.grip == 0.0


def test_venting_goes_to_the_live_zero_in_one_step(
    chain: Chain, profiles: Profiles
) -> None:
    made = faulty(chain, profiles["apple"], Reaction.VENT)
    assert [current for _, current in made.writes] == [0.004]
    assert made.state.grip is Grip.RELEASED


def test_the_stronger_of_two_reactions_is_carried_out(
    chain: Chain, profiles: Profiles
) -> None:
    policies = {
        **reacting(Reaction.HOLD).policies,
        Cause.FORCE_DRIFT: replace(
            POLICIES[Cause.FORCE_DRIFT],
            reaction=Reaction.CONTROLLED_RELEASE,
            latched=True,
        ),
    }
    made = holding(chain, profiles["apple"], monitoring=Monitoring(policies=policies))
    made.rig.plant.faults = LEAKS
    made.until(lambda: made.state.machine is Machine.FAULT, 2.0)
    assert made.state.grip is Grip.HOLDING
    made.until(lambda: made.state.grip is Grip.RELEASED, 6.0)
    made.run(0.5)
    assert made.state.machine is Machine.FAULT


def test_a_stop_ends_a_reaction_where_it_is(chain: Chain, profiles: Profiles) -> None:
    apple = profiles["apple"]
    monitoring = reacting(Reaction.CONTROLLED_RELEASE)
    made = holding(chain, apple, monitoring=monitoring)
    made.rig.plant.faults = BenchFaults(leak_rate=4.0)
    made.until(lambda: made.state.machine is Machine.FAULT_REACTION, 5.0)
    made.run(0.03)
    made.stop()
    made.writes.clear()
    made.run(1.0)
    assert made.writes == []
    assert made.state.machine is Machine.FAULT
    assert made.rig.plant.current > 0.006


def test_a_command_that_runs_ends_with_the_cause(
    chain: Chain, profiles: Profiles
) -> None:
    made = stage(chain, 1)
    made.rig.plant.faults = BenchFaults(valve_stuck=True)
    running = made.submit(ordered(profiles["apple"], Mode.FORCE))
    made.tick()
    waiting = made.submit(None)
    made.until(lambda: made.state.machine is Machine.FAULT, 5.0)
    for command in (running, waiting):
        failure = made.failure(command)
        assert (failure.category, failure.code) == ("fault", "valve_not_following")


def test_commands_in_fault_are_refused_with_what_to_do(
    chain: Chain, profiles: Profiles
) -> None:
    made = faulty(chain, profiles["apple"])
    for order in (None, ordered(profiles["apple"], Mode.FORCE)):
        with pytest.raises(Refused, match="before a reset: muscle or tube") as refused:
            made.submit(order)
        assert refused.value.code == "wrong-state"
        assert refused.value.hints == (
            f"POST .../faults/{faults(made)[0].id}/acknowledge",
            "mend the cause",
            "POST .../reset",
            "POST .../enable",
        )
    with pytest.raises(Refused, match="before a reset: muscle or tube"):
        made.gripper.enable()


def test_a_cause_that_is_gone_needs_no_mending(
    chain: Chain, profiles: Profiles
) -> None:
    made = faulty(chain, profiles["apple"])
    made.rig.plant.faults = HEALTHY
    made.until(lambda: faults(made)[0].cleared_at is not None, 5.0)
    acknowledged(made)
    with pytest.raises(Refused) as refused:
        made.gripper.enable()
    assert refused.value.hints == ("POST .../reset", "POST .../enable")


def test_a_reset_waits_for_acknowledgement_and_for_the_cause_to_be_gone(
    chain: Chain, profiles: Profiles
) -> None:
    made = faulty(chain, profiles["apple"])
    with pytest.raises(Refused, match="not acknowledged yet: muscle or tube leak"):
        made.gripper.reset(made.instant)
    acknowledged(made)
    with pytest.raises(Refused, match="still so: muscle or tube leak"):
        made.gripper.reset(made.instant)
    made.rig.plant.faults = HEALTHY
    made.run(2.0)
    made.writes.clear()
    made.gripper.reset(made.instant)
    made.run(1.0)
    assert made.state.machine is Machine.DISABLED
    assert made.writes == []
    assert made.state.grip is Grip.HOLDING
    made.gripper.enable()
    assert made.complete(None).status is Status.SUCCEEDED


def test_a_reset_without_a_fault_is_refused(chain: Chain) -> None:
    made = stage(chain, 1)
    with pytest.raises(Refused, match=r"reset is not possible while .* ready"):
        made.gripper.reset(made.instant)


def test_after_a_reset_nothing_is_enabled_by_itself(
    chain: Chain, profiles: Profiles
) -> None:
    made = faulty(chain, profiles["apple"])
    acknowledged(made)
    made.rig.plant.faults = HEALTHY
    made.run(2.0)
    made.gripper.reset(made.instant)
    made.gripper.link_lost("the cable is out", made.instant)
    made.run(0.5)
    assert made.state.machine is Machine.DISABLED


def test_a_latched_fault_outlives_a_lost_link(chain: Chain, profiles: Profiles) -> None:
    made = faulty(chain, profiles["apple"])
    made.gripper.link_lost("the cable is out", made.instant)
    made.writes.clear()
    made.run(1.0)
    assert made.state.machine is Machine.FAULT
    assert made.writes == []


def test_what_is_not_latched_stops_nothing_and_goes_by_itself(
    chain: Chain, profiles: Profiles
) -> None:
    made = holding(chain, profiles["apple"])
    made.rig.plant.faults = BenchFaults(supply_pressure=145e3)
    made.run(1.0)
    assert made.state.machine is Machine.READY
    (sag,) = (fault for fault in faults(made) if fault.cause is Cause.SUPPLY_SAG)
    assert sag.active
    made.rig.plant.faults = HEALTHY
    made.run(2.0)
    (sag,) = (fault for fault in faults(made) if fault.cause is Cause.SUPPLY_SAG)
    assert not sag.active
    assert sag.cleared_at is not None


def test_a_profile_may_be_watched_more_closely(
    chain: Chain, profiles: Profiles
) -> None:
    strict = replace(profiles["apple"], force_drift=0.02)
    made = holding(chain, strict)
    made.rig.plant.faults = BenchFaults(leak_rate=2.0)
    made.run(8.0)
    assert Cause.FORCE_DRIFT in causes(made)
    usual = holding(chain, profiles["apple"])
    usual.rig.plant.faults = BenchFaults(leak_rate=2.0)
    usual.run(8.0)
    assert Cause.FORCE_DRIFT not in causes(usual)


def test_a_profile_may_not_be_watched_less_closely(
    chain: Chain, profiles: Profiles
) -> None:
    made = stage(chain, 1)
    lax = replace(profiles["apple"], slip_closing=0.001)
    made.rig.plant.place(real(lax))
    with pytest.raises(Refused, match=r"slip to 0\.001.* 0\.0004") as refused:
        made.submit(ordered(lax, Mode.FORCE))
    assert refused.value.code == "infeasible"


def test_a_stronger_reaction_takes_over_from_one_that_is_under_way(
    chain: Chain, profiles: Profiles
) -> None:
    policies = {
        **POLICIES,
        Cause.SLIP: replace(POLICIES[Cause.SLIP], latched=True),
        Cause.PART_LOST: replace(
            POLICIES[Cause.PART_LOST], reaction=Reaction.VENT, latched=True
        ),
    }
    made = holding(chain, profiles["apple"], monitoring=Monitoring(policies=policies))
    made.writes.clear()
    made.rig.plant.faults = BenchFaults(pad_friction=0.0)
    made.run(0.2)
    assert [fault.cause for fault in faults(made)] == [Cause.SLIP, Cause.PART_LOST]
    assert [current for _, current in made.writes] == [0.004]
