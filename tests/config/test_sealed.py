"""A model file that says what it was is taken for no other."""

from pathlib import Path

import pytest

from gripperd.config import load_model, shipped
from gripperd.config.sealed import sealed
from gripperd.errors import ConfigError

TEXT = shipped("models/reference.yaml").read_text(encoding="utf-8")


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "model.yaml"
    path.write_text(sealed(TEXT), encoding="utf-8")
    return path


def test_as_it_was_written_it_is_the_model(file: Path) -> None:
    plain = load_model(shipped("models/reference.yaml"))
    assert load_model(file) == plain


@pytest.mark.parametrize(
    ("old", "new"),
    [("value: 20,", "value: 21,"), ("\n# sha256", "\n\n# sha256"), ("\n", "\r\n")],
    ids=["a number", "a line", "line ends"],
)
def test_a_file_that_was_edited_is_refused(file: Path, old: str, new: str) -> None:
    text = file.read_text(encoding="utf-8")
    assert old in text
    file.write_bytes(text.replace(old, new).encode())
    with pytest.raises(ConfigError, match=f"{file}: is not as it was written"):
        load_model(file)


def test_what_follows_the_digest_is_an_edit(file: Path) -> None:
    with file.open("a", encoding="utf-8") as end:
        end.write("# tuned\n")
    with pytest.raises(ConfigError, match="without that line it is a file of your own"):
        load_model(file)


@pytest.mark.parametrize(
    "note", ["", "# sha256 of the drawing: 12\n", "#  # sha256: 1"]
)
def test_a_file_without_a_digest_is_somebody_s_own(file: Path, note: str) -> None:
    file.write_text(f"{TEXT}{note}", encoding="utf-8")
    assert load_model(file).static.muscle.diameter == pytest.approx(0.02)
