"""The library on a disk that is broken, full or slow."""

from dataclasses import replace
from pathlib import Path

import pytest

from gripperd.config import load_profile, shipped, write_profile
from gripperd.errors import Refused
from gripperd.service.library import ProfileLibrary

APPLE = load_profile(shipped("profiles/apple.yaml"))
PEAR = replace(APPLE, name="pear")


def test_a_broken_file_costs_one_profile_and_is_reported(tmp_path: Path) -> None:
    write_profile(PEAR, tmp_path)
    (tmp_path / "plum.yaml").write_text("name: plum\nversion: many\n")
    library = ProfileLibrary({"apple": APPLE}, tmp_path)
    assert [profile.name for profile in library.all()] == ["apple", "pear"]
    assert f'{tmp_path}/plum.yaml:2: version: "many" is not a whole number' in (
        library.skipped
    )


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs the full device")
async def test_a_full_disk_is_named_and_nothing_is_remembered(tmp_path: Path) -> None:
    (tmp_path / ".pear.draft").symlink_to("/dev/full")
    library = ProfileLibrary({"apple": APPLE}, tmp_path)
    with pytest.raises(Refused, match="nothing was changed: No space left") as refused:
        await library.save(PEAR)
    assert refused.value.code == "storage-full"
    assert "pear" not in library
    assert library.next_version("pear") == 1
