"""Sections of a file as pydantic models whose field names carry their unit.

The conversion to SI reads the unit from the name, so no field is converted by hand. A
field whose key differs from its name inside the package has the key as its alias.
"""

import re
from collections.abc import Iterator
from enum import Enum
from typing import Annotated, TypeAlias, TypeVar

from pydantic import AfterValidator, BaseModel, ConfigDict, Field
from pydantic_core import PydanticCustomError

from gripperd.config.complaint import printable
from gripperd.units import SI_PER_UNIT, split

ENDS = ("low", "high")
NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,63}")
"""Safe as a file name, in a URL and in a socket's path."""
DIGITS = 12
"""Significant digits written back: hides the rounding of the way to SI and back."""


class Section(BaseModel):
    """One mapping of a file: known keys only, no guessing between types."""

    model_config = ConfigDict(
        strict=True, extra="forbid", allow_inf_nan=False, frozen=True
    )


def _named(text: str) -> str:
    if not NAME.fullmatch(text):
        message = (
            f'"{printable(text)}" is not a name: 1 to 64 of a-z A-Z 0-9 _ . - that'
            " start with a letter or digit"
        )
        raise ValueError(message)
    return text


def _rising(pair: tuple[float, float]) -> tuple[float, float]:
    if not pair[0] < pair[1]:
        kind = "not_rising"
        raise PydanticCustomError(kind, "the low end is not below the high end")
    return pair


def _spanning(pair: tuple[float, float]) -> tuple[float, float]:
    if pair[0] == pair[1]:
        message = f"both ends are {pair[0]:g}, so the values between have no scale"
        raise ValueError(message)
    return pair


Number = TypeVar("Number", bound=float)

Name: TypeAlias = Annotated[str, AfterValidator(_named)]
Span: TypeAlias = Annotated[
    tuple[Number, Number], Field(strict=False), AfterValidator(_spanning)
]
"""A list of two ends that differ; they become ``..._low`` and ``..._high``."""
Rising: TypeAlias = Annotated[
    tuple[Number, Number], Field(strict=False), AfterValidator(_rising)
]
"""A list ``[low, high]``, rising."""
Milliamperes: TypeAlias = Annotated[float, Field(ge=0, le=24)]
"""A current loop, with the overrange that modules can still say."""
Kilopascals: TypeAlias = Annotated[float, Field(ge=-100, le=2000)]
"""Gauge, from vacuum to twice what regulators for muscles deliver."""


def key_of(schema: type[Section], field: str) -> str:
    """Key in the file of a field."""
    return schema.model_fields[field].alias or field


def numbers(section: Section, unit: str | None = None) -> dict[str, float]:
    """Every number of a section and of those inside it, by bare name. [SI]."""
    return {
        name: value
        for field, given in section
        for name, value in _in_si(field, given, unit)
    }


def _in_si(field: str, given: object, outer: str | None) -> Iterator[tuple[str, float]]:
    name, own = split(field)
    unit = own or outer
    factor = SI_PER_UNIT[unit] if unit else 1.0
    match given:
        case float():
            yield name, given * factor
        case (float() as low, float() as high):
            yield f"{name}_low", low * factor
            yield f"{name}_high", high * factor
        case Section():
            yield from numbers(given, unit).items()
        case _:
            pass


def plain(
    schema: type[Section], owner: object, unit: str | None = None
) -> dict[str, object]:
    """Write the fields of an object the way the file has them: `numbers` backwards."""
    written: dict[str, object] = {}
    for field, about in schema.model_fields.items():
        name, own = split(field)
        kind = about.annotation
        if isinstance(kind, type) and issubclass(kind, Section):
            value: object = plain(kind, owner, own or unit)
        else:
            value = _plain(getattr(owner, name), own or unit)
        written[key_of(schema, field)] = value
    return written


def _plain(value: object, unit: str | None) -> object:
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, float):
        factor = SI_PER_UNIT[unit] if unit else 1.0
        return float(f"{value / factor:.{DIGITS}g}")
    return value
