"""A disk that fails while an egg is held: held it stays, and nothing told is lost."""

from collections.abc import Callable, Iterator

import pytest

from tests.faults import disk
from tests.faults.held import Held, held_egg

Inject = Callable[[Held], disk.Injected]


@pytest.fixture(scope="module")
def held() -> Iterator[Held]:
    """A daemon with an egg, which outlives every test."""
    with held_egg() as held:
        yield held


@pytest.fixture(scope="module")
def on_small_disk(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Held]:
    """The same with a disk of its own."""
    if not disk.may_mount():
        pytest.skip("this machine lets nobody mount a file system of his own")
    folder = tmp_path_factory.mktemp("disk")
    (folder / "state").mkdir()
    with held_egg(folder, disk.small_disk(folder)) as held:
        yield held


@pytest.mark.parametrize("inject", [disk.limited, disk.locked])
def test_what_the_disk_does_not_take_is_said_and_recorded_later(
    held: Held, inject: Inject
) -> None:
    assert disk.failing(held, inject.__name__, inject).wrong == ()


@pytest.mark.parametrize("inject", [disk.full, disk.read_only])
def test_a_disk_that_is_full_or_read_only_is_said_and_recorded_later(
    on_small_disk: Held, inject: Inject
) -> None:
    assert disk.failing(on_small_disk, inject.__name__, inject).wrong == ()


def test_an_overwritten_database_is_set_aside_and_said(held: Held) -> None:
    assert disk.corrupt(held).wrong == ()
