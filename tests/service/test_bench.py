"""The bench: objects, faults, and that there is none on hardware."""

import httpx
import pytest

from .conftest import Daemon
from .test_bad_input import is_problem

BENCH = "/v1/bench"


def test_a_profile_describes_an_object(daemon: Daemon) -> None:
    body = {"profile": "apple", "diameter_mm": 70}
    found = daemon.http.put(f"{BENCH}/object", json=body).json()["object"]
    assert found == {
        "diameter_mm": 70.0,
        "stiffness_N_per_mm": 40.0,
        "mass_g": 180.0,
        "friction": 0.5,
        "damage_force_N": 90.0,
        "state": "resting",
        "cracked": False,
    }
    assert daemon.http.get(BENCH).json()["object"] == found
    assert daemon.http.delete(f"{BENCH}/object").json()["object"] is None


def test_an_object_can_be_described_by_itself(daemon: Daemon) -> None:
    body = {
        "diameter_mm": 50,
        "stiffness_N_per_mm": 20,
        "mass_g": 100,
        "friction": 0.6,
        "damage_force_N": 40,
    }
    found = daemon.http.put(f"{BENCH}/object", json=body).json()["object"]
    assert {key: found[key] for key in body} == body


def test_faults_are_replaced_as_a_whole(daemon: Daemon) -> None:
    first = {"supply_kPa": 300, "leak_per_s": 0.5, "broken": ["grip"]}
    found = daemon.http.put(f"{BENCH}/faults", json=first).json()["faults"]
    assert (found["supply_kPa"], found["broken"]) == (300.0, ["grip"])
    second = {
        "valve_offset_kPa": -5,
        "shorted": ["grip"],
        "frozen": ["pressure", "opening"],
        "spiking": ["opening"],
    }
    found = daemon.http.put(f"{BENCH}/faults", json=second).json()["faults"]
    assert found == {
        "supply_kPa": None,
        "valve_offset_kPa": -5.0,
        "leak_per_s": 0.0,
        "valve_stuck": False,
        "jaw_friction_N": 0.0,
        "jaws_blocked": False,
        "pad_friction": 1.0,
        "pull_N": 0.0,
        "broken": [],
        "shorted": ["grip"],
        "frozen": ["opening", "pressure"],
        "spiking": ["opening"],
        "opened": [],
    }
    found = daemon.http.delete(f"{BENCH}/faults").json()["faults"]
    assert (found["valve_offset_kPa"], found["frozen"]) == (0.0, [])


def test_faults_of_the_wire_wait_for_requests_they_can_befall(daemon: Daemon) -> None:
    # Nobody asks unit 77, so that they can be read back at leisure.
    faults = [
        {"kind": "late", "delay_ms": 500, "unit": 77, "times": 2},
        {"kind": "exception", "code": 6, "unit": 77},
    ]
    told = daemon.http.put(f"{BENCH}/wire-faults", json={"faults": faults}).json()
    assert told["wire_faults"] == {
        "waiting": [
            {"kind": "late", "code": 4, "delay_ms": 500.0, "unit": 77, "times": 2},
            {
                "kind": "exception",
                "code": 6,
                "delay_ms": 1000.0,
                "unit": 77,
                "times": 1,
            },
        ],
        "chance": 0.0,
    }
    assert daemon.http.get(BENCH).json()["wire_faults"] == told["wire_faults"]
    mended = daemon.http.delete(f"{BENCH}/wire-faults").json()["wire_faults"]
    assert mended == {"waiting": [], "chance": 0.0}


def test_a_fault_of_the_wire_is_met_by_control(daemon: Daemon) -> None:
    lost = {"faults": [{"kind": "lost", "times": 3}]}
    daemon.http.put(f"{BENCH}/wire-faults", json=lost).raise_for_status()
    daemon.until(BENCH, lambda found: not found["wire_faults"]["waiting"])
    daemon.until("/v1/grippers/g0", lambda state: state["machine"] == "ready")


def test_the_line_of_the_bench_is_told(daemon: Daemon) -> None:
    found = daemon.http.get(BENCH).json()
    assert found["line"] == "modbus_tcp"
    assert found["modbus_tcp"] == found["address"]


@pytest.mark.parametrize(
    ("path", "body", "pointer", "says"),
    [
        ("object", {}, "/diameter_mm", "is missing"),
        ("object", {"profile": "aple"}, "/profile", 'did you mean "apple"'),
        ("object", {"profile": "apple", "diameter_mm": 86}, "/diameter_mm", "fit"),
        ("object", {"profile": "apple", "mass_g": 0}, "/mass_g", "not above 0 g"),
        ("faults", {"broken": ["force"]}, "/broken/0", "grip, opening, pressure"),
        ("faults", {"suply_kPa": 3}, "/suply_kPa", 'did you mean "supply_kPa"'),
        ("wire-faults", {"faults": [{"kind": "lat"}]}, "/faults/0/kind", "late"),
        ("wire-faults", {"chance": 2}, "/chance", "1"),
    ],
)
def test_what_the_bench_cannot_do_is_named(
    daemon: Daemon, path: str, body: dict[str, object], pointer: str, says: str
) -> None:
    found = is_problem(daemon.http.put(f"{BENCH}/{path}", json=body), 422, "invalid")
    assert [fault["pointer"] for fault in found["errors"]] == [pointer]
    assert says in found["detail"]


@pytest.mark.parametrize(
    ("method", "path"),
    [
        ("GET", BENCH),
        ("PUT", f"{BENCH}/faults"),
        ("DELETE", f"{BENCH}/faults"),
        ("DELETE", f"{BENCH}/object"),
        ("PUT", f"{BENCH}/wire-faults"),
        ("DELETE", f"{BENCH}/wire-faults"),
    ],
)
def test_there_is_no_bench_on_hardware(
    lonely: httpx.Client, method: str, path: str
) -> None:
    body: dict[str, object] | None = {} if method == "PUT" else None
    is_problem(lonely.request(method, path, json=body), 404, "not-simulated")
