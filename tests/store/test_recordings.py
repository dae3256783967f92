from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path

import pytest

from gripperd.errors import NotFound
from gripperd.store.recordings import Contents, Recordings, RunContents, StoredRecording

FIRST = "first"
SHA = "a7937b64b8caa58f03721bb6bacf5c78cb235febe0e70b1b84cd99541461a08e"
"""Of the word above, as ``sha256sum`` has it."""


def described(sha: str = SHA, hour: int = 12) -> StoredRecording:
    return StoredRecording(
        file="rig.csv",
        size=9,
        created_at=datetime(2026, 1, 31, hour, tzinfo=UTC),
        contents=Contents(
            name="rig",
            sha256=sha,
            columns=("t_s", "force_N"),
            runs=(RunContents(name="up", samples=2, duration_s=0.5),),
            rejected_samples=(),
            remarks=("A remark.",),
        ),
    )


def kept(recordings: Recordings, recording: StoredRecording, content: str) -> bool:
    with recordings.draft() as draft:
        (draft / "rig.csv").write_text(content)
        return recordings.keep(draft, recording)


@pytest.fixture
def recordings(tmp_path: Path) -> Recordings:
    return Recordings(tmp_path / "recordings")


def test_a_recording_that_was_kept_is_there_in_another_life(
    recordings: Recordings, tmp_path: Path
) -> None:
    assert kept(recordings, described(), "run,t_s\n")
    again = Recordings(tmp_path / "recordings")
    found = again.get(SHA)
    assert found == described()
    assert again.path(found).read_text() == "run,t_s\n"


def test_the_same_content_is_kept_once(recordings: Recordings) -> None:
    assert kept(recordings, described(hour=12), FIRST)
    assert not kept(recordings, described(hour=13), FIRST)
    assert recordings.all() == [described(hour=12)]


@pytest.mark.parametrize("file", ["rig.csv", "record.json"])
@pytest.mark.parametrize("damage", [Path.unlink, lambda file: file.write_text("{")])
def test_what_was_damaged_is_mended_by_sending_it_again(
    recordings: Recordings, tmp_path: Path, file: str, damage: Callable[[Path], object]
) -> None:
    kept(recordings, described(hour=12), FIRST)
    assert recordings.intact(SHA)
    damage(tmp_path / "recordings" / SHA / file)
    assert not recordings.intact(SHA)
    assert kept(recordings, described(hour=13), FIRST)
    assert recordings.all() == [described(hour=13)]
    assert recordings.path(recordings.get(SHA)).read_text() == FIRST


def test_the_newest_comes_first(recordings: Recordings) -> None:
    old, new = described("1" * 64, hour=1), described("2" * 64, hour=2)
    for one in (old, new):
        kept(recordings, one, "x")
    assert recordings.all() == [new, old]


def test_a_draft_leaves_nothing(recordings: Recordings, tmp_path: Path) -> None:
    with recordings.draft() as draft:
        (draft / "rig.csv").write_text("half")
    assert list((tmp_path / "recordings").iterdir()) == []


def test_a_content_without_its_record_is_no_recording(
    recordings: Recordings, tmp_path: Path
) -> None:
    place = tmp_path / "recordings" / SHA
    place.mkdir(parents=True)
    (place / "rig.csv").write_text("cut off by a power cut")
    assert recordings.all() == []
    with pytest.raises(NotFound):
        recordings.get(SHA)
    assert kept(recordings, described(), "whole")
    assert recordings.path(recordings.get(SHA)).read_text() == "whole"


def test_drafts_of_an_earlier_life_are_swept(
    recordings: Recordings, tmp_path: Path
) -> None:
    kept(recordings, described(), "x")
    left = tmp_path / "recordings" / ".draft-xyz"
    left.mkdir()
    (left / "rig").write_text("half")
    recordings.sweep()
    assert not left.exists()
    assert recordings.all() == [described()]
