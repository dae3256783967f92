"""States, stop, enable and disable."""

import socket
from dataclasses import replace
from pathlib import Path
from typing import Any

import httpx
import pytest

from gripperd.config import Settings
from tests.daemon import PATIENCE

from .conftest import Daemon, running, unplugged
from .test_bad_input import COMMANDS, is_problem

STATE = "/v1/grippers/g0"


def test_a_state_has_every_channel_with_its_credentials(daemon: Daemon) -> None:
    def fresh(state: dict[str, Any]) -> bool:
        return all(0 <= each["age_ms"] < 500 for each in state["measured"].values())

    state = daemon.until(STATE, fresh)
    assert set(state["measured"]) == {
        "current_mA",
        "pressure_kPa",
        "opening_mm",
        "force_N",
    }
    for measured in state["measured"].values():
        assert measured["quality"] == "good"
    # Open jaws of the reference rig are 85 mm apart; the sensor spans 100 mm.
    assert state["measured"]["opening_mm"]["value"] == pytest.approx(85, abs=0.5)
    assert (state["machine"], state["grip"]) == ("ready", "released")
    assert "start" in state["available_transitions"]
    assert (state["fail_mode"], state["model"]) == ("freeze", "reference")


def test_the_list_shows_the_same_grippers(daemon: Daemon) -> None:
    (only,) = daemon.http.get("/v1/grippers").json()["grippers"]
    assert only["name"] == "g0"
    assert set(only) == set(daemon.http.get(STATE).json())


def test_a_cut_wire_is_bad_with_its_cause(daemon: Daemon) -> None:
    daemon.http.put("/v1/bench/faults", json={"broken": ["opening"]})
    state = daemon.until(
        STATE, lambda state: state["measured"]["opening_mm"]["quality"] == "bad"
    )
    opening = state["measured"]["opening_mm"]
    assert opening["value"] is None
    assert opening["cause"]
    assert state["prediction"] is None


def test_stop_freezes_and_keeps_the_pressure(daemon: Daemon) -> None:
    order = {"type": "grasp", "profile": "apple"}
    where = daemon.http.post(COMMANDS, json=order).headers["location"]
    daemon.until(STATE, lambda state: (state["current_mA"] or 0) > 6)
    answer = daemon.http.post(f"{STATE}/stop")
    assert answer.status_code == 200
    assert answer.json()["machine"] == "stopping"
    pressure = answer.json()["measured"]["pressure_kPa"]["value"]
    assert pressure > 0
    command = daemon.http.get(where).json()
    assert (command["status"], command["error"]["code"]) == ("cancelled", "stopped")
    rested = daemon.until(STATE, lambda state: state["machine"] == "ready")
    assert rested["current_mA"] > 4
    assert rested["measured"]["pressure_kPa"]["value"] > 0.8 * pressure


def test_what_was_changed_is_seen_at_once(daemon: Daemon) -> None:
    for _ in range(20):
        daemon.http.get(STATE)
        daemon.http.post(f"{STATE}/disable")
        assert daemon.http.get(STATE).json()["machine"] == "disabled"
        daemon.http.post(f"{STATE}/enable")
        assert daemon.http.get(STATE).json()["machine"] == "ready"


def test_enabling_twice_is_refused_with_what_is_possible(daemon: Daemon) -> None:
    found = is_problem(daemon.http.post(f"{STATE}/enable"), 409, "wrong-state")
    assert "disable" in found["hints"][0]


def test_a_gripper_without_a_link_says_so(settings: Settings, tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port: int = taken.getsockname()[1]
    apart = replace(settings, runtime_dir=tmp_path)
    with (
        running(lambda report: unplugged(apart, port, report)) as url,
        httpx.Client(base_url=url, timeout=PATIENCE) as http,
    ):
        state = http.get(STATE).json()
        assert state["machine"] == "offline"
        assert state["link"] != "up"
        assert state["current_mA"] is None
        for measured in state["measured"].values():
            assert (measured["value"], measured["quality"]) == (None, "stale")
            assert "never measured" in measured["cause"]
        found = is_problem(http.get("/v1/health/ready"), 503, "not-ready")
        assert "g0 is offline" in found["detail"]
        for path, body in (
            (COMMANDS, {"type": "release"}),
            (f"{STATE}/stop", None),
            (f"{STATE}/enable", None),
        ):
            found = is_problem(http.post(path, json=body), 503, "link-down")
            assert found["detail"] == f"g0 is offline: {http.get(STATE).json()['link']}"
            assert found["retryable"] is True
