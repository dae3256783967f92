"""On a narrow screen nothing is cut without a sign."""

import re

import pytest

from gripperd.demo.hidden import Hidden
from gripperd.report import page
from tests.demonstration import example

REM = 16.0
"""Size of the text of a page, unless its reader wants another. [px]"""


@pytest.fixture(scope="module")
def text() -> str:
    return page(example(Hidden.CREEP)[1], model="as-drawn", program="0.1.0")


def length(pattern: str, text: str) -> float:
    found = re.search(pattern, text)
    assert found is not None, pattern
    return float(found.group(1)) * REM


def test_what_is_wider_than_the_screen_moves_in_a_box_of_its_own(text: str) -> None:
    tables = re.findall(r"<div class=\"scroll\"[^>]*>\s*<table>", text)
    assert len(tables) == text.count("<table>") > 0
    pictures = re.findall(r"<div class=\"drawn\"><svg", text)
    assert len(pictures) == text.count("<figure") > 0


def test_a_picture_says_that_it_goes_on_wherever_it_does(text: str) -> None:
    hint = r"@media screen and \(max-width: ([\d.]+)rem\) { \.drawn::before"
    width = length(r"\.drawn > svg {[^}]*min-width: ([\d.]+)rem", text)
    margin = length(r"padding: [\d.]+rem ([\d.]+)rem", text)
    assert length(hint, text) == width + 2 * margin
    assert length(hint, text) > 390


def test_a_table_has_a_shadow_where_it_goes_on(text: str) -> None:
    found = re.search(r"\.scroll { background: (.*?); }", text)
    assert found is not None
    # Two covers that move with the table, above two shadows that stay.
    assert re.findall(r"no-repeat (local|scroll)", found.group(1)) == [
        "local", "local", "scroll", "scroll"
    ]  # fmt: skip
