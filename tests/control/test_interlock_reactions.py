"""What an open contact makes the jaws do, where the settings want more than a stop."""

from collections.abc import Mapping
from dataclasses import replace

import pytest

from gripperd.bench.rig import Rig
from gripperd.control.command import GraspOrder
from gripperd.control.fault import Step
from gripperd.control.monitors.policy import POLICIES, Cause, Monitoring, Reaction
from gripperd.control.profile import Mode, Profile
from gripperd.control.states import Grip, Machine
from gripperd.errors import Refused
from gripperd.model import Chain
from gripperd.signals import Reading
from tests.conftest import SPANS

from .stage import PERIOD, Stage, ordered, real
from .test_interlocks import CLOSED, OPEN, control, machine

Profiles = Mapping[str, Profile]
OPENING = (Reaction.CONTROLLED_RELEASE, Reaction.VENT)
BOTH = (Cause.ESTOPPED, Cause.NOT_ENABLED)
CONTACT = {Cause.ESTOPPED: "estop", Cause.NOT_ENABLED: "enable"}


def reacting(cause: Cause, reaction: Reaction) -> Monitoring:
    latched = cause is Cause.ESTOPPED or reaction in OPENING
    policy = replace(POLICIES[cause], reaction=reaction, latched=latched)
    return Monitoring(policies={**POLICIES, cause: policy})


def held(chain: Chain, rig: Rig, profile: Profile, monitoring: Monitoring) -> Stage:
    """Holding something, with both contacts closed."""
    made = Stage(chain, rig, SPANS, monitoring)
    both(made, 0.1, CLOSED)
    made.rig.plant.place(real(profile))
    command = made.submit(ordered(profile, Mode.FORCE))
    while not made.command(command).final:
        both(made, PERIOD, CLOSED)
    both(made, 1.0, CLOSED)
    assert made.state.grip is Grip.HOLDING
    made.writes.clear()
    return made


def both(made: Stage, seconds: float, reading: Reading) -> None:
    control(made, seconds, estop=reading, enable=reading)


def opened(made: Stage, cause: Cause, seconds: float) -> None:
    contacts = {"estop": CLOSED, "enable": CLOSED} | {CONTACT[cause]: OPEN}
    control(made, seconds, **contacts)


@pytest.mark.parametrize("reaction", OPENING)
@pytest.mark.parametrize("cause", BOTH)
def test_a_contact_that_lets_go_opens_the_jaws_and_is_latched(
    chain: Chain, rig: Rig, profiles: Profiles, cause: Cause, reaction: Reaction
) -> None:
    made = held(chain, rig, profiles["apple"], reacting(cause, reaction))
    opened(made, cause, 4.0)
    assert made.rig.plant.current == pytest.approx(chain.regulator.current_low)
    assert made.state.grip is Grip.RELEASED
    stopped = Machine.ESTOPPED if cause is Cause.ESTOPPED else Machine.FAULT
    assert machine(made) is stopped
    (fault,) = made.state.faults
    assert (fault.cause, fault.reaction, fault.latched) == (cause, reaction, True)
    both(made, 2.0, CLOSED)
    assert machine(made) is stopped
    with pytest.raises(Refused):
        made.submit(None)


def test_a_vent_is_faster_than_a_controlled_release(
    chain: Chain, rig: Rig, profiles: Profiles
) -> None:
    made = held(chain, rig, profiles["apple"], reacting(Cause.ESTOPPED, Reaction.VENT))
    opened(made, Cause.ESTOPPED, 0.05)
    assert made.rig.plant.current == pytest.approx(chain.regulator.current_low)


@pytest.mark.parametrize("reaction", [Reaction.HOLD, Reaction.FREEZE])
@pytest.mark.parametrize("cause", BOTH)
def test_a_contact_that_freezes_writes_nothing_while_holding(
    chain: Chain, rig: Rig, profiles: Profiles, cause: Cause, reaction: Reaction
) -> None:
    profile = replace(profiles["apple"], compensate=False)
    made = held(chain, rig, profile, reacting(cause, reaction))
    opened(made, cause, 2.0)
    assert made.writes == []
    assert made.state.grip is Grip.HOLDING


@pytest.mark.parametrize("cause", BOTH)
def test_a_contact_that_is_open_at_the_start_moves_nothing(
    chain: Chain, rig: Rig, cause: Cause
) -> None:
    made = Stage(chain, rig, SPANS, reacting(cause, Reaction.VENT))
    made.write(0.0107)
    made.writes.clear()
    opened(made, cause, 1.0)
    assert made.writes == []
    (fault,) = made.state.faults
    assert (fault.cause, fault.reaction) == (cause, Reaction.FREEZE)
    both(made, 0.1, CLOSED)
    opened(made, cause, 1.0)
    assert made.rig.plant.current == pytest.approx(chain.regulator.current_low)


@pytest.mark.parametrize("cause", BOTH)
def test_a_reaction_does_not_outlive_a_lost_link(
    chain: Chain, rig: Rig, profiles: Profiles, cause: Cause
) -> None:
    monitoring = reacting(cause, Reaction.CONTROLLED_RELEASE)
    made = held(chain, rig, profiles["apple"], monitoring)
    opened(made, cause, 0.06)
    left = made.rig.plant.current
    assert chain.regulator.current_low < left < 0.01
    made.gripper.link_lost("cut", made.instant)
    made.writes.clear()
    opened(made, cause, 2.0)
    assert made.writes == []
    assert made.rig.plant.current == left


def test_an_emergency_stop_freezes_a_release_that_a_fault_began(
    chain: Chain, rig: Rig, profiles: Profiles
) -> None:
    monitoring = reacting(Cause.NOT_ENABLED, Reaction.CONTROLLED_RELEASE)
    made = held(chain, rig, profiles["apple"], monitoring)
    opened(made, Cause.NOT_ENABLED, 0.06)
    assert machine(made) is Machine.FAULT_REACTION
    control(made, 0.5, enable=OPEN, estop=OPEN)
    assert machine(made) is Machine.ESTOPPED
    left = made.rig.plant.current
    assert left > chain.regulator.current_low
    assert made.state.grip is not Grip.RELEASING
    control(made, 1.0, enable=OPEN, estop=OPEN)
    assert made.rig.plant.current == left


def test_a_reset_waits_for_the_jaws(chain: Chain, rig: Rig, profiles: Profiles) -> None:
    monitoring = reacting(Cause.ESTOPPED, Reaction.CONTROLLED_RELEASE)
    made = held(chain, rig, profiles["apple"], monitoring)
    opened(made, Cause.ESTOPPED, 0.05)
    both(made, 0.03, CLOSED)
    with pytest.raises(Refused, match="still opening"):
        made.gripper.reset(made.instant)
    made.stop()
    both(made, 0.5, CLOSED)
    assert made.rig.plant.current > chain.regulator.current_low
    made.gripper.reset(made.instant)
    assert machine(made) is Machine.DISABLED


def test_an_emergency_stop_is_a_fault_until_it_is_reset(
    ready: Stage, apple: GraspOrder
) -> None:
    both(ready, 0.1, CLOSED)
    control(ready, 0.5, estop=OPEN)
    (fault,) = ready.state.faults
    assert fault.way_out == (Step.MEND, Step.RESET, Step.ENABLE)
    both(ready, 1.5, CLOSED)
    (fault,) = ready.state.faults
    assert fault.way_out == (Step.RESET, Step.ENABLE)
    with pytest.raises(Refused, match="emergency stop is pressed"):
        ready.submit(apple)
    ready.gripper.reset(ready.instant)
    assert ready.state.faults == ()
    ready.gripper.enable()
    ready.submit(apple)


def test_without_the_enable_it_is_told_until_the_contact_closes(ready: Stage) -> None:
    both(ready, 0.1, CLOSED)
    control(ready, 0.5, enable=OPEN)
    (fault,) = ready.state.faults
    assert (fault.cause, fault.way_out) == (Cause.NOT_ENABLED, (Step.MEND,))
    both(ready, 1.5, CLOSED)
    assert ready.state.faults == ()
    assert machine(ready) is Machine.READY
