"""Settings that are edited while an egg is held."""

from collections.abc import Iterator

import pytest

from tests.faults import settings
from tests.faults.held import Held
from tests.faults.settings import UNUSABLE, Edit


@pytest.fixture(scope="module")
def held() -> Iterator[Held]:
    """A daemon with an egg, whose files may be edited."""
    with settings.held_with_files() as held:
        yield held


@pytest.mark.parametrize("edit", UNUSABLE, ids=lambda edit: edit.name)
def test_an_unusable_file_is_refused_and_nothing_changes(
    held: Held, edit: Edit
) -> None:
    assert settings.refused(held, edit).wrong == ()


def test_what_a_start_reads_goes_on_as_it_is(held: Held) -> None:
    assert settings.waiting(held).wrong == ()


def test_another_profile_counts_for_the_next_grasp_alone(held: Held) -> None:
    assert settings.taken_up(held).wrong == ()


def test_control_that_cannot_start_on_a_file_leaves_the_egg_held(held: Held) -> None:
    assert settings.hung_up(held).wrong == ()
