import json
from datetime import UTC, datetime
from pathlib import Path

import pytest

from gripperd.demo.hidden import Hidden
from gripperd.demo.story import demonstrate
from gripperd.errors import InputError
from tests.demonstration import SEED, STEP

NOON = datetime(2026, 1, 31, 12, tzinfo=UTC)


def test_what_is_hidden_is_found_added_and_shown(tmp_path: Path) -> None:
    told: list[float] = []
    story = demonstrate(
        tmp_path / "new" / "folder",
        Hidden.HYSTERESIS,
        SEED,
        program="0.1.0",
        now=NOON,
        progress=lambda _what, share: told.append(share),
        step=STEP / 2,
    )
    folder = tmp_path / "new" / "folder"
    said = json.loads((folder / "diagnosis.json").read_text())
    assert [one["name"] for one in said["effects"]] == ["presliding_hysteresis"]
    assert story.better is not None
    assert story.better.model.source == str(folder / "versions" / "1.yaml")
    gap = said["gap"]
    assert gap["rmse_after"] < 0.5 * gap["rmse_recalibrated"]
    assert "presliding_hysteresis" in story.report.read_text(encoding="utf-8")
    assert told == sorted(told)


def test_a_place_that_cannot_be_written_is_named(tmp_path: Path) -> None:
    taken = tmp_path / "taken"
    taken.write_text("")
    with pytest.raises(InputError, match="taken: cannot be written"):
        demonstrate(
            taken,
            Hidden.CREEP,
            SEED,
            program="0.1.0",
            now=NOON,
            progress=lambda _what, _share: None,
        )
