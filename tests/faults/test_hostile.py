"""Whatever is sent to do harm is refused, and the egg stays held."""

from collections.abc import Callable, Iterator

import pytest

from tests.faults import hostile
from tests.faults.attacks import TABLES, TEXTS
from tests.faults.hostile import Hostile
from tests.faults.row import Row


@pytest.fixture(scope="module")
def attacked() -> Iterator[Hostile]:
    """A daemon with an egg, which outlives every test."""
    with hostile.attacked() as found:
        yield found


def test_hostile_names_documents_and_headers_are_refused_and_told(
    attacked: Hostile,
) -> None:
    for row in hostile.requests(attacked):
        assert row.wrong == (), row.fault


@pytest.mark.parametrize(
    "attack",
    [
        hostile.tokens,
        hostile.keys,
        hostile.recordings,
        hostile.left_out,
        hostile.settings,
    ],
)
def test_hostile_tokens_keys_and_files_change_nothing(
    attacked: Hostile, attack: Callable[[Hostile], Row]
) -> None:
    assert attack(attacked).wrong == ()


def test_the_command_line_refuses_hostile_files_in_a_few_words(
    attacked: Hostile,
) -> None:
    tables = {name: TABLES[name] for name in ("NUL", "escapes")}
    assert hostile.read_by_diagnose(attacked, tables).wrong == ()
    texts = {name: TEXTS[name] for name in ("billion laughs", "nested deeply")}
    found = hostile.read_by_check(attacked, texts)
    assert (found.wrong, found.came) == ((), {f"{hostile.UNUSABLE}": 2})
