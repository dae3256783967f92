"""Commands from acceptance to outcome, through every layer down to the plant."""

from typing import Any

import httpx
import pytest

from .conftest import Daemon
from .test_bad_input import COMMANDS, JSON, is_problem

EGG = {"type": "grasp", "profile": "raw_egg"}
LONG = {"prefer": "wait=60"}


def test_an_egg_is_held_as_its_profile_says(daemon: Daemon) -> None:
    daemon.http.put("/v1/bench/object", json={"profile": "raw_egg"})
    answer = daemon.http.post(COMMANDS, json=EGG, headers=LONG)
    command = answer.json()
    assert answer.status_code == 201
    assert answer.headers["preference-applied"] == "wait=60"
    assert daemon.http.get(answer.headers["location"]).json() == command
    assert command["status"] == "succeeded"
    assert command["params"]["mode"] == "force"
    result = command["result"]
    assert result["outcome"] == "held"
    # The profile asks for 12 N on an egg of 41 mm that cracks at 35 N.
    assert result["force_N"] == pytest.approx(12.0, abs=1.2)
    assert result["size_mm"] == pytest.approx(41.0, abs=0.5)
    assert result["crush_margin"] == pytest.approx(35 / result["force_N"], rel=1e-4)
    truth = daemon.http.get("/v1/bench").json()
    assert truth["object"]["cracked"] is False
    assert truth["force_N"] == pytest.approx(result["force_N"], abs=1.2)

    state = daemon.http.get("/v1/grippers/g0").json()
    assert (state["grip"], state["holding"]) == ("holding", "raw_egg")
    again = daemon.http.post(COMMANDS, json=EGG)
    found = is_problem(again, 409, "object-held")
    assert "release first" in found["hints"]

    over = daemon.http.delete(answer.headers["location"])
    is_problem(over, 409, "already-final")


def test_a_force_on_a_size_needs_no_profile(daemon: Daemon) -> None:
    daemon.http.put("/v1/bench/object", json={"profile": "peach"})
    order = {"type": "grasp", "params": {"force_N": 12, "diameter_mm": 58}}
    command = daemon.http.post(COMMANDS, json=order, headers=LONG).json()
    assert command["result"]["outcome"] == "held"
    assert command["result"]["force_N"] == pytest.approx(12.0, abs=1.2)
    assert command["result"]["profile_version"] is None
    assumed = command["params"]["assumed"]
    assert assumed["limits"]["damage_N"] == 18.0
    # A ball of water, 58 mm across.
    assert assumed["mass_g"] == pytest.approx(102.16, abs=0.01)


def test_the_papers_current_is_accepted_in_both_shapes(daemon: Daemon) -> None:
    flat = {"type": "grasp", "profile": "raw_egg", "current_mA": 10.7}
    nested = {
        "type": "grasp",
        "params": {"profile": "raw_egg", "mode": "current", "current_mA": 10.7},
    }
    for body in (flat, nested):
        params = daemon.http.post(COMMANDS, json=body).json()["params"]
        assert (params["mode"], params["current_mA"]) == ("current", 10.7)


def test_a_request_that_is_sent_again_is_done_once(daemon: Daemon) -> None:
    sent = [
        b'{"type": "grasp", "profile": "raw_egg", "current_mA": 10.7}',
        b'{ "current_mA":10.7, "profile":"raw_egg", "type":"grasp" }',
    ]
    headers = JSON | {"idempotency-key": "sent-again"}
    first, second = (
        daemon.http.post(COMMANDS, content=body, headers=headers) for body in sent
    )
    assert (first.status_code, second.status_code) == (201, 200)
    assert second.json()["id"] == first.json()["id"]
    assert second.headers["idempotency-replayed"] == "true"
    assert "idempotency-replayed" not in first.headers


def test_a_request_stays_the_same_when_its_profile_is_changed(daemon: Daemon) -> None:
    where = "/v1/profiles/duck_egg"
    egg = daemon.http.get("/v1/profiles/raw_egg").json() | {"name": "duck_egg"}
    daemon.http.put(where, json=egg).raise_for_status()
    asked, key = EGG | {"profile": "duck_egg"}, {"idempotency-key": "changed-profile"}
    first = daemon.http.post(COMMANDS, json=asked, headers=key)
    changed = daemon.http.put(
        where, json=egg | {"mass_g": 60}, headers={"if-match": "*"}
    )
    changed.raise_for_status()
    second = daemon.http.post(COMMANDS, json=asked, headers=key)
    daemon.http.delete(where, headers={"if-match": "*"})
    assert (second.status_code, second.json()["id"]) == (200, first.json()["id"])


def test_a_key_without_a_request_is_no_defect(daemon: Daemon) -> None:
    answer = daemon.http.post(COMMANDS, headers={"idempotency-key": "nothing"})
    is_problem(answer, 422, "invalid")


def test_a_release_takes_no_profile(daemon: Daemon) -> None:
    body = {"type": "release", "profile": "raw_egg"}
    found = is_problem(daemon.http.post(COMMANDS, json=body), 422, "invalid")
    assert found["detail"] == "profile: does not go with a release"


def test_a_key_cannot_stand_for_two_requests(daemon: Daemon) -> None:
    key = {"idempotency-key": "two-requests"}
    daemon.http.post(COMMANDS, json=EGG, headers=key)
    other = EGG | {"deadline_s": 14}
    answer = daemon.http.post(COMMANDS, json=other, headers=key)
    is_problem(answer, 422, "idempotency-mismatch")


def test_an_empty_key_is_refused(daemon: Daemon) -> None:
    answer = daemon.http.post(COMMANDS, json=EGG, headers={"idempotency-key": ""})
    found = is_problem(answer, 422, "invalid")
    assert found["errors"][0]["header"] == "idempotency-key"


def test_a_running_command_can_be_cancelled(daemon: Daemon) -> None:
    where = daemon.http.post(COMMANDS, json=EGG).headers["location"]
    daemon.until(where, lambda command: command["status"] == "running")
    cancelled = daemon.http.delete(where)
    assert cancelled.status_code == 202
    assert cancelled.json()["status"] == "cancelled"
    assert daemon.http.get(where).json()["error"]["category"] == "cancelled"


def test_a_wait_that_ends_first_gives_the_command_as_it_stands(daemon: Daemon) -> None:
    answer = daemon.http.post(f"{COMMANDS}?wait_s=0.05", json=EGG)
    assert answer.status_code == 201
    assert answer.json()["status"] in {"queued", "running"}
    assert "preference-applied" not in answer.headers


def test_a_wait_is_capped_and_says_so(daemon: Daemon) -> None:
    body: dict[str, Any] = {"type": "release"}
    answer = daemon.http.post(COMMANDS, json=body, headers={"prefer": "wait=3600"})
    assert answer.headers["preference-applied"] == "wait=60"
    assert answer.json()["status"] == "succeeded"


def test_the_list_has_the_newest_first(daemon: Daemon) -> None:
    ids = [
        daemon.http.post(f"{COMMANDS}?wait_s=60", json={"type": "release"}).json()["id"]
        for _ in range(3)
    ]
    listed = daemon.http.get(f"{COMMANDS}?limit=2").json()["commands"]
    assert [command["id"] for command in listed] == ids[:0:-1]


def test_more_commands_than_can_wait_are_refused(daemon: Daemon) -> None:
    daemon.http.post(COMMANDS, json=EGG)
    while (answer := daemon.http.post(COMMANDS, json=EGG)).status_code == 201:
        pass
    is_problem(answer, 429, "queue-full")
    assert answer.headers["retry-after"] == "1"


def test_a_disabled_gripper_takes_no_commands(daemon: Daemon) -> None:
    assert daemon.http.post("/v1/grippers/g0/disable").json()["machine"] == "disabled"
    found = is_problem(daemon.http.post(COMMANDS, json=EGG), 409, "wrong-state")
    assert found["retryable"] is True


def test_a_command_for_nobody_is_a_503(lonely: httpx.Client) -> None:
    answer = lonely.post(COMMANDS, json=EGG)
    found = is_problem(answer, 503, "link-lost")
    assert answer.headers["retry-after"] == "1"
    assert "the control process is not running" in found["detail"]
    assert any("Idempotency-Key" in hint for hint in found["hints"])


def test_an_infeasible_grasp_needs_no_control_to_be_refused(
    lonely: httpx.Client,
) -> None:
    is_problem(lonely.post(COMMANDS, json=EGG | {"force_N": 30}), 422, "infeasible")
