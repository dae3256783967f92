"""The settings file over REST: shown, checked, and read again."""

import shutil
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import httpx
import pytest

from gripperd.config import load_settings, shipped
from tests.daemon import PATIENCE, settings_file

from .conftest import running, service
from .test_bad_input import is_problem

VALIDATE, RELOAD = "/v1/config/validate", "/v1/config/reload"


@dataclass(frozen=True)
class Here:
    """A service, and the files that it has read."""

    folder: Path
    http: httpx.Client

    def edit(self, file: str, old: str, new: str) -> None:
        """Replace something in a file."""
        text = (self.folder / file).read_text()
        assert old in text
        (self.folder / file).write_text(text.replace(old, new, 1))


@pytest.fixture
def here(tmp_path: Path) -> Iterator[Here]:
    """Settings and profiles that may be edited; nobody controls anything."""
    shutil.copytree(shipped("profiles"), tmp_path / "profiles")
    settings = load_settings(settings_file(tmp_path), {})
    with (
        running(lambda report: service(settings, report, bench=False)) as url,
        httpx.Client(base_url=url, timeout=PATIENCE) as http,
    ):
        yield Here(tmp_path, http)


def mass(http: httpx.Client) -> float:
    return float(http.get("/v1/profiles/apple").json()["mass_g"])


def test_what_was_read_is_shown_not_what_the_file_says_by_now(here: Here) -> None:
    here.edit("gripperd.yaml", "auto_enable: true", "auto_enable: false")
    found = here.http.get("/v1/config").json()
    assert found["source"] == str(here.folder / "gripperd.yaml")
    assert found["content"]["grippers"]["g0"]["auto_enable"] is True
    assert found["content"]["http"] == {"host": "127.0.0.1", "port": 0}


def test_an_unchanged_file_is_usable_and_changes_nothing(here: Here) -> None:
    checked = here.http.post(VALIDATE).json()
    assert (checked["changed"], checked["at_restart"]) == ([], [])
    assert here.http.post(RELOAD).json() == {**checked, "applied": []}


@pytest.mark.parametrize("path", [VALIDATE, RELOAD])
@pytest.mark.parametrize(
    ("change", "told"),
    [
        (("gripperd.yaml", "fail_mode:", "fial_mode:"), 'did you mean "fail_mode"?'),
        (("gripperd.yaml", "port: 0", "port: zero"), "http.port"),
        (("gripperd.yaml", "grippers:", "grippers: ["), "not YAML"),
        (("gripperd.yaml", "unit: 1", "unit: 1000"), "grippers.g0.output.unit"),
        (("profiles/apple.yaml", "mass_g: 180", "mass_kg: 0.18"), "mass_kg"),
        (("profiles/apple.yaml", "mass_g: 180", "mass_g: -180"), "-180 g"),
    ],
)
def test_an_unusable_file_is_refused_whole_with_its_line(
    here: Here, path: str, change: tuple[str, str, str], told: str
) -> None:
    here.edit("profiles/grape.yaml", "mass_g: 6", "mass_g: 7")
    here.edit(*change)
    found = is_problem(here.http.post(path), 422, "invalid")
    assert told in found["detail"]
    assert f"{here.folder / change[0]}:" in found["detail"]
    assert here.http.get("/v1/profiles/grape").json()["mass_g"] == 6


def test_a_missing_file_is_named(here: Here) -> None:
    (here.folder / "gripperd.yaml").unlink()
    found = is_problem(here.http.post(RELOAD), 422, "invalid")
    assert found["detail"] == f"{here.folder / 'gripperd.yaml'}: there is no such file"
    assert here.http.get("/v1/config").json()["content"]["grippers"]


def test_a_profile_counts_once_it_is_read_again(here: Here) -> None:
    here.edit("profiles/apple.yaml", "mass_g: 180", "mass_g: 190")
    assert here.http.post(VALIDATE).json()["changed"] == ["profiles.apple"]
    assert mass(here.http) == 180
    found = here.http.post(RELOAD).json()
    assert (found["applied"], found["at_restart"]) == (["profiles.apple"], [])
    assert mass(here.http) == 190
    assert here.http.post(RELOAD).json()["applied"] == []


def test_what_only_a_start_reads_waits_for_one_and_says_so(
    here: Here,
) -> None:
    here.edit("gripperd.yaml", "auto_enable: true", "auto_enable: false")
    here.edit("profiles/apple.yaml", "mass_g: 180", "mass_g: 190")
    found = here.http.post(RELOAD).json()
    assert found["applied"] == ["profiles.apple"]
    assert found["at_restart"] == ["grippers.g0"]
    assert here.http.post(RELOAD).json()["at_restart"] == ["grippers.g0"]


def test_a_saved_profile_stays_when_the_originals_are_read_again(
    here: Here,
) -> None:
    own = here.http.get("/v1/profiles/apple").json() | {"name": "pear"}
    here.http.post("/v1/profiles", json=own).raise_for_status()
    here.edit("profiles/apple.yaml", "mass_g: 180", "mass_g: 190")
    here.http.post(RELOAD).raise_for_status()
    assert here.http.get("/v1/profiles/pear").json()["mass_g"] == 180
    assert mass(here.http) == 190
