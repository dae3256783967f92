from dataclasses import replace
from pathlib import Path

import pytest

from gripperd.config import (
    SavedProfiles,
    delete_profile,
    load_profile,
    saved_profiles,
    shipped,
    write_profile,
)

APPLE = replace(load_profile(shipped("profiles/apple.yaml")), name="my_apple")


def test_what_was_saved_is_read_again(tmp_path: Path) -> None:
    folder = tmp_path / "profiles"
    assert saved_profiles(folder) == SavedProfiles({}, ())
    write_profile(APPLE, folder)
    assert saved_profiles(folder).profiles == {"my_apple": APPLE}
    changed = replace(APPLE, version=2, force=20.0)
    write_profile(changed, folder)
    assert saved_profiles(folder).profiles == {"my_apple": changed}
    delete_profile("my_apple", folder)
    assert saved_profiles(folder).profiles == {}


def test_a_draft_that_a_power_cut_left_is_not_taken_for_a_profile(
    tmp_path: Path,
) -> None:
    write_profile(APPLE, tmp_path)
    (tmp_path / ".my_apple.draft").write_text("name: my_app")
    assert saved_profiles(tmp_path) == SavedProfiles({"my_apple": APPLE}, ())


def test_a_damaged_file_is_told_and_stays_and_harms_no_other(tmp_path: Path) -> None:
    write_profile(APPLE, tmp_path)
    pear = replace(APPLE, name="pear")
    write_profile(pear, tmp_path)
    file = tmp_path / "my_apple.yaml"
    file.write_text(file.read_text().replace("diameter_mm: 65.0", "diameter_mm: big"))
    found = saved_profiles(tmp_path)
    assert found.profiles == {"pear": pear}
    (said,) = found.complaints
    assert said == f'{file}:3: diameter_mm: "big" is not a number (mm)'
    assert file.exists()


def test_what_cannot_be_written_leaves_the_old_one_and_no_draft(tmp_path: Path) -> None:
    (tmp_path / "my_apple.yaml").mkdir()
    with pytest.raises(OSError, match="directory"):
        write_profile(APPLE, tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["my_apple.yaml"]


def test_what_is_gone_already_can_be_removed(tmp_path: Path) -> None:
    delete_profile("my_apple", tmp_path)
