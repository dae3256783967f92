"""No process that must answer stops to look at all it has loaded."""

import gc
from collections.abc import Iterator
from pathlib import Path

import pytest

from gripperd.cli.garbage import spare_what_stays
from tests.daemon import running_daemon

LAST_WORDS = """
import atexit, gc, os, sys

def leave(folder={folder!r}):
    with open(os.path.join(folder, sys.argv[1]), "w") as file:
        file.write(f"{{len(gc.get_objects())}} {{gc.get_freeze_count()}}")

if sys.argv[1:]:
    atexit.register(leave)
"""
"""What a process says at its end: objects to walk through, objects spared."""


@pytest.fixture
def thawed() -> Iterator[None]:
    """The collector of this process as it was."""
    yield
    gc.unfreeze()


@pytest.mark.usefixtures("thawed")
def test_what_there_is_is_spared_and_what_comes_is_not() -> None:
    stays: list[list[object]] = [[]]
    spare_what_stays()
    comes: list[list[object]] = [[]]
    walked = {id(each) for each in gc.get_objects()}
    assert id(stays) not in walked
    assert id(comes) in walked


def test_every_process_at_work_has_little_to_walk_through(tmp_path: Path) -> None:
    said = tmp_path / "said"
    said.mkdir()
    (tmp_path / "sitecustomize.py").write_text(LAST_WORDS.format(folder=str(said)))
    with running_daemon(tmp_path, PYTHONPATH=str(tmp_path)):
        pass
    for name in ("bench", "control", "service"):
        walked, spared = map(int, (said / name).read_text().split())
        assert walked < spared / 3, name
