"""Versions of the model over REST, and a swap under a control loop that runs."""

import asyncio
from collections.abc import Iterator
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import httpx
import pytest

from gripperd.config import ModelFile, Provenance, Settings
from gripperd.config.lineage import Added, Recorded
from gripperd.effects.supply_saturation import SupplySaturation
from gripperd.effects.threshold_pressure import ThresholdPressure
from gripperd.link.client import Client
from gripperd.store import Version, Versions, versions_of
from gripperd.store.activation import activation

from .asking import asked, sent
from .conftest import Daemon

ASKED = {"current_mA": 10.7, "diameter_mm": 65}
COMMANDS = "/v1/grippers/g0/commands"


@pytest.fixture(scope="module")
def versions(drawn_settings: Settings) -> Versions:
    return versions_of(drawn_settings, drawn_settings.grippers["g0"])


def add(versions: Versions, model: ModelFile) -> Version:
    return versions.add(
        model,
        parent=0,
        created_at=datetime(2026, 1, 31, 12, tzinfo=UTC),
        provenance=Provenance(
            program="0.1.0",
            recording=Recorded(name="cycles", sha256="a" * 64),
            seed=1,
            effects=(Added(name="parameter:gripper.spring_preload_N"),),
        ),
    )


@pytest.fixture(scope="module")
def stiffer(versions: Versions) -> Version:
    """A return spring with 20 N more: 5 N less for each jaw, at a ratio of 4."""
    base = versions.get(0).model
    assert base.linkage is not None
    linkage = replace(base.linkage, spring_preload=260.0)
    return add(versions, replace(base, linkage=linkage))


@pytest.fixture
def http(drawn: Daemon) -> Iterator[httpx.Client]:
    """A client of a daemon that goes by the configured model, before and after."""
    yield drawn.http
    drawn.http.post(f"{COMMANDS}?wait_s=60", json={"type": "release"})
    assert drawn.http.post("/v1/models/0/activate").status_code == 200


def predicted(http: httpx.Client) -> tuple[str, float]:
    found = http.post("/v1/predictions", json=ASKED).json()
    return found["model"], found["predictions"][0]["force_N"]


def problem(answer: httpx.Response) -> dict[str, Any]:
    assert answer.headers["content-type"] == "application/problem+json"
    found: dict[str, Any] = answer.json()
    assert found["status"] == answer.status_code
    return found


def test_versions_are_listed_with_their_parents(
    http: httpx.Client, stiffer: Version
) -> None:
    found = http.get("/v1/models").json()
    assert (found["gripper"], found["grippers"]) == ("g0", ["g0"])
    assert (found["active"], found["complaints"]) == ("as-drawn", [])
    first, *_ = found["versions"]
    assert (first["name"], first["version"], first["active"]) == ("as-drawn", 0, True)
    (listed,) = [one for one in found["versions"] if one["name"] == stiffer.name]
    assert (listed["parent"], listed["active"]) == (0, False)
    assert listed["added"] == ["parameter:gripper.spring_preload_N"]
    assert listed["created_at"] == "2026-01-31T12:00:00Z"


def test_a_version_is_read_by_name_by_number_and_as_the_active_one(
    http: httpx.Client, stiffer: Version
) -> None:
    by_name = http.get(f"/v1/models/{stiffer.name}").json()
    assert by_name == http.get(f"/v1/models/{stiffer.number}").json()
    assert by_name["content"]["gripper"]["spring_preload_N"] == 260.0
    assert by_name["content"]["provenance"]["recording"]["name"] == "cycles"
    assert http.get("/v1/models/active").json()["name"] == "as-drawn"


def test_an_activated_version_counts_at_once_and_moves_nothing(
    http: httpx.Client, stiffer: Version
) -> None:
    name, force = predicted(http)
    current = http.get("/v1/grippers/g0").json()["current_mA"]
    answer = http.post(f"/v1/models/{stiffer.name}/activate")
    assert answer.json() == {
        "name": stiffer.name,
        "version": stiffer.number,
        "grippers": ["g0"],
    }
    followed, less = predicted(http)
    assert followed == stiffer.name
    assert less == pytest.approx(force - 5.0)
    state = http.get("/v1/grippers/g0").json()
    assert (state["model"], state["current_mA"]) == (stiffer.name, current)
    assert http.get("/v1/info").json()["models"] == {"g0": stiffer.name}
    evaluation = http.post("/v1/profiles/apple/evaluate").json()
    assert evaluation["model"] == stiffer.name
    assert http.get("/v1/models").json()["active"] == stiffer.name
    # To go back, the parent is activated.
    parent = http.get("/v1/models/active").json()["parent"]
    assert http.post(f"/v1/models/{parent}/activate").status_code == 200
    assert predicted(http) == (name, force)


def test_the_result_of_a_grasp_names_the_version_it_went_by(
    http: httpx.Client, stiffer: Version
) -> None:
    predictions = []
    for version in (0, stiffer.number):
        assert http.post(f"/v1/models/{version}/activate").status_code == 200
        http.put("/v1/bench/object", json={"profile": "apple"})
        order = {"type": "grasp", "profile": "apple", "current_mA": 10.7}
        held = http.post(f"{COMMANDS}?wait_s=60", json=order).json()
        assert held["status"] == "succeeded", held
        predictions.append(held["result"]["predicted_force_N"])
        names = {held["params"]["model"], held["result"]["model"]}
        assert names == {http.get("/v1/models/active").json()["name"]}
        http.post(f"{COMMANDS}?wait_s=60", json={"type": "release"})
    assert predictions[0] - predictions[1] == pytest.approx(5.0, abs=0.3)


def test_no_version_is_taken_up_while_a_gripper_moves_or_holds(
    drawn: Daemon, http: httpx.Client, stiffer: Version
) -> None:
    before = predicted(http)
    http.put("/v1/bench/object", json={"profile": "apple"})
    http.post(COMMANDS, json={"type": "grasp", "profile": "apple"})
    drawn.until("/v1/grippers/g0", lambda state: state["machine"] == "executing")
    moving = problem(http.post(f"/v1/models/{stiffer.name}/activate"))
    assert (moving["status"], moving["code"]) == (409, "wrong-state")
    assert moving["retryable"]
    drawn.until("/v1/grippers/g0", lambda state: state["grip"] == "holding")
    holding = problem(http.post(f"/v1/models/{stiffer.name}/activate"))
    assert (holding["status"], holding["code"]) == (409, "object-held")
    assert holding["hints"] == ["release first"]
    assert predicted(http) == before
    assert http.get("/v1/models").json()["active"] == "as-drawn"


def test_a_damaged_version_is_refused_with_its_file(
    http: httpx.Client, versions: Versions
) -> None:
    version = add(versions, versions.get(0).model)
    file = Path(version.model.source)
    whole = file.read_text()
    file.write_text(whole.replace("diameter_mm: 20.0", "diameter_mm: 25.0"))
    try:
        for answer in (
            http.post(f"/v1/models/{version.number}/activate"),
            http.get(f"/v1/models/{version.number}"),
        ):
            refused = problem(answer)
            assert (refused["status"], refused["code"]) == (409, "model-unusable")
            assert f"{file}: is not as it was written" in refused["detail"]
        (complaint,) = http.get("/v1/models").json()["complaints"]
        assert "is not as it was written" in complaint
        assert predicted(http)[0] == "as-drawn"
    finally:
        file.write_text(whole)


def test_a_version_that_no_current_closes_is_refused(
    http: httpx.Client, versions: Versions
) -> None:
    # The supply gives 25 kPa, and the bladder takes 60 before it pulls.
    drawn = versions.get(0).model
    bladder = (*drawn.static.effects, ThresholdPressure(60e3))
    weak = replace(
        drawn,
        static=replace(drawn.static, effects=bladder),
        effects=(SupplySaturation(share=1.0, limit=0.05),),
    )
    version = add(versions, weak)
    refused = problem(http.post(f"/v1/models/{version.number}/activate"))
    assert (refused["status"], refused["code"]) == (409, "model-unusable")
    assert "it does not close" in refused["detail"]
    assert predicted(http)[0] == "as-drawn"


def test_what_cannot_be_kept_is_not_gone_by(
    http: httpx.Client, stiffer: Version, drawn_settings: Settings
) -> None:
    lock = drawn_settings.state_dir / "models/as-drawn/.lock"
    lock.unlink()
    lock.mkdir()
    try:
        refused = problem(http.post(f"/v1/models/{stiffer.name}/activate"))
    finally:
        lock.rmdir()
    assert (refused["status"], refused["code"]) == (503, "storage-failed")
    assert http.get("/v1/grippers/g0").json()["model"] == "as-drawn"
    assert predicted(http)[0] == "as-drawn"


@pytest.mark.parametrize(
    ("path", "status", "said"),
    [
        ("/v1/models/77/activate", 404, "as-drawn has no version '77'"),
        ("/v1/models/0/activate?gripper=g7", 404, "there is no gripper 'g7'"),
        ("/v1/models/0/activate?griper=g0", 422, "griper: is not a parameter here"),
    ],
)
def test_what_is_not_there_is_told(
    http: httpx.Client, path: str, status: int, said: str
) -> None:
    refused = problem(http.post(path))
    assert (refused["status"], said in refused["detail"]) == (status, True)


def test_without_control_nothing_is_activated_and_predictions_go_on(
    lonely: httpx.Client,
) -> None:
    refused = problem(lonely.post("/v1/models/0/activate"))
    assert (refused["status"], refused["retryable"]) == (503, True)
    assert predicted(lonely)[0] == "reference"


def by_the_command_line(settings: Settings, version: int) -> None:
    """Activate a version, as another process that read these settings does."""

    async def activate() -> None:
        client = Client(settings.runtime_dir / "control.sock", "control")
        found = activation(settings, "g0", version)
        await found.take_up(client)
        await client.close()

    asyncio.run(activate())


def test_a_version_that_somebody_else_let_control_take_up_is_followed(
    http: httpx.Client, drawn_settings: Settings, stiffer: Version
) -> None:
    _, force = predicted(http)
    by_the_command_line(drawn_settings, stiffer.number)
    name, less = predicted(http)
    assert name == stiffer.name
    assert less == pytest.approx(force - 5.0)


def test_of_an_edited_file_predictions_are_what_control_makes_of_it(
    drawn: Daemon, http: httpx.Client, drawn_settings: Settings, rig_folder: Path
) -> None:
    """20 N more of the return spring: 5 N less for each jaw, at a ratio of 4."""
    gripper = drawn_settings.grippers["g0"]
    assert gripper.model.linkage is not None
    linkage = replace(gripper.model.linkage, spring_preload=260.0)
    model = replace(gripper.model, linkage=linkage)
    edited = replace(
        drawn_settings,
        grippers={"g0": replace(gripper, model=model, chain=model.chain())},
    )
    name, force = predicted(http)
    by_the_command_line(edited, 0)
    followed, less = predicted(http)
    assert followed == name
    assert less == pytest.approx(force - 5.0)
    told = [said for said in http.get("/v1/info").json()["warnings"] if name in said]
    assert len(told) == 1
    assert "its file was edited" in told[0]
    # What would be judged is not what is gone by.
    recording = sent(drawn, (rig_folder / "rig.csv").read_bytes())
    refused = problem(asked(drawn, recording))
    assert refused["code"] == "model-changed"
    # The service takes up what it has.
    assert http.post("/v1/models/0/activate").status_code == 200
    assert predicted(http) == (name, force)
    assert not any(name in said for said in http.get("/v1/info").json()["warnings"])
