"""Models that must not be taken up, and answers beyond what they are made for."""

from collections.abc import Iterator

import pytest

from tests.faults import models
from tests.faults.held import Held


@pytest.fixture(scope="module")
def held() -> Iterator[Held]:
    """A daemon with an egg, a sound version and a damaged one."""
    with models.held_with_versions() as held:
        yield held


@pytest.mark.parametrize(
    ("version", "code"), [(1, "object-held"), (2, "model-unusable")]
)
def test_a_version_is_not_taken_up_while_an_egg_is_held(
    held: Held, version: int, code: str
) -> None:
    assert models.activated(held, version, code).wrong == ()


def test_a_damaged_version_is_refused_wherever_it_is_damaged() -> None:
    row = models.damaged(stride=29)
    assert row.wrong == ()
    assert row.came["read"] == 1


def test_an_answer_beyond_the_domain_says_so() -> None:
    row = models.outside(sizes=20)
    assert row.wrong == ()
    assert set(row.came) == {"extrapolated", "within"}
