"""Profiles: originals, versions, entity tags, dry runs."""

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest

from gripperd.config import Settings

from .conftest import Daemon
from .test_bad_input import is_problem

PROFILES = "/v1/profiles"


@pytest.fixture
def mine(daemon: Daemon) -> Iterator[dict[str, Any]]:
    """A copy of the apple, and no trace of it afterwards."""
    copy = daemon.http.get(f"{PROFILES}/apple").json() | {"name": "my_apple"}
    answer = daemon.http.post(PROFILES, json=copy)
    assert answer.status_code == 201
    yield answer.json() | {"etag": answer.headers["etag"]}
    daemon.http.delete(f"{PROFILES}/my_apple", headers={"if-match": "*"})


def test_the_originals_are_there_and_read_only(daemon: Daemon) -> None:
    found = daemon.http.get(PROFILES).json()["profiles"]
    originals = {each["name"] for each in found if each["read_only"]}
    assert originals == {"apple", "peach", "raw_egg", "grape"}
    egg = daemon.http.get(f"{PROFILES}/raw_egg").json()
    assert (egg["diameter_mm"], egg["limits"]["damage_N"]) == (41.0, 35.0)


@pytest.mark.parametrize("method", ["PUT", "DELETE"])
def test_an_original_cannot_be_changed(daemon: Daemon, method: str) -> None:
    original = daemon.http.get(f"{PROFILES}/apple").json()
    answer = daemon.http.request(
        method, f"{PROFILES}/apple", json=original, headers={"if-match": "*"}
    )
    is_problem(answer, 409, "read-only")
    assert daemon.http.get(f"{PROFILES}/apple").json() == original


def test_each_save_is_the_next_version(daemon: Daemon, mine: dict[str, Any]) -> None:
    assert mine["read_only"] is False
    heavier = daemon.http.get(f"{PROFILES}/my_apple").json() | {"mass_g": 200}
    saved = daemon.http.put(
        f"{PROFILES}/my_apple", json=heavier, headers={"if-match": mine["etag"]}
    )
    assert (saved.json()["version"], saved.json()["mass_g"]) == (
        mine["version"] + 1,
        200,
    )
    read = daemon.http.get(f"{PROFILES}/my_apple")
    assert read.json() == saved.json()
    assert read.headers["etag"] == saved.headers["etag"] != mine["etag"]


def test_what_another_client_saved_is_not_overwritten(
    daemon: Daemon, mine: dict[str, Any]
) -> None:
    where, body = f"{PROFILES}/my_apple", daemon.http.get(f"{PROFILES}/my_apple").json()
    daemon.http.put(where, json=body, headers={"if-match": mine["etag"]})
    late = daemon.http.put(where, json=body, headers={"if-match": mine["etag"]})
    is_problem(late, 412, "changed-since")
    gone = daemon.http.delete(where, headers={"if-match": mine["etag"]})
    is_problem(gone, 412, "changed-since")
    is_problem(daemon.http.put(where, json=body), 428, "if-match-required")
    is_problem(daemon.http.delete(where), 428, "if-match-required")
    assert daemon.http.get(where).json()["version"] == mine["version"] + 1


def test_a_version_is_never_given_twice(daemon: Daemon, mine: dict[str, Any]) -> None:
    where = f"{PROFILES}/my_apple"
    body = daemon.http.get(where).json()
    assert daemon.http.delete(where, headers={"if-match": "*"}).status_code == 204
    is_problem(daemon.http.get(where), 404, "not-found")
    again = daemon.http.put(where, json=body)
    assert (again.status_code, again.json()["version"]) == (201, mine["version"] + 1)


def test_a_name_that_is_taken_is_not_made_anew(
    daemon: Daemon, mine: dict[str, Any]
) -> None:
    del mine["etag"]
    is_problem(daemon.http.post(PROFILES, json=mine), 409, "already-exists")


def test_a_new_profile_can_be_grasped_by(daemon: Daemon, mine: dict[str, Any]) -> None:
    found = daemon.http.post(f"{PROFILES}/my_apple/evaluate").json()
    assert (found["profile"], found["profile_version"]) == ("my_apple", mine["version"])


@pytest.mark.parametrize(
    ("change", "pointer", "says"),
    [
        ({"diameter_mm": "65"}, "/diameter_mm", "write 65"),
        ({"diametre_mm": 65}, "/diametre_mm", 'did you mean "diameter_mm"'),
        ({"name": "../../etc/passwd"}, "/name", "is not a name"),
        ({"margins": {"slip": 0.5, "crush": 1.3}}, "/margins/slip", "0.5 is below 1"),
    ],
)
def test_an_unusable_profile_is_named(
    daemon: Daemon, change: dict[str, object], pointer: str, says: str
) -> None:
    body = daemon.http.get(f"{PROFILES}/apple").json() | {"name": "other"} | change
    found = is_problem(daemon.http.post(PROFILES, json=body), 422, "invalid")
    assert [fault["pointer"] for fault in found["errors"]] == [pointer]
    assert says in found["detail"]


def test_the_body_and_the_path_name_the_same_profile(daemon: Daemon) -> None:
    body = daemon.http.get(f"{PROFILES}/apple").json()
    answer = daemon.http.put(f"{PROFILES}/other", json=body)
    found = is_problem(answer, 422, "invalid")
    assert found["errors"][0]["pointer"] == "/name"


def test_a_dry_run_has_both_margins(daemon: Daemon) -> None:
    found = daemon.http.post(f"{PROFILES}/raw_egg/evaluate").json()
    assert (found["feasible"], found["reasons"]) == (True, [])
    assert found["force_N"] == pytest.approx(12, abs=1e-3)
    # 58 g at 9.81 + 5 m/s2 on two pads of friction 0.4.
    slip = 0.058 * (9.80665 + 5) / (2 * 0.4)
    assert found["slip_force_N"] == pytest.approx(slip, rel=1e-5)
    assert found["slip_margin"] == pytest.approx(12 / slip, rel=1e-4)
    assert found["crush_margin"] == pytest.approx(35 / 12, rel=1e-4)


def test_a_dry_run_says_why_not(daemon: Daemon) -> None:
    where = f"{PROFILES}/raw_egg/evaluate"
    found = daemon.http.post(where, json={"force_N": 30}).json()
    assert found["feasible"] is False
    assert "damaged at 35 N" in found["reasons"][0]
    # The paper's current holds the egg at 22.5 N if it does not yield.
    found = daemon.http.post(where, json={"current_mA": 10.7}).json()
    assert found["force_N"] == pytest.approx(22.5, abs=0.3)


def test_a_disk_that_takes_nothing_changes_nothing(
    daemon: Daemon, settings: Settings, mine: dict[str, Any]
) -> None:
    where = f"{PROFILES}/my_apple"
    before = daemon.http.get(where).json()
    file = settings.state_dir / "profiles" / "my_apple.yaml"
    file.unlink()
    file.mkdir()
    try:
        heavier = before | {"mass_g": 200}
        refused = daemon.http.put(where, json=heavier, headers={"if-match": "*"})
        is_problem(refused, 503, "storage-failed")
        refused = daemon.http.delete(where, headers={"if-match": "*"})
        is_problem(refused, 503, "storage-failed")
    finally:
        file.rmdir()
    assert daemon.http.get(where).json() == before


def test_of_two_savings_at_once_one_has_not_seen_the_other(
    daemon: Daemon, mine: dict[str, Any]
) -> None:
    where = f"{PROFILES}/my_apple"
    body = daemon.http.get(where).json()

    def save(_: int) -> int:
        headers = {"if-match": mine["etag"]}
        return daemon.http.put(where, json=body, headers=headers).status_code

    with ThreadPoolExecutor(4) as clients:
        assert sorted(clients.map(save, range(4))) == [200, 412, 412, 412]
