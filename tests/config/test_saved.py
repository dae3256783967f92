from dataclasses import replace
from pathlib import Path

import pytest

from gripperd.config import (
    delete_profile,
    load_profile,
    saved_profiles,
    shipped,
    write_profile,
)
from gripperd.errors import ConfigError

APPLE = replace(load_profile(shipped("profiles/apple.yaml")), name="my_apple")


def test_what_was_saved_is_read_again(tmp_path: Path) -> None:
    folder = tmp_path / "profiles"
    assert saved_profiles(folder) == {}
    write_profile(APPLE, folder)
    assert saved_profiles(folder) == {"my_apple": APPLE}
    changed = replace(APPLE, version=2, force=20.0)
    write_profile(changed, folder)
    assert saved_profiles(folder) == {"my_apple": changed}
    delete_profile("my_apple", folder)
    assert saved_profiles(folder) == {}


def test_a_draft_that_a_power_cut_left_is_not_taken_for_a_profile(
    tmp_path: Path,
) -> None:
    write_profile(APPLE, tmp_path)
    (tmp_path / ".my_apple.draft").write_text("name: my_app")
    assert saved_profiles(tmp_path) == {"my_apple": APPLE}


def test_a_damaged_file_is_told_and_stays(tmp_path: Path) -> None:
    write_profile(APPLE, tmp_path)
    file = tmp_path / "my_apple.yaml"
    file.write_text(file.read_text()[:60])
    with pytest.raises(ConfigError, match=r"my_apple\.yaml"):
        saved_profiles(tmp_path)
    assert file.exists()
