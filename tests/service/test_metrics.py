import httpx
import pytest
from prometheus_client.parser import text_string_to_metric_families

from .conftest import Daemon
from .test_bad_input import COMMANDS


def figures(http: httpx.Client) -> dict[tuple[str, str], float]:
    """Every figure, by its name and the values of its labels."""
    answer = http.get("/metrics")
    assert answer.status_code == 200
    assert answer.headers["content-type"].startswith("text/plain; version=0.0.4")
    return {
        (sample.name, " ".join(sample.labels.values())): sample.value
        for family in text_string_to_metric_families(answer.text)
        for sample in family.samples
    }


def test_a_held_egg_has_its_figures(daemon: Daemon) -> None:
    before = figures(daemon.http).get(("gripperd_commands_total", "g0 succeeded grasp"))
    daemon.http.put("/v1/bench/object", json={"profile": "raw_egg"})
    order = {"type": "grasp", "profile": "raw_egg"}
    daemon.http.post(f"{COMMANDS}?wait_s=60", json=order)
    found = figures(daemon.http)
    assert found["gripperd_info", "1.2.3"] == 1
    assert found["gripperd_control_up", ""] == 1
    assert found["gripperd_machine", "g0 ready"] == 1
    assert found["gripperd_machine", "g0 fault"] == 0
    assert found["gripperd_grip", "g0 holding"] == 1
    assert found["gripperd_grip_force_newtons", "g0 good"] == pytest.approx(12, abs=1)
    assert 0.008 < found["gripperd_current_amperes", "g0"] < 0.012
    assert 5 < found["gripperd_hold_budget_seconds", "g0 air"] < 10
    assert found["gripperd_hold_budget_seconds", "g0 bus"] == float("inf")
    after = found["gripperd_commands_total", "g0 succeeded grasp"]
    assert after == (before or 0) + 1
    assert found["gripperd_lateness_seconds_count", "g0"] > 0


def test_without_control_only_that_is_told(lonely: httpx.Client) -> None:
    found = figures(lonely)
    assert found["gripperd_control_up", ""] == 0
    assert not any(name.startswith("gripperd_machine") for name, _ in found)
