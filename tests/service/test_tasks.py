"""What else can be done with what is held, through every layer down to the plant."""

from typing import Any

import pytest

from .conftest import Daemon
from .test_bad_input import COMMANDS, is_problem

LONG = {"prefer": "wait=60"}


def done(daemon: Daemon, **body: object) -> dict[str, Any]:
    answer = daemon.http.post(COMMANDS, json=body, headers=LONG)
    assert answer.status_code == 201, answer.text
    document: dict[str, Any] = answer.json()
    return document


@pytest.fixture
def holding(daemon: Daemon) -> Daemon:
    """An egg is held as its profile says, with 12 N."""
    daemon.http.put("/v1/bench/object", json={"profile": "raw_egg"})
    assert done(daemon, type="grasp", profile="raw_egg")["status"] == "succeeded"
    return daemon


def test_what_is_held_is_held_harder(holding: Daemon) -> None:
    command = done(holding, type="adjust", force_N=18)
    assert command["status"] == "succeeded"
    assert command["type"] == "adjust"
    assert command["params"] == {"deadline_s": 15, "force_N": 18}
    assert command["result"]["outcome"] == "held"
    assert command["result"]["force_N"] == pytest.approx(18, abs=0.7)
    assert holding.http.get("/v1/bench").json()["force_N"] == pytest.approx(18, abs=0.7)


def test_a_held_object_says_how_it_is_kept_and_for_how_long(holding: Daemon) -> None:
    state = holding.http.get("/v1/grippers/g0").json()
    assert state["regulation"]["wanted_N"] == 12.0
    assert state["regulation"]["level"] == "model"
    assert state["regulation"]["quality"] == "good"
    budget = state["hold_budget"]
    # The pressure may fall by an eighth, at 1/66 of it in a second.
    assert 5.0 < budget["air_s"] < 10.0
    assert budget["air_s"] == budget["power_s"]
    assert (budget["bus_s"], budget["limited_by"]) == (None, "leak")


def test_empty_jaws_have_no_budget(daemon: Daemon) -> None:
    state = daemon.http.get("/v1/grippers/g0").json()
    assert state["regulation"] is state["hold_budget"] is None
    assert state["zero_N"] == 0.0


def test_a_force_beyond_the_margins_moves_nothing(holding: Daemon) -> None:
    before = holding.http.get("/v1/bench").json()["current_mA"]
    answer = holding.http.post(COMMANDS, json={"type": "adjust", "force_N": 30})
    found = is_problem(answer, 422, "infeasible")
    assert "raw_egg is damaged at 35 N" in found["detail"]
    assert holding.http.get("/v1/bench").json()["current_mA"] == before


def test_empty_jaws_are_moved(daemon: Daemon) -> None:
    command = done(daemon, type="move", params={"opening_mm": 50})
    assert command["status"] == "succeeded"
    assert command["params"]["opening_mm"] == 50
    assert command["result"]["opening_mm"] == pytest.approx(50, abs=2)
    assert command["result"]["error_mm"] == pytest.approx(0, abs=2)


@pytest.mark.parametrize(
    ("body", "pointer"),
    [
        ({"type": "move"}, "/opening_mm"),
        ({"type": "move", "params": {}}, "/params/opening_mm"),
        ({"type": "move", "opening_mm": -1}, "/opening_mm"),
        ({"type": "hold"}, "/profile"),
        ({"type": "hold", "profile": "moon"}, "/profile"),
        ({"type": "adjust", "current_mA": 21}, "/current_mA"),
        ({"type": "vent", "force_N": 1}, "/force_N"),
    ],
)
def test_a_task_that_says_too_little_or_too_much_is_refused(
    daemon: Daemon, body: dict[str, object], pointer: str
) -> None:
    found = is_problem(daemon.http.post(COMMANDS, json=body), 422, "invalid")
    assert found["errors"][0]["pointer"] == pointer


def test_a_force_and_a_current_exclude_each_other(holding: Daemon) -> None:
    body = {"type": "adjust", "force_N": 12, "current_mA": 10}
    found = is_problem(holding.http.post(COMMANDS, json=body), 422, "invalid")
    assert "not both" in found["detail"]


def test_what_is_held_under_a_profile_is_not_taken_over(holding: Daemon) -> None:
    answer = holding.http.post(COMMANDS, json={"type": "hold", "profile": "apple"})
    is_problem(answer, 409, "object-held")


def test_a_gripper_is_tested_and_tared_while_it_is_empty(daemon: Daemon) -> None:
    done(daemon, type="release")
    tested = done(daemon, type="self_test")
    assert tested["status"] == "succeeded", tested["error"]
    assert abs(tested["result"]["valve_error_kPa"]) < 1.0
    tared = done(daemon, type="tare")
    assert tared["status"] == "succeeded", tared["error"]
    assert abs(tared["result"]["zero_N"]) < 0.05
    zero = daemon.http.get("/v1/grippers/g0").json()["zero_N"]
    assert zero == tared["result"]["zero_N"]


def test_venting_lets_go(holding: Daemon) -> None:
    assert done(holding, type="vent")["status"] == "succeeded"
    assert holding.http.get("/v1/grippers/g0").json()["grip"] == "released"
    assert holding.http.get("/v1/bench").json()["force_N"] == 0.0


def test_every_command_has_an_example(daemon: Daemon) -> None:
    schema = daemon.http.get("/openapi.json").json()
    body = schema["paths"]["/v1/grippers/{gripper}/commands"]["post"]["requestBody"]
    content = body["content"]["application/json"]
    kinds = set(content["schema"]["discriminator"]["mapping"])
    assert set(content["examples"]) == kinds
    assert kinds == {
        "grasp", "release", "adjust", "hold", "move", "vent", "tare", "self_test",
    }  # fmt: skip
