from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import settings

from gripperd.errors import ConfigError

settings.register_profile("repeatable", derandomize=True, deadline=None)
settings.load_profile("repeatable")

Write = Callable[[str, str], Path]
Refusal = Callable[[Callable[[Path], object], Path], list[str]]


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """Puts a text into a file of a folder of its own."""

    def put(name: str, text: str) -> Path:
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    return put


@pytest.fixture
def refusal(tmp_path: Path) -> Refusal:
    """Everything that is said against a file, with paths relative to its folder."""

    def complaints(load: Callable[[Path], object], path: Path) -> list[str]:
        with pytest.raises(ConfigError) as refused:
            load(path)
        return [
            line.replace(f"{tmp_path}/", "").replace(str(tmp_path), "")
            for line in refused.value.complaints
        ]

    return complaints
