"""What is known of a command after the processes that dealt with it were killed."""

import os
import shutil
import signal
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from random import Random
from typing import Any

import httpx
import pytest

from tests.daemon import PATIENCE, Daemon, children, running_daemon, until

COMMANDS = "/v1/grippers/g0/commands"
EGG = {"type": "grasp", "profile": "raw_egg"}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the daemon keeps its files."""
    return tmp_path_factory.mktemp("survival")


@pytest.fixture(scope="module")
def daemon(folder: Path) -> Iterator[Daemon]:
    """All processes, one daemon for all tests here."""
    with running_daemon(folder) as daemon:
        yield daemon


@pytest.fixture
def http(daemon: Daemon) -> Iterator[httpx.Client]:
    """A client of the daemon, ready, with open jaws."""
    with httpx.Client(base_url=daemon.url, timeout=PATIENCE) as http:
        until(lambda: attached(http))
        http.delete("/v1/bench/faults")
        settle(http)
        yield http


def answer(http: httpx.Client, path: str) -> dict[str, Any] | None:
    """A document, None while there is none."""
    try:
        found = http.get(path)
    except httpx.TransportError:
        return None
    document: dict[str, Any] = found.json()
    return document if found.is_success else None


def attached(http: httpx.Client) -> bool:
    """Whether everything answers again, be it with a fault."""
    state = answer(http, "/v1/grippers/g0")
    return state is not None and state["machine"] not in {"offline", "attaching"}


def settle(http: httpx.Client) -> None:
    def is_ready() -> bool:
        state = answer(http, "/v1/grippers/g0")
        if state is not None and state["machine"] == "fault":
            mend(http)
        if state is not None and state["machine"] == "disabled":
            http.post("/v1/grippers/g0/enable")
        return state is not None and state["machine"] == "ready"

    until(is_ready)
    http.delete("/v1/bench/object")
    http.post(f"{COMMANDS}?wait_s=60", json={"type": "release"})
    until(is_ready)


def mend(http: httpx.Client) -> None:
    """Acknowledge every fault, and leave it behind."""
    faults = "/v1/grippers/g0/faults"
    for fault in http.get(faults).json()["faults"]:
        http.post(f"{faults}/{fault['id']}/acknowledge", json={"by": "test"})
    http.post("/v1/grippers/g0/reset")


def over(http: httpx.Client, place: str) -> dict[str, Any]:
    found: dict[str, Any] = {}

    def is_over() -> bool:
        nonlocal found
        found = answer(http, place) or {}
        return found.get("completed_at") is not None

    until(is_over)
    return found


def ends(http: httpx.Client, command: str) -> list[dict[str, Any]]:
    """What the history has of the end of a command."""
    kept = answer(http, f"/v1/history?command={command}&kind=command") or {"events": []}
    return [each for each in kept["events"] if each["command"]["completed_at"]]


def kill(daemon: Daemon, name: str) -> None:
    os.kill(children(daemon.process)[name], signal.SIGKILL)


def revived(daemon: Daemon, http: httpx.Client, name: str, dead: int) -> None:
    until(lambda: children(daemon.process).get(name, dead) != dead)
    until(lambda: attached(http))


@pytest.mark.parametrize("victim", ["service", "control", "bench"])
def test_whoever_is_killed_every_command_has_one_end_and_its_key_one_command(
    daemon: Daemon, http: httpx.Client, victim: str
) -> None:
    random = Random(f"survival {victim}")
    for number in range(2):
        http.put("/v1/bench/object", json={"profile": "raw_egg"})
        headers = {"idempotency-key": f"{victim} {number}"}
        given = http.post(COMMANDS, json=EGG, headers=headers)
        assert given.status_code == 201
        time.sleep(random.uniform(0.0, 0.6))
        dead = children(daemon.process)[victim]
        os.kill(dead, signal.SIGKILL)
        revived(daemon, http, victim, dead)
        found = over(http, given.headers["location"])
        assert found["id"] == given.json()["id"]
        again = http.post(COMMANDS, json=EGG, headers=headers)
        assert (again.status_code, again.json()["id"]) == (200, found["id"])
        if victim == "control":
            assert found["error"]["code"] == "control-restarted"
        # Who follows the journal may be a moment behind the command itself.
        until(partial(ends, http, found["id"]))
        settle(http)
        assert len(ends(http, found["id"])) == 1


def test_an_adoption_after_a_restart_is_in_the_history(
    daemon: Daemon, http: httpx.Client
) -> None:
    http.put("/v1/bench/object", json={"profile": "raw_egg"})
    held = http.post(f"{COMMANDS}?wait_s=60", json=EGG).json()
    assert held["status"] == "succeeded"
    dead = children(daemon.process)["control"]
    kill(daemon, "control")
    revived(daemon, http, "control", dead)
    state = http.get("/v1/grippers/g0").json()
    found = f"adopted {state['current_mA']:.2f} mA as found"

    def told() -> bool:
        page = answer(http, "/v1/history?kind=adoption&limit=1") or {"events": []}
        return any(each["text"] == found for each in page["events"])

    until(told)
    assert (state["grip"], state["adopted"]) == ("holding", True)


def test_without_its_disk_it_holds_stops_and_releases_and_says_so(
    daemon: Daemon, http: httpx.Client, folder: Path
) -> None:
    http.put("/v1/bench/object", json={"profile": "raw_egg"})
    http.post(f"{COMMANDS}?wait_s=60", json=EGG).raise_for_status()
    force = http.get("/v1/bench").json()["force_N"]
    dead = children(daemon.process)["service"]
    # A file where the folder was: nothing can be kept, whoever asks for it.
    shutil.move(folder / "state", folder / "away")
    (folder / "state").write_text("")
    kill(daemon, "service")
    revived(daemon, http, "service", dead)

    headers = {"idempotency-key": "without a disk"}
    refused = http.post(COMMANDS, json={"type": "release"}, headers=headers)
    assert (refused.status_code, refused.json()["code"]) == (503, "not-recorded")
    assert http.get("/v1/bench").json()["force_N"] == pytest.approx(force, rel=0.1)
    ready = http.get("/v1/health/ready").json()
    assert "history cannot be kept" in ready["degraded"]
    assert ready["degraded"] in http.get("/v1/info").json()["warnings"]
    released = http.post(f"{COMMANDS}?wait_s=60", json={"type": "release"})
    assert (released.status_code, released.json()["status"]) == (202, "succeeded")

    (folder / "state").unlink()
    shutil.move(folder / "away", folder / "state")
    name = released.json()["id"]

    def caught_up() -> bool:
        page = answer(http, f"/v1/history?command={name}")
        return page is not None and len(page["events"]) == 3

    until(caught_up)
    assert "degraded" not in http.get("/v1/health/ready").json()


def test_an_emergency_stop_holds_until_it_is_released_and_reset(
    http: httpx.Client,
) -> None:
    http.put("/v1/bench/object", json={"profile": "raw_egg"})
    http.post(f"{COMMANDS}?wait_s=60", json=EGG).raise_for_status()
    force = http.get("/v1/bench").json()["force_N"]
    http.put("/v1/bench/faults", json={"opened": ["estop"]})

    def machine() -> str:
        return str(http.get("/v1/grippers/g0").json()["machine"])

    until(lambda: machine() == "estopped")
    refused = http.post(COMMANDS, json={"type": "release"})
    assert refused.status_code == 409
    assert http.post("/v1/grippers/g0/reset").json()["code"] == "estopped"
    assert http.get("/v1/bench").json()["force_N"] == pytest.approx(force, rel=0.1)
    http.delete("/v1/bench/faults")
    until(lambda: http.post("/v1/grippers/g0/reset").is_success)
    assert machine() == "disabled"
    http.post("/v1/grippers/g0/enable").raise_for_status()
    assert http.get("/v1/bench").json()["force_N"] == pytest.approx(force, rel=0.1)


def test_without_the_enable_contact_no_motion_begins(http: httpx.Client) -> None:
    http.put("/v1/bench/faults", json={"opened": ["enable"]})

    def refused() -> bool:
        asked = http.post(COMMANDS, json={"type": "release"})
        return bool(asked.json().get("code") == "not-enabled")

    until(refused)
    current = http.get("/v1/bench").json()["current_mA"]
    assert http.post(COMMANDS, json=EGG).status_code == 409
    assert http.get("/v1/bench").json()["current_mA"] == current
