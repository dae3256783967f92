"""Faults: seen, acknowledged, reset."""

from typing import Any

from .conftest import Daemon, recover
from .test_bad_input import COMMANDS, is_problem
from .test_metrics import figures

GRIPPER = "/v1/grippers/g0"
FAULTS = f"{GRIPPER}/faults"


def held(daemon: Daemon) -> None:
    daemon.http.put("/v1/bench/object", json={"profile": "apple"}).raise_for_status()
    grasp = {"type": "grasp", "profile": "apple"}
    prefer = {"Prefer": "wait=60"}
    done = daemon.http.post(COMMANDS, json=grasp, headers=prefer)
    assert done.json()["status"] == "succeeded"


def broken(daemon: Daemon, **faults: object) -> dict[str, Any]:
    """The newest fault, once the gripper is in fault."""
    daemon.http.put("/v1/bench/faults", json=faults).raise_for_status()
    daemon.until(GRIPPER, lambda state: state["machine"] == "fault")
    fault: dict[str, Any] = daemon.http.get(FAULTS).json()["faults"][0]
    return fault


def test_the_way_out_of_a_fault(daemon: Daemon) -> None:
    held(daemon)
    fault = broken(daemon, valve_offset_kPa=60)
    assert (fault["cause"], fault["latched"], fault["active"]) == (
        "valve_not_following",
        True,
        True,
    )
    assert "mA ask for" in fault["message"]
    state = daemon.http.get(GRIPPER).json()
    assert (state["grip"], "reset" in state["available_transitions"]) == (
        "holding",
        True,
    )
    (shown,) = (each for each in state["faults"] if each["latched"])
    assert shown == fault
    assert shown["way_out"] == ["acknowledge", "mend", "reset", "enable"]
    refused = daemon.http.post(COMMANDS, json={"type": "release"})
    found = is_problem(refused, 409, "wrong-state")
    assert f"faults/{fault['id']}/acknowledge" in str(found["hints"])

    is_problem(daemon.http.post(f"{GRIPPER}/reset"), 409, "not-acknowledged")
    path = f"{FAULTS}/{fault['id']}/acknowledge"
    seen = daemon.http.post(path, json={"by": "Ada"}).json()
    assert seen["acknowledged_by"] == "Ada"
    assert seen["acknowledged_at"]
    assert seen["way_out"] == ["mend", "reset", "enable"]
    is_problem(daemon.http.post(f"{GRIPPER}/reset"), 409, "cause-present")

    daemon.http.delete("/v1/bench/faults")
    daemon.until(FAULTS, lambda found: "cleared_at" in found["faults"][0])
    current = daemon.http.get("/v1/bench").json()["current_mA"]
    assert daemon.http.post(f"{GRIPPER}/reset").json()["machine"] == "disabled"
    assert daemon.http.get("/v1/bench").json()["current_mA"] == current
    assert daemon.http.post(f"{GRIPPER}/enable").json()["machine"] == "ready"
    is_over(daemon, fault)


def is_over(daemon: Daemon, fault: dict[str, Any]) -> None:
    (past,) = (
        each
        for each in daemon.http.get(FAULTS).json()["faults"]
        if each["id"] == fault["id"]
    )
    assert (past["active"], bool(past["reset_at"])) == (False, True)
    assert past["way_out"] == []
    left = daemon.http.get(GRIPPER).json()["faults"]
    assert fault["id"] not in {each["id"] for each in left}
    active = daemon.http.get(FAULTS, params={"active": True}).json()["faults"]
    assert fault["id"] not in {each["id"] for each in active}


def test_a_lost_part_is_told_and_stops_nothing(daemon: Daemon) -> None:
    held(daemon)
    daemon.http.put("/v1/bench/faults", json={"pad_friction": 0}).raise_for_status()
    daemon.until(GRIPPER, lambda state: state["grip"] == "part_lost")
    assert daemon.http.get(GRIPPER).json()["machine"] == "ready"
    found = daemon.until(
        FAULTS,
        lambda found: "part_lost" in {each["cause"] for each in found["faults"]},
    )
    lost = next(each for each in found["faults"] if each["cause"] == "part_lost")
    assert lost["message"].startswith("apple is gone from the jaws")
    assert (lost["latched"], lost["reaction"]) == (False, "hold")
    assert lost["way_out"] == ["command"]


def test_who_watches_the_daemon_sees_a_fault(daemon: Daemon) -> None:
    held(daemon)
    before = figures(daemon.http)
    raised = ("gripperd_faults_total", "valve_not_following g0")
    active = ("gripperd_faults_active", "valve_not_following g0")
    assert before[active] == 0
    fault = broken(daemon, valve_offset_kPa=60)
    found = is_problem(daemon.http.get("/v1/health/ready"), 503, "not-ready")
    assert found["detail"] == f"g0 is fault: {fault['message']}"
    after = figures(daemon.http)
    assert (after[active], after[raised]) == (1, before[raised] + 1)
    daemon.http.delete("/v1/bench/faults")
    recover(daemon)
    assert daemon.http.get("/v1/health/ready").status_code == 200
    later = figures(daemon.http)
    assert (later[active], later[raised]) == (0, before[raised] + 1)


def test_who_acknowledges_has_a_name(daemon: Daemon) -> None:
    for body in ({}, {"by": ""}, {"by": 7}, {"by": "Ada", "at": "now"}):
        asked = daemon.http.post(f"{FAULTS}/f/acknowledge", json=body)
        is_problem(asked, 422, "invalid")
    asked = daemon.http.post(f"{FAULTS}/f/acknowledge", json={"by": "Ada"})
    is_problem(asked, 404, "not-found")


def test_a_reset_without_a_fault_is_refused(daemon: Daemon) -> None:
    found = is_problem(daemon.http.post(f"{GRIPPER}/reset"), 409, "wrong-state")
    assert "reset is not possible" in found["detail"]
