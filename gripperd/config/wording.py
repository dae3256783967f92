"""What pydantic found wrong, in words that name value, unit and limit."""

import re
from typing import TYPE_CHECKING

from gripperd.config.complaint import KeyPath, did_you_mean, printable
from gripperd.units import split

if TYPE_CHECKING:
    from pydantic_core import ErrorDetails

BEYOND = {
    "greater_than": ("gt", "is not above"),
    "greater_than_equal": ("ge", "is below"),
    "less_than": ("lt", "is not below"),
    "less_than_equal": ("le", "is above"),
}
SAID = {
    "bool_type": "{} is not true or false",
    "dict_type": "{} is not a mapping of keys to values",
    "int_type": "{} is not a whole number",
    "list_type": "{} is not a list",
    "model_type": "{} is not a mapping of keys to values",
    "string_too_short": "is empty",
    "string_type": "{} is not text; put it in quotes",
    "string_unicode": "{} is not text that can be written as UTF-8",
    "too_long": "{} is not a pair [low, high]",
    "too_short": "is empty",
    "tuple_type": "{} is not a pair [low, high]",
}
NUMBER = re.compile(r"[-+]?[0-9]+(\.[0-9]+)?")
DECIMAL_COMMA = re.compile(r"[-+]?[0-9]+,([0-9]{1,2}|[0-9]{4,})")
"""Three digits after a comma could be thousands, so nothing is proposed for them."""


def unit_of(path: KeyPath) -> str | None:
    """Give the unit of a value: the suffix of the nearest key that has one.

    >>> unit_of(("size_tolerance_mm", "smaller"))
    'mm'
    """
    for step in reversed(path):
        unit = split(step)[1] if isinstance(step, str) else None
        if unit:
            return unit
    return None


def describe(error: "ErrorDetails", path: KeyPath) -> str:
    """Say what is wrong with the value at a path."""
    kind, value = error["type"], error["input"]
    unit = spelt(unit_of(path))
    context = error.get("ctx", {})
    if kind in BEYOND:
        limit, relation = BEYOND[kind]
        bound = quantity(context[limit], unit)
        return f"{quantity(value, unit)} {relation} {bound}"
    if kind in SAID:
        return SAID[kind].format(shown(value))
    if kind == "missing":
        return f"is missing ({unit})" if unit else "is missing"
    if kind in {"float_type", "finite_number"}:
        return _no_number(value, unit)
    if kind in {"enum", "literal_error"}:
        words = re.findall(r"'([^']*)'", context["expected"])
        return f"{shown(value)} is unknown; {did_you_mean(str(value), words)}"
    if kind == "value_error":
        return str(context["error"])
    if kind == "not_rising":
        low, high = (quantity(end, unit) for end in value)
        return f"the low end, {low}, is not below the high end, {high}"
    return f"{shown(value)}: {error['msg'][:1].lower()}{error['msg'][1:]}"


def spelt(unit: str | None) -> str:
    """Write the unit of a key for a person.

    >>> spelt("N_per_mm"), spelt("per_MPa"), spelt(None)
    ('N/mm', '1/MPa', '')
    """
    spaced = (unit or "").replace("_per_", "/")
    return f"1/{spaced.removeprefix('per_')}" if spaced.startswith("per_") else spaced


def quantity(value: object, unit: str) -> str:
    """Write a number with its unit."""
    return f"{shown(value)} {unit}" if unit else shown(value)


def shown(value: object) -> str:
    """Write a value the way its owner would recognise it."""
    if value is None:
        return "an empty value"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return f'"{printable(value)}"'
    if isinstance(value, int):
        return str(value) if abs(value) < 10**15 else "a number of over 15 digits"
    if isinstance(value, float):
        return f"{value:.12g}"
    if isinstance(value, list | tuple):
        return f"a list of {len(value)}"
    return "a mapping" if isinstance(value, dict) else f"a {type(value).__name__}"


def _no_number(value: object, unit: str) -> str:
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    said = f"{shown(value)} is not a {'finite ' if is_number else ''}number"
    said += f" ({unit})" if unit else ""
    meant = _meant(value, unit) if isinstance(value, str) else None
    return f"{said}; write {meant}" if meant else said


def _meant(text: str, unit: str) -> str | None:
    bare = text.strip().removesuffix(unit).strip().replace("_", "")
    if DECIMAL_COMMA.fullmatch(bare):
        return bare.replace(",", ".")
    return bare if NUMBER.fullmatch(bare) else None
