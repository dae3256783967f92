"""A claim of the paper and what becomes of it."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

EXACT = 1e-9
"""Relative difference that rounding alone explains. [-]"""


class Verdict(StrEnum):
    """How a claim fares against the equations."""

    HOLDS = "holds"
    ONLY_AT_REST = "holds only at h = 0"
    FAILS = "does not hold"
    UNTESTABLE = "cannot be tested"
    WEAK = "weak"


@dataclass(frozen=True, slots=True)
class Claim:
    """One claim of the paper with its verdict."""

    key: str
    """A stable word for programs."""
    source: str
    """Where the paper makes it."""
    statement: str
    """The claim in our words."""
    verdict: Verdict
    finding: str
    """Why, in one or two sentences with the numbers."""
    numbers: Mapping[str, float]
    """The numbers behind the verdict; names carry the unit as a suffix."""
