"""What is told to differ between two readings of the same settings."""

import shutil
from pathlib import Path

import pytest

from gripperd.config import load_settings, shipped
from gripperd.config.change import changes


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A copy of the shipped settings with everything they name."""
    shutil.copytree(shipped("gripperd.yaml").parent, tmp_path / "config")
    return tmp_path / "config"


@pytest.mark.parametrize(
    ("file", "old", "new", "parts"),
    [
        ("gripperd.yaml", "port: 8765", "port: 8766", ["http"]),
        ("gripperd.yaml", "auto_enable: true", "auto_enable: false", ["grippers.g0"]),
        ("gripperd.yaml", "  g0:", "  g1:", ["grippers.g0", "grippers.g1"]),
        (
            "models/reference.yaml",
            "value: 85, tolerance",
            "value: 84, tolerance",
            ["grippers.g0"],
        ),
        ("profiles/apple.yaml", "mass_g: 180", "mass_g: 181", ["profiles.apple"]),
        ("profiles/apple.yaml", "mass_g: 180", "mass_g: 180.0", []),
    ],
)
def test_what_a_file_says_otherwise_is_told_by_the_part_it_is_of(
    folder: Path, file: str, old: str, new: str, parts: list[str]
) -> None:
    before = load_settings(folder / "gripperd.yaml", {})
    path = folder / file
    assert old in path.read_text()
    path.write_text(path.read_text().replace(old, new))
    found = list(changes(before, load_settings(folder / "gripperd.yaml", {})))
    assert found == parts


def test_a_profile_that_is_gone_is_a_change(folder: Path) -> None:
    before = load_settings(folder / "gripperd.yaml", {})
    (folder / "profiles" / "grape.yaml").unlink()
    after = load_settings(folder / "gripperd.yaml", {})
    assert list(changes(before, after)) == ["profiles.grape"]
