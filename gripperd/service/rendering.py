"""SI values as the boundary has them: the unit of the key, few digits, RFC 3339."""

from datetime import UTC, datetime
from math import isfinite
from typing import Any

from pydantic import BaseModel, ConfigDict, Field

from gripperd.units import SI_PER_UNIT

MEASURED = 6
"""Significant digits of what was measured or predicted; more would be noise."""
GIVEN = 12
"""Of what a client gave: hides the rounding of the way to SI and back."""


class Document(BaseModel):
    """A part of a reply; it never holds a number that JSON cannot write."""

    model_config = ConfigDict(frozen=True, allow_inf_nan=False)


def optional(description: str) -> Any:  # noqa: ANN401 - as pydantic's own Field
    """Make a field that is left out of a document while it is None."""
    return Field(
        default=None, description=description, exclude_if=lambda value: value is None
    )


def to(unit: str, value: float, digits: int = MEASURED) -> float:
    """Give a value in a unit.

    >>> to("kPa", 209374.99999999997)
    209.375
    """
    return float(f"{value / SI_PER_UNIT[unit]:.{digits}g}")


def known(unit: str, value: float | None, digits: int = MEASURED) -> float | None:
    """Give a value in a unit, None where there is no finite one."""
    if value is None or not isfinite(value):
        return None
    return to(unit, value, digits)


def ratio(value: float | None) -> float | None:
    """Give a value without unit, None where there is no finite one."""
    if value is None or not isfinite(value):
        return None
    return float(f"{value:.{MEASURED}g}")


def timestamp(seconds: float) -> datetime:
    """Give a time since the epoch as a date and time in UTC."""
    return datetime.fromtimestamp(seconds, UTC)
