"""Every monitor sees its fault of the bench within the time that is promised."""

import re
from collections.abc import Mapping
from dataclasses import replace

import pytest

from gripperd.bench.faults import BenchFaults
from gripperd.bench.sensors import Channel
from gripperd.control.command import Status
from gripperd.control.monitors.policy import DETECTION, POLICIES, Cause
from gripperd.control.profile import Mode, Profile
from gripperd.control.states import Grip, Machine
from gripperd.control.task import Adjust
from gripperd.model import Chain
from tests.control.stage import Stage, ordered, real

from .watched import appeared, causes, faults, holding, noticed, pressing, stage

Profiles = Mapping[str, Profile]
OBJECTS = ("apple", "peach", "raw_egg", "grape")


@pytest.mark.parametrize("name", OBJECTS)
@pytest.mark.parametrize(
    ("cause", "broken"),
    [
        (Cause.SLIP, BenchFaults(pad_friction=0.0)),
        (Cause.SLIP, BenchFaults(pull=200.0)),
        (Cause.SUPPLY_SAG, BenchFaults(supply_pressure=80e3)),
        (Cause.SUPPLY_SAG, BenchFaults(supply_pressure=145e3)),
        (Cause.LEAK, BenchFaults(leak_rate=8.0)),
        (Cause.BURST, BenchFaults(leak_rate=50.0)),
        (Cause.VALVE_NOT_FOLLOWING, BenchFaults(valve_offset=60e3)),
        (Cause.SENSOR_FAILED, BenchFaults(broken=frozenset({Channel.GRIP}))),
        (Cause.SENSOR_FAILED, BenchFaults(broken=frozenset({Channel.PRESSURE}))),
        (Cause.SENSOR_FAILED, BenchFaults(shorted=frozenset({Channel.GRIP}))),
        (Cause.SENSOR_FAILED, BenchFaults(shorted=frozenset({Channel.OPENING}))),
        (Cause.SENSOR_FAILED, BenchFaults(frozen=frozenset({Channel.GRIP}))),
        (Cause.SENSOR_FAILED, BenchFaults(frozen=frozenset({Channel.PRESSURE}))),
        (Cause.SENSOR_FAILED, BenchFaults(frozen=frozenset({Channel.OPENING}))),
    ],
)
def test_a_fault_while_holding_is_noticed_in_time(
    chain: Chain, profiles: Profiles, name: str, cause: Cause, broken: BenchFaults
) -> None:
    made = holding(chain, profiles[name])
    noticed(made, cause, broken, DETECTION[cause])


@pytest.mark.parametrize("name", OBJECTS)
def test_a_part_that_is_taken_away_is_noticed_in_time(
    chain: Chain, profiles: Profiles, name: str
) -> None:
    made = holding(chain, profiles[name])
    made.rig.plant.remove()
    _, fault = appeared(made, Cause.PART_LOST, DETECTION[Cause.PART_LOST])
    told = re.fullmatch(
        rf"{name} is gone from the jaws: ([\d.]+) N at .* mm became 0\.\d N at .* mm",
        fault.message,
    )
    assert told is not None
    assert float(told[1]) == pytest.approx(profiles[name].force, rel=0.05)
    assert made.state.grip is Grip.PART_LOST
    assert made.state.machine is Machine.READY


def test_a_lost_part_was_held_as_hard_as_it_was_adjusted_to(
    chain: Chain, profiles: Profiles
) -> None:
    made = holding(chain, profiles["apple"])
    assert made.complete(Adjust(force=20.0)).status is Status.SUCCEEDED
    made.run(1.0)
    made.rig.plant.remove()
    _, fault = appeared(made, Cause.PART_LOST, DETECTION[Cause.PART_LOST])
    told = re.search(r"jaws: ([\d.]+) N", fault.message)
    assert told is not None
    assert float(told[1]) == pytest.approx(20.0, rel=0.05)


def test_a_hole_and_an_empty_supply_are_told_apart(
    chain: Chain, profiles: Profiles
) -> None:
    for broken, expected, others in (
        (BenchFaults(leak_rate=8.0), Cause.LEAK, {Cause.BURST, Cause.SUPPLY_SAG}),
        (BenchFaults(leak_rate=50.0), Cause.BURST, {Cause.LEAK, Cause.SUPPLY_SAG}),
        (
            BenchFaults(supply_pressure=0.0),
            Cause.SUPPLY_SAG,
            {Cause.LEAK, Cause.BURST},
        ),
    ):
        made = holding(chain, profiles["apple"])
        made.rig.plant.faults = broken
        made.run(1.0)
        assert expected in causes(made)
        assert not others & causes(made)


def test_a_force_that_goes_away_slowly_is_noticed(
    chain: Chain, profiles: Profiles
) -> None:
    made = holding(chain, profiles["apple"])
    # 5.7 % of the pressure, less than what counts as a leak, are more than 2.5 N.
    made.rig.plant.faults = BenchFaults(leak_rate=3.0)
    _, fault = appeared(made, Cause.FORCE_DRIFT, DETECTION[Cause.FORCE_DRIFT])
    assert "25.0 N per jaw became 2" in fault.message
    assert "2.5 N are allowed" in fault.message


def test_a_part_that_is_held_too_hard_is_eased(
    chain: Chain, profiles: Profiles
) -> None:
    egg = profiles["raw_egg"]
    made = holding(chain, egg)
    _, fault = noticed(
        made,
        Cause.OVER_FORCE,
        BenchFaults(valve_offset=40e3),
        DETECTION[Cause.OVER_FORCE],
    )
    assert "it is damaged at 35 N" in fault.message
    made.until(lambda: made.state.machine is Machine.FAULT)
    assert made.peak() < 35.0
    assert made.rig.plant.grip < 35.0 / 1.3
    assert made.rig.plant.grip > egg.slip_force
    assert made.state.grip is Grip.HOLDING


def test_a_valve_that_ignores_a_release_is_noticed_in_time(
    chain: Chain, profiles: Profiles
) -> None:
    made = holding(chain, profiles["apple"])
    made.rig.plant.faults = BenchFaults(valve_stuck=True)
    made.run(5.0)
    assert causes(made) == set(), "nothing is asked of it, so nothing can be seen"
    release = made.submit(None)
    _, fault = appeared(
        made, Cause.VALVE_NOT_FOLLOWING, DETECTION[Cause.VALVE_NOT_FOLLOWING]
    )
    assert "kPa where 4.00 mA ask for 0 kPa" in fault.message
    assert made.failure(release).code == "valve_not_following"


@pytest.mark.parametrize("after", [0.05, 0.3, 1.0])
def test_a_valve_that_goes_off_right_after_a_grasp_is_not_taken_for_normal(
    chain: Chain, profiles: Profiles, after: float
) -> None:
    made = stage(chain, 1)
    made.rig.plant.place(real(profiles["apple"]))
    made.complete(ordered(profiles["apple"], Mode.FORCE))
    made.run(after)
    made.rig.plant.faults = BenchFaults(valve_offset=60e3)
    appeared(made, Cause.VALVE_NOT_FOLLOWING, 2.0)


def test_a_valve_that_ignores_a_grasp_is_noticed(
    chain: Chain, profiles: Profiles
) -> None:
    made = stage(chain, 1)
    made.rig.plant.place(real(profiles["apple"]))
    made.rig.plant.faults = BenchFaults(valve_stuck=True)
    grasp = made.submit(ordered(profiles["apple"], Mode.FORCE))
    made.until(lambda: (made.state.current or 0.0) > 0.0055)
    appeared(made, Cause.VALVE_NOT_FOLLOWING, DETECTION[Cause.VALVE_NOT_FOLLOWING])
    assert causes(made) == {Cause.VALVE_NOT_FOLLOWING}
    assert made.failure(grasp).code == "valve_not_following"


def test_a_supply_that_sags_between_two_grasps_is_not_taken_for_the_valve(
    chain: Chain, profiles: Profiles
) -> None:
    made = holding(chain, profiles["apple"])
    assert made.complete(None).status is Status.SUCCEEDED
    made.rig.plant.faults = BenchFaults(supply_pressure=140e3)
    made.rig.plant.place(real(profiles["apple"]))
    made.complete(ordered(profiles["apple"], Mode.FORCE))
    made.run(2.0)
    assert Cause.SUPPLY_SAG in causes(made)
    assert Cause.VALVE_NOT_FOLLOWING not in causes(made)


@pytest.mark.parametrize("approach", [8e-3, 3e-3])
def test_blocked_jaws_are_noticed_and_let_down(
    chain: Chain, profiles: Profiles, approach: float
) -> None:
    made = stage(chain, 1)
    made.rig.plant.faults = BenchFaults(jaws_blocked=True)
    apple = replace(profiles["apple"], approach=approach)
    made.submit(ordered(apple, Mode.FORCE))
    limit = POLICIES[Cause.JAW_BLOCKED].limit
    assert limit is not None
    pressing(made, limit, 10.0)
    _, fault = appeared(made, Cause.JAW_BLOCKED, DETECTION[Cause.JAW_BLOCKED])
    assert "the jaws do not close: they stand at 85." in fault.message
    made.until(lambda: made.state.machine is Machine.FAULT)
    made.run(0.5)
    assert made.rig.plant.pressure < 5e3


def test_a_pressure_sensor_that_stops_is_not_taken_for_the_valve(
    chain: Chain, profiles: Profiles
) -> None:
    made = holding(chain, profiles["apple"])
    made.rig.plant.faults = BenchFaults(frozen=frozenset({Channel.PRESSURE}))
    release = made.complete(None)
    made.run(1.0)
    assert release.status is Status.SUCCEEDED
    assert {(fault.cause, fault.subject) for fault in faults(made)} == {
        (Cause.SENSOR_FAILED, "pressure")
    }


def test_a_module_that_restarts_while_holding_is_a_fault_and_never_driven_again(
    chain: Chain, profiles: Profiles
) -> None:
    made = holding(chain, profiles["apple"])
    made.writes.clear()
    made.rig.write_current(0.0)
    _, fault = appeared(made, Cause.MODULE_RESTARTED, DETECTION[Cause.MODULE_RESTARTED])
    assert "reads 0.000 mA where 9.5" in fault.message
    made.run(3.0)
    assert made.writes == []
    assert made.rig.plant.current == 0.0
    assert made.state.machine is Machine.FAULT


def test_a_module_that_restarts_while_the_link_is_down_is_noticed_at_once(
    chain: Chain, profiles: Profiles
) -> None:
    made = holding(chain, profiles["apple"])
    made.gripper.link_lost("the cable is out", made.instant)
    made.rig.write_current(0.0)
    made.pass_time(0.5)
    made.writes.clear()
    appeared(made, Cause.MODULE_RESTARTED, 0.1)
    made.run(1.0)
    assert made.writes == []
    assert made.state.machine is Machine.FAULT


def test_a_link_that_comes_back_to_the_same_current_is_no_fault(
    chain: Chain, profiles: Profiles
) -> None:
    made = holding(chain, profiles["apple"])
    made.gripper.link_lost("the cable is out", made.instant)
    made.pass_time(0.5)
    made.run(1.0)
    assert causes(made) == set()
    assert made.state.grip is Grip.HOLDING


def test_another_master_is_told_and_stops_nothing(
    chain: Chain, profiles: Profiles
) -> None:
    made = holding(chain, profiles["apple"])
    made.rig.write_current(0.0097)
    _, fault = appeared(made, Cause.OUTPUT_CHANGED, DETECTION[Cause.OUTPUT_CHANGED])
    assert not fault.latched
    assert made.state.machine is Machine.READY


@pytest.mark.parametrize("compensate", [False, True])
@pytest.mark.parametrize("name", OBJECTS)
def test_a_clean_hold_gives_no_alarm(
    chain: Chain, profiles: Profiles, name: str, compensate: bool
) -> None:
    profile = replace(profiles[name], compensate=compensate)
    made = holding(chain, profile, seed=2)
    made.run(30.0)
    assert faults(made) == []


@pytest.mark.parametrize("seed", [1, 2])
def test_clean_work_gives_no_alarm(chain: Chain, profiles: Profiles, seed: int) -> None:
    made = stage(chain, seed)
    for name, mode in (
        ("apple", Mode.FORCE),
        ("grape", Mode.CURRENT),
        ("raw_egg", Mode.FORCE),
    ):
        _work(made, profiles[name], mode)
    made.complete(ordered(profiles["apple"], Mode.FORCE))
    made.run(1.0)
    assert made.state.grip is Grip.NO_PART
    assert faults(made) == []


def _work(made: Stage, profile: Profile, mode: Mode) -> None:
    made.rig.plant.place(real(profile))
    assert made.complete(ordered(profile, mode)).status is Status.SUCCEEDED
    made.run(0.7)
    made.complete(Adjust(force=1.2 * profile.force))
    made.run(0.3)
    made.stop()
    made.run(0.7)
    assert made.complete(None).status is Status.SUCCEEDED
    made.run(0.2)
    made.rig.plant.remove()


def test_a_pressure_sensor_that_stops_too_soon_to_be_known_is_told_by_the_jaws(
    chain: Chain, profiles: Profiles
) -> None:
    made = stage(chain, 1)
    made.rig.plant.place(real(profiles["apple"]))
    made.complete(ordered(profiles["apple"], Mode.CURRENT))
    # With both of them silent only the pressure and the opening are left.
    silent = frozenset({Channel.GRIP})
    made.rig.plant.faults = BenchFaults(
        broken=silent, frozen=frozenset({Channel.PRESSURE})
    )
    made.complete(None)
    assert Cause.VALVE_NOT_FOLLOWING not in causes(made)
    assert (Cause.SENSOR_FAILED, "pressure") in {
        (fault.cause, fault.subject) for fault in faults(made)
    }


def test_jaws_that_meet_each_other_are_not_blocked(chain: Chain) -> None:
    made = stage(chain, 1)
    made.rig.write_current(0.018)
    made.run(3.0)
    assert made.rig.plant.opening == 0.0
    assert Cause.JAW_BLOCKED not in causes(made)


def test_a_model_that_takes_over_from_the_sensor_is_no_drift(
    chain: Chain, profiles: Profiles
) -> None:
    wrong = chain.varied("muscle.diameter", 0.0005)
    made = stage(chain, 1)
    made.gripper.use(wrong)
    made.rig.plant.place(real(profiles["apple"]))
    made.complete(ordered(profiles["apple"], Mode.CURRENT))
    made.run(4.0)
    before = made.state.measured
    made.rig.plant.faults = BenchFaults(broken=frozenset({Channel.GRIP}))
    made.run(6.0)
    after = made.state.measured
    assert before is not None
    assert after is not None
    assert (after.grip.value or 0.0) > 1.1 * (before.grip.value or 0.0)
    assert causes(made) == {Cause.SENSOR_FAILED}
