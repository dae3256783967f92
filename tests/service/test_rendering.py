"""Numbers and times at the boundary."""

from math import inf, nan

import pytest
from pydantic import ValidationError

from gripperd.service.rendering import GIVEN, Document, known, ratio, timestamp, to


class Number(Document):
    value: float


def test_a_given_number_comes_back_as_it_was_given() -> None:
    for value in (10.7, 0.1, 30.0, 7.000001):
        assert to("mA", value * 1e-3, GIVEN) == value


def test_noise_is_not_written() -> None:
    assert to("kPa", 209374.99999999997) == 209.375
    assert to("N", 22.54321987) == 22.5432


@pytest.mark.parametrize("value", [None, nan, inf, -inf])
def test_what_is_no_number_is_null(value: float | None) -> None:
    assert known("N", value) is None
    assert ratio(value) is None


@pytest.mark.parametrize("value", [nan, inf])
def test_no_document_holds_what_json_cannot_write(value: float) -> None:
    with pytest.raises(ValidationError):
        Number(value=value)


def test_times_are_utc() -> None:
    assert timestamp(1_700_000_000.25).isoformat() == "2023-11-14T22:13:20.250000+00:00"
