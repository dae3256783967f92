"""Leases, as two clients see them."""

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from datetime import datetime

import httpx
import pytest

from .conftest import Daemon
from .test_bad_input import COMMANDS, is_problem

LEASE = "/v1/grippers/g0/lease"
RELEASE = {"type": "release"}


def take(
    daemon: Daemon, owner: str, ttl: float = 30.0, token: str = ""
) -> httpx.Response:
    headers = {"lease-token": token} if token else {}
    return daemon.http.put(LEASE, json={"owner": owner, "ttl_s": ttl}, headers=headers)


@pytest.fixture
def token(daemon: Daemon) -> Iterator[str]:
    """Ann has the lease."""
    token: str = take(daemon, "Ann").json()["token"]
    yield token
    daemon.http.delete(LEASE, headers={"lease-token": token})


def test_only_the_owner_gives_commands(daemon: Daemon, token: str) -> None:
    for headers in ({}, {"lease-token": "guessed"}):
        answer = daemon.http.post(COMMANDS, json=RELEASE, headers=headers)
        found = is_problem(answer, 423, "leased")
        assert "Ann has the lease for another" in found["detail"]
    given = daemon.http.post(COMMANDS, json=RELEASE, headers={"lease-token": token})
    assert given.status_code == 201
    is_problem(daemon.http.delete(given.headers["location"]), 423, "leased")


def test_a_stop_needs_no_lease(daemon: Daemon, token: str) -> None:
    headers = {"lease-token": token}
    grasp = {"type": "grasp", "profile": "raw_egg"}
    given = daemon.http.post(COMMANDS, json=grasp, headers=headers)
    assert daemon.http.post("/v1/grippers/g0/stop").status_code == 200
    stopped = daemon.http.get(given.headers["location"]).json()
    assert stopped["error"]["code"] == "stopped"


@pytest.mark.parametrize(
    ("path", "body"),
    [("enable", None), ("reset", None), ("faults/f/acknowledge", {"by": "Bob"})],
)
def test_only_the_owner_leads_out_of_a_fault(
    daemon: Daemon, token: str, path: str, body: dict[str, str] | None
) -> None:
    place = f"/v1/grippers/g0/{path}"
    for headers in ({}, {"lease-token": "guessed"}):
        answer = daemon.http.post(place, json=body, headers=headers)
        found = is_problem(answer, 423, "leased")
        assert "Ann has the lease for another" in found["detail"]
    # Past the lease: there is no fault to acknowledge, and none to be reset from.
    reached = daemon.http.post(place, json=body, headers={"lease-token": token})
    assert reached.status_code == {"enable": 409, "reset": 409}.get(path, 404)


def test_a_disable_needs_no_lease(daemon: Daemon, token: str) -> None:
    disabled = daemon.http.post("/v1/grippers/g0/disable")
    assert (disabled.status_code, disabled.json()["machine"]) == (200, "disabled")
    headers = {"lease-token": token}
    enabled = daemon.http.post("/v1/grippers/g0/enable", headers=headers)
    assert enabled.json()["machine"] == "ready"


def test_everybody_sees_who_has_it_and_nobody_the_token(
    daemon: Daemon, token: str
) -> None:
    found = daemon.http.get(LEASE).json()
    assert (found["owner"], found["ttl_s"]) == ("Ann", 30.0)
    assert datetime.fromisoformat(found["expires_at"]).tzinfo is not None
    assert token not in daemon.http.get(LEASE).text


def test_its_owner_renews_it_and_gives_it_back(daemon: Daemon, token: str) -> None:
    is_problem(take(daemon, "Bob"), 423, "leased")
    before = daemon.http.get(LEASE).json()["expires_at"]
    renewed = take(daemon, "Ann", token=token)
    assert (renewed.status_code, renewed.json()["token"]) == (200, token)
    assert renewed.json()["expires_at"] > before
    is_problem(daemon.http.delete(LEASE), 423, "leased")
    daemon.http.delete(LEASE, headers={"lease-token": token}).raise_for_status()
    assert daemon.http.get(LEASE).json()["owner"] is None
    answer = daemon.http.post(COMMANDS, json=RELEASE, headers={"lease-token": token})
    is_problem(answer, 423, "lease-lost")


def test_at_its_end_what_moves_is_frozen_and_the_history_says_so(
    daemon: Daemon,
) -> None:
    def begin() -> httpx.Response:
        headers = {"lease-token": take(daemon, "Eve", ttl=0.5).json()["token"]}
        grasp = {"type": "grasp", "profile": "grape"}
        return daemon.http.post(COMMANDS, json=grasp, headers=headers)

    # On a slow machine the lease is over before anything moves.
    while (given := begin()).status_code == 423:
        pass
    place = given.headers["location"]
    found = daemon.until(place, lambda command: command["completed_at"] is not None)
    assert (found["status"], found["error"]["code"]) == ("cancelled", "lease-lost")
    events = daemon.until(
        "/v1/history?kind=lease&limit=2",
        lambda page: "ran out" in page["events"][0]["text"],
    )
    assert [event["text"] for event in reversed(events["events"])] == [
        "Eve took the lease for 0.5 s",
        "the lease of Eve ran out",
    ]


@pytest.mark.parametrize(
    "body",
    [
        {"owner": "", "ttl_s": 5},
        {"owner": "Ann", "ttl_s": 0.1},
        {"owner": "Ann", "ttl_s": 4000},
        {"owner": "Ann"},
    ],
)
def test_what_is_no_lease_is_refused(daemon: Daemon, body: dict[str, object]) -> None:
    is_problem(daemon.http.put(LEASE, json=body), 422, "invalid")


def test_of_two_who_race_for_it_one_gets_it(daemon: Daemon) -> None:
    with ThreadPoolExecutor(2) as pool:
        for _ in range(200):
            answers = list(pool.map(lambda owner: take(daemon, owner), ("Ann", "Bob")))
            assert sorted(answer.status_code for answer in answers) == [201, 423]
            (won,) = (each for each in answers if each.status_code == 201)
            headers = {"lease-token": won.json()["token"]}
            daemon.http.delete(LEASE, headers=headers).raise_for_status()
