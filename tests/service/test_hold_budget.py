"""How long a grip lasts is said whenever something is held."""

from collections.abc import Callable
from typing import Any

import pytest

from gripperd.config import Settings, load_model, shipped
from gripperd.control.snapshot import GripperState
from gripperd.control.states import Grip, Machine
from gripperd.service.hold_budget import hold_budget
from gripperd.signals import Measurement, Reading

from .conftest import Daemon
from .test_bad_input import COMMANDS

GRIPPER = "/v1/grippers/g0"
WAIT = {"Prefer": "wait=60"}
REFERENCE = load_model(shipped("models/reference.yaml")).chain()


def grasped(daemon: Daemon) -> None:
    grasp = {"type": "grasp", "profile": "apple"}
    daemon.http.post(COMMANDS, json=grasp, headers=WAIT).raise_for_status()


def stopped(daemon: Daemon) -> None:
    grasped(daemon)
    daemon.http.post(f"{GRIPPER}/stop").raise_for_status()


def stopped_on_the_way(daemon: Daemon) -> None:
    grasp = {"type": "grasp", "profile": "apple"}
    daemon.http.post(COMMANDS, json=grasp).raise_for_status()
    daemon.until("/v1/bench", lambda bench: bench["force_N"] > 10)
    daemon.http.post(f"{GRIPPER}/stop").raise_for_status()


def adjusted(daemon: Daemon) -> None:
    grasped(daemon)
    adjust = {"type": "adjust", "force_N": 20}
    done = daemon.http.post(COMMANDS, json=adjust, headers=WAIT)
    assert done.json()["status"] == "succeeded"


@pytest.mark.parametrize("hold", [grasped, stopped, stopped_on_the_way, adjusted])
def test_whatever_led_to_the_hold(
    daemon: Daemon, hold: Callable[[Daemon], None]
) -> None:
    daemon.http.put("/v1/bench/object", json={"profile": "apple"}).raise_for_status()
    hold(daemon)
    daemon.until(GRIPPER, lambda state: state["machine"] == "ready")
    state: dict[str, Any] = daemon.http.get(GRIPPER).json()
    assert (state["grip"], state["holding"]) == ("holding", "apple")
    budget = state["hold_budget"]
    # The worst leak takes 1/66 of the pressure per second.
    assert 1 < budget["air_s"] < 66
    assert (budget["assumed"], budget["limited_by"]) == (False, "leak")


def adopted(force: float, strongest: float) -> GripperState:
    measured = Measurement(
        time=0.0,
        current=Reading(10.7e-3),
        pressure=Reading(209e3),
        opening=Reading(65e-3),
        grip=Reading(force),
    )
    return GripperState(
        name="g0",
        machine=Machine.DISABLED,
        grip=Grip.HOLDING,
        available_transitions=(),
        adopted=True,
        current=10.7e-3,
        measured=measured,
        age=0.0,
        command=None,
        holding=None,
        link="up",
        model="reference",
        model_digest=REFERENCE.digest,
        strongest=strongest,
    )


def test_of_an_unknown_object_two_thirds_of_the_force_are_kept(
    settings: Settings,
) -> None:
    fresh = hold_budget(adopted(47.6, 47.6), settings.grippers["g0"])
    assert fresh is not None
    assert fresh.assumed
    assert fresh.air_s is not None
    assert 1 < fresh.air_s < 20
    weaker = hold_budget(adopted(40.0, 47.6), settings.grippers["g0"])
    assert weaker is not None
    assert weaker.air_s is not None
    assert weaker.air_s < fresh.air_s
    gone = hold_budget(adopted(31.0, 47.6), settings.grippers["g0"])
    assert gone is not None
    assert (gone.air_s, gone.power_s, gone.bus_s) == (0, 0, 0)
    just = hold_budget(adopted(32.5, 47.6), settings.grippers["g0"])
    assert just is not None
    assert just.air_s
