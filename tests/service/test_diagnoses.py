"""Diagnoses over REST: with the worker, the control loop and the bench as they are."""

import json
import os
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from gripperd import __version__
from gripperd.config import Provenance, Settings, load_model, model_text
from gripperd.config.lineage import Recorded
from gripperd.demo.hidden import Hidden
from gripperd.diagnose.document import document
from gripperd.store.diagnoses import (
    BETTER,
    MODEL,
    PROVENANCE,
    RESULT,
    Diagnoses,
    Status,
    write_improvement,
)
from tests.demonstration import SEED, example

from .asking import asked, over, problem, sent, stored
from .conftest import Daemon


@pytest.fixture(scope="module")
def whole(drawn_daemon: Daemon, rig_folder: Path) -> str:
    """Id of the recording of a rig with creep."""
    return sent(drawn_daemon, (rig_folder / "rig.csv").read_bytes())


@pytest.fixture(scope="module")
def short(drawn_daemon: Daemon, rig_folder: Path) -> str:
    """Id of a recording in which nothing can be missing; it takes a second or two."""
    lines = (rig_folder / "rig.csv").read_bytes().splitlines(keepends=True)
    return sent(drawn_daemon, b"".join(lines[:45]))


@pytest.fixture(scope="module")
def creep(drawn_daemon: Daemon, whole: str) -> str:
    """Place of a diagnosis that has named creep."""
    place: str = asked(drawn_daemon, whole, seed=SEED).headers["location"]
    assert over(drawn_daemon, place)["status"] == "succeeded"
    return place


@pytest.fixture(scope="module")
def nothing(drawn_daemon: Daemon, short: str) -> str:
    """Place of a diagnosis that has named nothing."""
    place: str = asked(drawn_daemon, short).headers["location"]
    assert over(drawn_daemon, place)["verdict"] == "none"
    return place


def test_a_diagnosis_is_the_one_that_the_command_line_makes(
    drawn: Daemon, creep: str, whole: str
) -> None:
    found = drawn.http.get(creep).json()
    model, diagnosis = example(Hidden.CREEP)
    here = document(diagnosis, model=model.name, program=__version__)
    result = json.loads(json.dumps(here))
    # So small a chance has the sums of its processor in its last digits.
    chances = [_chances(one) for one in (found["result"], result)]
    assert chances[0] == pytest.approx(chances[1], rel=0.01)
    assert found["result"] == result
    assert (found["verdict"], found["recording"]) == ("named", whole)
    assert (found["model"], found["seed"]) == ("as-drawn", SEED)
    assert found["created_at"] <= found["started_at"] <= found["completed_at"]
    assert (found["error"], found["objection"]) == (None, None)


def _chances(result: dict[str, Any]) -> list[float]:
    """Take the chances of a result out of it."""
    return [effect["evidence"].pop("p_value") for effect in result["effects"]]


def test_diagnoses_are_listed_without_their_results(drawn: Daemon, creep: str) -> None:
    listed = drawn.http.get("/v1/diagnoses").json()["diagnoses"]
    (found,) = [one for one in listed if creep.endswith(one["id"])]
    assert found["verdict"] == "named"
    assert "result" not in found


def test_the_report_is_a_page_that_loads_nothing(drawn: Daemon, creep: str) -> None:
    answer = drawn.http.get(f"{creep}/report")
    assert answer.headers["content-type"] == "text/html; charset=utf-8"
    assert "default-src 'none'" in answer.headers["content-security-policy"]
    assert answer.text.startswith("<!doctype html>")
    assert "creep" in answer.text


def test_what_was_named_is_kept_as_a_version_that_is_not_active(
    drawn: Daemon, creep: str
) -> None:
    answer = drawn.http.post(f"{creep}/accept")
    assert answer.status_code == 201
    kept = answer.json()
    assert (kept["parent"], kept["grippers"]) == (0, None)
    version = drawn.http.get(answer.headers["location"]).json()
    assert version["name"] == kept["name"]
    assert version["added"] == ["creep"]
    assert version["content"]["provenance"]["recording"]["name"] == "rig"
    assert version["gap"]["rmse_after"] < version["gap"]["rmse_before"]
    assert drawn.http.get("/v1/models").json()["active"] == "as-drawn"
    assert drawn.http.get(creep).json()["kept_as"] == kept["name"]
    status, code, detail = problem(drawn.http.post(f"{creep}/accept"))
    assert (status, code) == (409, "already-accepted")
    assert kept["name"] in detail


def test_without_a_name_there_is_nothing_to_accept(drawn: Daemon, nothing: str) -> None:
    status, code, detail = problem(drawn.http.post(f"{nothing}/accept"))
    assert (status, code) == (409, "not-named")
    assert drawn.http.get(nothing).json()["objection"] == {
        "code": code,
        "message": detail,
    }


def test_a_recording_that_is_gone_is_told_by_the_diagnosis(
    drawn: Daemon, drawn_settings: Settings, rig_folder: Path
) -> None:
    lines = (rig_folder / "rig.csv").read_bytes().splitlines(keepends=True)
    recording = sent(drawn, b"".join(lines[:50]))
    file = drawn_settings.state_dir / "recordings" / recording / "rig.csv"
    for spoilt in (lambda: file.write_bytes(lines[0] + lines[7]), file.unlink):
        spoilt()
        found = over(drawn, asked(drawn, recording).headers["location"])
        assert found["status"] == "failed"
        assert found["error"] == {
            "code": "recording-damaged",
            "message": "rig.csv is not the file that was sent; send it again",
        }
    assert sent(drawn, b"".join(lines[:50])) == recording
    found = over(drawn, asked(drawn, recording).headers["location"])
    assert found["status"] == "succeeded"


@pytest.mark.parametrize("file", [BETTER, PROVENANCE, MODEL])
@pytest.mark.parametrize("damage", [Path.unlink, lambda file: os.truncate(file, 99)])
def test_what_was_damaged_since_is_not_accepted(
    drawn: Daemon,
    drawn_settings: Settings,
    named: str,
    file: str,
    damage: Callable[[Path], object],
) -> None:
    place = drawn_settings.state_dir / "diagnoses" / named.rpartition("/")[2]
    damage(place / file)
    before = drawn.http.get("/v1/models").json()
    status, code, _ = problem(drawn.http.post(f"{named}/accept"))
    wanted = "model-changed" if file == MODEL else "model-unusable"
    assert (status, code) == (409, wanted)
    assert drawn.http.get("/v1/models").json() == before


@pytest.mark.parametrize(
    ("body", "pointer", "said"),
    [
        ({"recording": "0" * 64}, "/recording", "there is no recording"),
        ({"recording": "../../etc"}, "/recording", "there is no recording"),
        ({"model": "as-drawn-77"}, "/model", "has no version 'as-drawn-77'"),
        ({"gripper": "g7"}, "/gripper", "there is no gripper 'g7'"),
        ({"seed": -1}, "/seed", "-1"),
        ({"sed": 1}, "/sed", 'did you mean "seed"?'),
    ],
)
def test_what_cannot_be_diagnosed_is_refused_with_its_key(
    drawn: Daemon, short: str, body: dict[str, object], pointer: str, said: str
) -> None:
    answer = drawn.http.post("/v1/diagnoses", json={"recording": short, **body})
    status, code, detail = problem(answer)
    assert (status, code) == (422, "invalid")
    assert said in detail
    assert answer.json()["errors"][0]["pointer"] == pointer


@pytest.mark.parametrize("way", ["", "/report", "/accept"])
def test_what_is_not_there_is_not_found(drawn: Daemon, way: str) -> None:
    place = f"/v1/diagnoses/{'0' * 32}{way}"
    answer = drawn.http.post(place) if way == "/accept" else drawn.http.get(place)
    assert problem(answer)[:2] == (404, "not-found")


@pytest.fixture
def named(drawn_settings: Settings, rig_folder: Path) -> str:
    """Place of a diagnosis of an earlier life: a spring stiffer by 20 N was named."""
    kept = Diagnoses(drawn_settings.state_dir / "diagnoses")
    model = load_model(rig_folder / "model.yaml")
    assert model.linkage is not None
    better = replace(model, linkage=replace(model.linkage, spring_preload=260.0))
    made = Provenance(
        program="0.1.0", recording=Recorded(name="rig", sha256="a" * 64), seed=0
    )
    number = len(kept.all())
    found = replace(stored(Status.SUCCEEDED), id=f"{number:032x}")
    kept.put(found)
    (kept.place(found.id) / MODEL).write_text(model_text(model))
    write_improvement(better, made, kept.place(found.id))
    (kept.place(found.id) / RESULT).write_text('{"verdict": "named"}')
    return f"/v1/diagnoses/{found.id}"


@pytest.fixture
def back(drawn: Daemon) -> Iterator[None]:
    """Go by the configured model again afterwards."""
    yield
    release = {"type": "release"}
    drawn.http.post("/v1/grippers/g0/commands?wait_s=60", json=release)
    assert drawn.http.post("/v1/models/0/activate").status_code == 200


@pytest.mark.usefixtures("back")
def test_a_version_is_gone_by_at_once_if_that_is_asked(
    drawn: Daemon, named: str
) -> None:
    ask = {"current_mA": 10.7, "diameter_mm": 65}
    before = drawn.http.post("/v1/predictions", json=ask).json()
    kept = drawn.http.post(f"{named}/accept", json={"activate": True}).json()
    assert kept["grippers"] == ["g0"]
    after = drawn.http.post("/v1/predictions", json=ask).json()
    assert after["model"] == kept["name"]
    # 20 N of spring at a ratio of 4.
    (weaker,), (stronger,) = after["predictions"], before["predictions"]
    assert stronger["force_N"] - weaker["force_N"] == pytest.approx(5.0)


@pytest.mark.usefixtures("back")
def test_a_version_is_kept_but_not_gone_by_while_an_object_is_held(
    drawn: Daemon, named: str
) -> None:
    drawn.http.put("/v1/bench/object", json={"profile": "apple"})
    order = {"type": "grasp", "profile": "apple"}
    held = drawn.http.post("/v1/grippers/g0/commands?wait_s=60", json=order).json()
    assert held["status"] == "succeeded"
    answer = drawn.http.post(f"{named}/accept", json={"activate": True})
    status, code, detail = problem(answer)
    name = drawn.http.get(named).json()["kept_as"]
    assert (status, code) == (409, "object-held")
    assert detail.startswith(f"kept as {name}, which is not active: g0 is ready")
    assert drawn.http.get("/v1/grippers/g0").json()["model"] == "as-drawn"
