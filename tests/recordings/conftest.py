from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import pytest

from gripperd.errors import InputError
from gripperd.recordings import read_recording

Columns = Mapping[str, Sequence[object]]
Write = Callable[[Columns], Path]
Complaint = Callable[[Path], str]


def good(rows: int = 30) -> dict[str, list[object]]:
    """One run that can be used, its noise too small to round away."""
    return {
        "run": ["h0.10"] * rows,
        "t_s": [0.1 * row for row in range(rows)],
        "pressure_kPa": [100.0 + 7.0 * row for row in range(rows)],
        "contraction": [0.1] * rows,
        "force_N": [50.0 + 11.0 * row for row in range(rows)],
    }


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """Write columns as CSV, the way a logger does."""

    def writer(columns: Columns) -> Path:
        rows = zip(*columns.values(), strict=True)
        lines = [columns.keys(), *rows]
        text = "".join(",".join(str(cell) for cell in line) + "\n" for line in lines)
        path = tmp_path / "rig.csv"
        path.write_text(text, encoding="utf-8")
        return path

    return writer


@pytest.fixture
def complaint() -> Complaint:
    """Give the message with which a recording is refused, without its folder."""

    def refused(path: Path) -> str:
        with pytest.raises(InputError) as caught:
            read_recording(path)
        message = str(caught.value)
        assert "\n" not in message
        return message.replace(f"{path.parent}/", "")

    return refused
