"""The main job, end to end: REST to the jaws of the bench, over real sockets."""

import subprocess
import time
from collections.abc import Iterator
from http import HTTPStatus
from pathlib import Path
from typing import Any

import httpx
import pytest
from pyModbusTCP.client import ModbusClient

from tests.daemon import PATIENCE, Daemon, document, running_daemon, until
from tests.interop.programs import needed

OBJECTS = ("apple", "peach", "raw_egg", "grape")


@pytest.fixture(scope="module")
def daemon(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Daemon]:
    with running_daemon(tmp_path_factory.mktemp("daemon")) as daemon:
        yield daemon


@pytest.fixture
def http(daemon: Daemon) -> Iterator[httpx.Client]:
    """A client; the jaws are open and empty when it comes."""
    with httpx.Client(base_url=f"{daemon.url}/v1", timeout=PATIENCE) as http:
        until(lambda: ready_again(http) and released(http))
        http.delete("/bench/object").raise_for_status()
        until(lambda: http.get("/bench").json()["opening_mm"] > 84.9)
        yield http
        http.delete("/bench/faults").raise_for_status()


def ready_again(http: httpx.Client) -> bool:
    """Whether it is ready; after a fault, do what a person does on the way there."""
    machine = http.get("/grippers/g0").json().get("machine")
    if machine == "fault":
        for fault in http.get("/grippers/g0/faults").json()["faults"]:
            place = f"/grippers/g0/faults/{fault['id']}/acknowledge"
            http.post(place, json={"by": "the test"})
        http.post("/grippers/g0/reset")
    if machine == "disabled":
        http.post("/grippers/g0/enable")
    return bool(machine == "ready")


def released(http: httpx.Client) -> bool:
    """Whether it let go; what is held too hard may have become a fault just before."""
    return _posted(http, {"type": "release"}).status_code == HTTPStatus.CREATED


def command(http: httpx.Client, body: dict[str, object]) -> dict[str, Any]:
    answer = _posted(http, body)
    assert answer.status_code == HTTPStatus.CREATED, answer.text
    document: dict[str, Any] = answer.json()
    return document


def _posted(http: httpx.Client, body: dict[str, object]) -> httpx.Response:
    return http.post("/grippers/g0/commands", json=body, headers={"Prefer": "wait=60"})


def place(http: httpx.Client, **kind: object) -> None:
    http.put("/bench/object", json=kind).raise_for_status()


@pytest.mark.parametrize("name", OBJECTS)
def test_one_current_holds_every_object_as_predicted(
    http: httpx.Client, name: str
) -> None:
    place(http, profile=name)
    done = command(http, {"type": "grasp", "profile": name, "current_mA": 10.7})
    assert done["status"] == "succeeded"
    result = done["result"]
    assert result["outcome"] == "held"
    assert result["force_N"] == pytest.approx(result["predicted_force_N"], rel=0.05)
    truth = http.get("/bench").json()
    assert truth["force_N"] == pytest.approx(result["force_N"], rel=0.05)
    assert truth["object"]["state"] == "held"
    assert not truth["object"]["cracked"]


@pytest.mark.parametrize("name", OBJECTS)
def test_force_mode_holds_every_object_inside_its_window(
    http: httpx.Client, name: str
) -> None:
    place(http, profile=name)
    done = command(http, {"type": "grasp", "profile": name})
    assert done["result"]["outcome"] == "held"
    assert done["params"]["mode"] == "force"
    assert done["result"]["slip_margin"] >= 1.5
    assert done["result"]["crush_margin"] >= 1.3
    assert not http.get("/bench").json()["object"]["cracked"]


def test_a_prediction_of_the_profile_is_what_is_measured(http: httpx.Client) -> None:
    foreseen = http.post(
        "/profiles/grape/evaluate", json={"mode": "current", "current_mA": 10.7}
    ).json()
    place(http, profile="grape")
    done = command(http, {"type": "grasp", "profile": "grape", "current_mA": 10.7})
    predicted = foreseen["force_N"]
    assert done["result"]["force_N"] == pytest.approx(predicted, rel=0.05)


def test_empty_jaws_give_no_object_and_the_machine_stays_ready(
    http: httpx.Client,
) -> None:
    done = command(http, {"type": "grasp", "profile": "apple", "current_mA": 10.7})
    assert (done["status"], done["result"]["outcome"]) == ("failed", "no_object")
    assert done["error"]["category"] == "outcome"
    state = http.get("/grippers/g0").json()
    assert (state["machine"], state["grip"]) == ("ready", "no_part")


def test_a_small_object_is_told_and_not_let_go(http: httpx.Client) -> None:
    place(
        http,
        diameter_mm=35,
        stiffness_N_per_mm=40,
        mass_g=100,
        friction=0.5,
        damage_force_N=90,
    )
    done = command(http, {"type": "grasp", "profile": "apple"})
    assert done["result"]["outcome"] == "too_small"
    assert done["result"]["size_mm"] == pytest.approx(35, abs=0.5)
    assert http.get("/grippers/g0").json()["grip"] == "holding"


def test_a_target_over_the_limit_is_refused_before_anything_moves(
    http: httpx.Client,
) -> None:
    place(http, profile="raw_egg")
    before = http.get("/bench").json()
    answer = http.post(
        "/grippers/g0/commands",
        json={"type": "grasp", "profile": "raw_egg", "force_N": 40},
    )
    assert answer.status_code == 422
    assert answer.headers["content-type"] == "application/problem+json"
    problem = answer.json()
    assert "40" in problem["detail"]
    assert "35" in problem["detail"]
    after = http.get("/bench").json()
    assert after["current_mA"] == before["current_mA"]
    assert after["opening_mm"] == pytest.approx(before["opening_mm"], abs=0.01)


def test_stop_freezes_the_jaws(
    http: httpx.Client,
) -> None:
    http.post("/grippers/g0/commands", json={"type": "grasp", "profile": "grape"})
    until(lambda: http.get("/bench").json()["opening_mm"] < 70)
    stopped = http.get("/bench").json()["time_s"]
    http.post("/grippers/g0/stop").raise_for_status()
    until(lambda: http.get("/bench").json()["time_s"] > stopped + 0.15)
    first = http.get("/bench").json()["opening_mm"]
    time.sleep(0.5)
    assert http.get("/bench").json()["opening_mm"] == pytest.approx(first, abs=0.1)
    until(lambda: http.get("/grippers/g0").json()["machine"] == "ready")


def test_stop_does_not_let_go(http: httpx.Client) -> None:
    place(http, profile="raw_egg")
    held = command(http, {"type": "grasp", "profile": "raw_egg"})["result"]["force_N"]
    http.post("/grippers/g0/stop").raise_for_status()
    until(lambda: http.get("/grippers/g0").json()["machine"] == "ready")
    assert http.get("/bench").json()["force_N"] == pytest.approx(held, rel=0.05)
    assert http.get("/grippers/g0").json()["grip"] == "holding"


def test_release_opens(http: httpx.Client) -> None:
    place(http, profile="apple")
    command(http, {"type": "grasp", "profile": "apple"})
    assert command(http, {"type": "release"})["status"] == "succeeded"
    until(lambda: http.get("/bench").json()["opening_mm"] > 84.9)
    assert http.get("/grippers/g0").json()["grip"] == "released"


def test_low_supply_is_told_as_force_not_reached(http: httpx.Client) -> None:
    place(http, profile="apple")
    http.put("/bench/faults", json={"supply_kPa": 140}).raise_for_status()
    done = command(http, {"type": "grasp", "profile": "apple"})
    assert done["result"]["outcome"] == "force_not_reached"


def test_a_heavy_slippery_object_slips(http: httpx.Client) -> None:
    place(http, profile="apple", mass_g=2000, friction=0.1)
    done = command(http, {"type": "grasp", "profile": "apple", "current_mA": 10.7})
    assert done["result"]["outcome"] == "slipped"
    assert http.get("/grippers/g0").json()["grip"] == "part_lost"


def test_a_valve_that_gives_too_much_is_caught_before_the_egg_cracks(
    http: httpx.Client,
) -> None:
    place(http, profile="raw_egg")
    # Less than the 30 kPa that count as a fault of the valve.
    http.put("/bench/faults", json={"valve_offset_kPa": 25}).raise_for_status()
    done = command(http, {"type": "grasp", "profile": "raw_egg", "current_mA": 10.7})
    assert done["result"]["outcome"] == "crush_limit"
    assert not http.get("/bench").json()["object"]["cracked"]


def test_blind_jaws_own_up(http: httpx.Client) -> None:
    place(http, profile="apple")
    http.put(
        "/bench/faults", json={"broken": ["pressure", "opening", "grip"]}
    ).raise_for_status()
    done = command(http, {"type": "grasp", "profile": "apple"})
    assert done["result"]["outcome"] == "unknown"
    force = http.get("/grippers/g0").json()["measured"]["force_N"]
    assert (force["value"], force["quality"]) == (None, "bad")
    assert "3.6 mA" in force["cause"]


def test_another_modbus_client_reads_the_hold(
    http: httpx.Client, daemon: Daemon
) -> None:
    place(http, profile="raw_egg")
    command(http, {"type": "grasp", "profile": "raw_egg", "current_mA": 10.7})
    host, port = daemon.bench
    client = ModbusClient(host=host, port=port, unit_id=1)
    assert client.read_holding_registers(0, 1) == [10700]
    client.close()


def test_mbpoll_reads_the_hold_and_closes_the_jaws_by_itself(
    http: httpx.Client, daemon: Daemon
) -> None:
    host, port = daemon.bench
    register = ["-m", "tcp", "-p", str(port), "-a", "1", "-0", "-r", "0", "-t", "4"]
    place(http, profile="raw_egg")
    command(http, {"type": "grasp", "profile": "raw_egg", "current_mA": 10.7})
    read = [needed("mbpoll"), *register, "-1", "-q", host]
    said = subprocess.run(read, capture_output=True, text=True, check=True).stdout
    assert "10700" in said

    command(http, {"type": "release"})
    http.delete("/bench/object").raise_for_status()
    until(lambda: http.get("/bench").json()["opening_mm"] > 84.9)
    subprocess.run([*read, "10700"], capture_output=True, check=True)
    until(lambda: http.get("/bench").json()["opening_mm"] < 20)
    # The daemon adopts what it did not command, and does not fight it.
    until(lambda: http.get("/grippers/g0").json()["adopted"])
    assert http.get("/grippers/g0").json()["current_mA"] == pytest.approx(10.7)


def test_two_clients_race_and_one_wins(http: httpx.Client) -> None:
    place(http, profile="apple")
    body = {"type": "grasp", "profile": "apple"}
    answers = [
        http.post("/grippers/g0/commands", json=body, headers={"Idempotency-Key": key})
        for key in ("line-1", "line-1")
    ]
    assert [answer.status_code for answer in answers] == [201, 200]
    assert answers[0].json()["id"] == answers[1].json()["id"]
    identity = answers[0].json()["id"]
    done = http.get(f"/grippers/g0/commands/{identity}", params={"wait_s": 20}).json()
    assert done["result"]["outcome"] == "held"
    refused = http.post("/grippers/g0/commands", json=body)
    assert refused.status_code == 409
    assert refused.json()["code"] == "object-held"


def test_what_ran_is_told_phase_by_phase(http: httpx.Client) -> None:
    place(http, profile="apple")
    done = command(http, {"type": "grasp", "profile": "apple"})
    assert [line.split()[2] for line in done["log"]] == [
        "approach",
        "touch",
        "build",
        "verify",
        "held",
    ]


def test_the_settings_file_is_where_it_was_told(tmp_path: Path) -> None:
    with running_daemon(tmp_path) as daemon:
        found = document(f"{daemon.url}/v1/info")
    assert found["mode"] == "simulated"
