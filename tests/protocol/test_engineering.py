from math import nan

import pytest

from gripperd.errors import BadReply, InputError
from gripperd.protocol.engineering import engineering, from_engineering


@pytest.mark.parametrize(
    ("current", "text"),
    [
        (0.0107, "+10.700"),
        (0.004, "+04.000"),
        (0.0, "+00.000"),
        (-1e-9, "+00.000"),
        (-0.0125, "-12.500"),
        (0.02, "+20.000"),
    ],
)
def test_a_current_has_seven_characters(current: float, text: str) -> None:
    assert engineering(current) == text
    assert from_engineering(text) == pytest.approx(current, abs=1e-8)


@pytest.mark.parametrize("current", [0.1, -0.1, nan])
def test_what_does_not_fit_is_refused(current: float) -> None:
    with pytest.raises(InputError):
        engineering(current)


@pytest.mark.parametrize(
    "text", ["", "10.700", "+1.0700", "+10.70", "+10.7000", "+1O.700", " 10.700"]
)
def test_anything_else_is_no_current(text: str) -> None:
    with pytest.raises(BadReply):
        from_engineering(text)
