"""The way out of a fault, as a person types it."""

import json
import os
import signal
from collections.abc import Iterator
from subprocess import CompletedProcess

import httpx
import pytest

from tests.daemon import PATIENCE, Daemon, children, gripperd, running_daemon, until


@pytest.fixture(scope="module")
def daemon(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Daemon]:
    with running_daemon(tmp_path_factory.mktemp("daemon")) as daemon:
        yield daemon


def said(daemon: Daemon, *arguments: str) -> CompletedProcess[str]:
    return gripperd(*arguments, GRIPPERD_URL=daemon.url)


def refuses(daemon: Daemon, status: int, why: str, *arguments: str) -> None:
    refused = said(daemon, *arguments)
    assert refused.returncode == status
    assert why in refused.stderr


def outlives_control(daemon: Daemon, fault: dict[str, str]) -> None:
    """A new life of control does not forget what nobody has seen."""
    first = children(daemon.process)["control"]
    os.kill(first, signal.SIGKILL)
    until(lambda: children(daemon.process).get("control", first) != first)
    until(lambda: said(daemon, "status").stdout.startswith("g0: fault, holding"))
    assert fault["id"][:8] in said(daemon, "status").stdout
    history = f"{daemon.url}/v1/history?kind=adoption"
    told = f"adopted a latched fault: {fault['cause']}: {fault['message']}"
    until(lambda: told in httpx.get(history, timeout=PATIENCE).text)


def test_what_is_well_has_nothing_to_tell(daemon: Daemon) -> None:
    assert said(daemon, "faults").stdout == "no faults\n"
    assert said(daemon, "acknowledge", "all").stdout == "nothing to acknowledge\n"
    refuses(daemon, 1, "reset is not possible while the gripper is ready", "reset")


def test_a_fault_is_seen_acknowledged_mended_and_reset(daemon: Daemon) -> None:
    with httpx.Client(base_url=f"{daemon.url}/v1", timeout=PATIENCE) as http:
        goes_through_a_fault(daemon, http)


def goes_through_a_fault(daemon: Daemon, http: httpx.Client) -> None:
    http.put("/bench/object", json={"profile": "apple"}).raise_for_status()
    assert said(daemon, "grasp", "apple").returncode == 0
    broken = {"valve_offset_kPa": 60}
    http.put("/bench/faults", json=broken).raise_for_status()
    until(lambda: http.get("/grippers/g0").json()["machine"] == "fault")

    status = said(daemon, "status").stdout
    assert status.startswith("g0: fault, holding apple\n")
    assert "valve_not_following, latched, since 20" in status
    assert "to do: acknowledge, mend, reset, enable" in status
    listed = json.loads(said(daemon, "faults", "--active", "--json").stdout)["faults"]
    (fault,) = (each for each in listed if each["latched"])
    refuses(daemon, 1, "not acknowledged yet", "reset")
    outlives_control(daemon, fault)
    refuses(daemon, 1, f"hint: gripperd acknowledge {fault['id'][:8]}\n", "release")
    refuses(daemon, 1, "hint: gripperd reset\n  hint: gripperd enable\n", "release")
    refuses(daemon, 2, "0 faults begin with 'xyz'; there is", "acknowledge", "xyz")
    seen = said(daemon, "acknowledge", fault["id"][:8], "--by", "Ada")
    assert "acknowledged by Ada" in seen.stdout
    assert "to do: mend, reset, enable" in seen.stdout
    refuses(daemon, 1, "still so", "reset")

    http.delete("/bench/faults").raise_for_status()
    until(lambda: "to do: reset, enable" in said(daemon, "faults", "--active").stdout)
    assert ", gone since 20" in said(daemon, "status").stdout
    current = http.get("/bench").json()["current_mA"]
    assert said(daemon, "reset").stdout == "disabled, holding\n"
    assert json.loads(said(daemon, "enable", "--json").stdout)["machine"] == "ready"
    assert http.get("/bench").json()["current_mA"] == current
    assert "to do: reset" not in said(daemon, "faults").stdout
