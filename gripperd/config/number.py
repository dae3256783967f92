"""Numbers between a file and SI, without a bit lost on the way."""

from gripperd.units import SI_PER_UNIT

DIGITS = range(12, 17)
"""Significant digits tried before all of a number is written."""


def factor_of(unit: str | None) -> float:
    """SI per unit of a key; 1 for a ratio."""
    return SI_PER_UNIT[unit] if unit else 1.0


def written(value: float, unit: str | None) -> float:
    """Number to write under a key, so that reading it gives the value again.

    The shortest of those that do. A product of floats leaves out some values
    altogether; for these it is the nearest, and what is read differs in the last bit.

    >>> written(0.3 * 1e-3, "mm")
    0.3
    """
    factor = factor_of(unit)
    near = value / factor
    rounded = (float(f"{near:.{digits}g}") for digits in DIGITS)
    return next((each for each in rounded if each * factor == value), near)
