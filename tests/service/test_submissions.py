"""A command has one effect, however often and by however many it is asked for."""

from concurrent.futures import ThreadPoolExecutor

import httpx

from .conftest import Daemon
from .test_bad_input import COMMANDS

RELEASE = {"type": "release"}


def busy(daemon: Daemon) -> None:
    """Have something running, so that what is given now waits."""
    # What was cancelled after it had begun brings the jaws to rest first.
    daemon.until("/v1/grippers/g0", lambda s: s["machine"] in ("ready", "executing"))
    if daemon.http.get("/v1/grippers/g0").json()["machine"] == "ready":
        daemon.http.post(COMMANDS, json={"type": "grasp", "profile": "grape"})


def test_of_two_who_race_with_one_key_one_begins_it(daemon: Daemon) -> None:
    def send(key: str) -> httpx.Response:
        headers = {"idempotency-key": key}
        return daemon.http.post(COMMANDS, json=RELEASE, headers=headers)

    begun = set()
    with ThreadPoolExecutor(2) as pool:
        for number in range(200):
            busy(daemon)
            key = f"race {number}"
            first, second = pool.map(send, (key, key))
            assert {first.status_code, second.status_code} == {200, 201}
            assert first.json()["id"] == second.json()["id"]
            begun.add(first.json()["id"])
            daemon.http.delete(first.headers["location"])
            if number % 20 == 0:
                daemon.http.post("/v1/grippers/g0/stop")
                daemon.until("/v1/grippers/g0", lambda s: s["machine"] == "ready")
    assert len(begun) == 200


def test_a_refused_request_leaves_its_key_free(daemon: Daemon) -> None:
    headers = {"idempotency-key": "refused first"}
    daemon.http.post("/v1/grippers/g0/disable")
    refused = daemon.http.post(COMMANDS, json=RELEASE, headers=headers)
    assert refused.status_code == 409
    daemon.http.post("/v1/grippers/g0/enable")
    given = daemon.http.post(COMMANDS, json=RELEASE, headers=headers)
    assert given.status_code == 201


def test_every_command_is_over_before_its_deadline(daemon: Daemon) -> None:
    body = {"type": "grasp", "profile": "grape", "deadline_s": 0.3}
    given = daemon.http.post(COMMANDS, json=body)
    place = given.headers["location"]
    over = daemon.until(place, lambda command: command["completed_at"] is not None)
    assert over["error"]["code"] == "deadline"
