"""Where a version of a model comes from: the further keys of its file.

The numbers are a record for people and stay in the units of the file.
"""

from contextlib import suppress
from datetime import UTC, datetime
from itertools import chain, combinations
from math import isfinite, sqrt
from typing import Annotated, Self, TypeAlias, TypeVar

from pydantic import Field, PlainSerializer, PlainValidator, model_validator

from gripperd.config.section import Section
from gripperd.config.wording import shown

T = TypeVar("T")

Listed: TypeAlias = Annotated[tuple[T, ...], Field(strict=False)]
Size: TypeAlias = Annotated[float, Field(ge=0)]


ROUNDED = 1e-4
"""Share by which six digits may make a correlation seem above 1, or two halves of a
matrix not the same. [-]"""


def _moment(given: object) -> datetime:
    moment = given if isinstance(given, datetime) else None
    if isinstance(given, str):
        with suppress(ValueError):
            moment = datetime.fromisoformat(given)
    if moment is None or moment.tzinfo is None:
        example = "2026-01-31T12:00:00+00:00"
        message = f"{shown(given)} is not a time with its zone, such as {example}"
        raise ValueError(message)
    return moment.astimezone(UTC)


Moment: TypeAlias = Annotated[
    datetime,
    PlainValidator(_moment),
    PlainSerializer(datetime.isoformat, return_type=str),
]


class Recorded(Section):
    """The recording that a version was fitted on."""

    name: str = Field(min_length=1)
    sha256: str = Field(pattern=r"^[0-9a-f]{64}$")


class Added(Section):
    """One effect that was added, or ``parameter:<path>`` that was adjusted."""

    name: str = Field(min_length=1)
    parameters: dict[str, float] = Field(default_factory=dict)
    """By key, such as ``amplitude_N``."""
    std: dict[str, Size] = Field(default_factory=dict)
    """Standard deviations, under the same keys."""

    @model_validator(mode="after")
    def _about_the_same(self) -> Self:
        for key in self.std.keys() - self.parameters.keys():
            message = f"std.{key} has no value among the parameters"
            raise ValueError(message)
        return self


class Covariance(Section):
    """Of all numbers that were fitted together, in the products of their units."""

    parameters: Listed[str]
    """Names such as ``creep.amplitude_N`` or ``parameter:muscle.diameter_mm``, one a
    row."""
    matrix: Listed[Listed[float]]

    @model_validator(mode="after")
    def _is_square(self) -> Self:
        size = len(self.parameters)
        if {len(self.matrix), *map(len, self.matrix)} != {size}:
            message = f"the matrix is not {size} by {size}, one row a parameter"
            raise ValueError(message)
        if not all(map(isfinite, chain.from_iterable(self.matrix))):
            message = "the matrix holds a number that is not finite"
            raise ValueError(message)
        rows = self.matrix
        for (a, one), (b, other) in combinations(enumerate(self.parameters), 2):
            most = sqrt(max(rows[a][a], 0.0) * max(rows[b][b], 0.0))
            apart = abs(rows[a][b] - rows[b][a])
            if apart > ROUNDED * most or abs(rows[a][b]) > (1 + ROUNDED) * most:
                message = (
                    f"the covariances of {one} and {other}, {rows[a][b]:g} and"
                    f" {rows[b][a]:g}, must be one number, of at most {most:g} either"
                    " way by their variances"
                )
                raise ValueError(message)
        return self


class Gap(Section):
    """How far the model was off, on runs that took no part in fitting."""

    signal: str
    unit: str
    rmse_before: Size
    rmse_recalibrated: Size
    """With better constants alone."""
    rmse_after: Size
    noise_floor: Size


class Provenance(Section):
    """What a version was made of."""

    program: str = Field(min_length=1)
    """Version of gripperd that made it."""
    recording: Recorded
    seed: int = Field(ge=0)
    effects: Listed[Added] = ()
    """What was named: effects, and constants that were wrong."""
    refitted: Listed[Added] = ()
    """Constants that moved with it by more than their tolerance, and were not named."""
    covariance: Covariance | None = None
    gap: Gap | None = None
    heldout_runs: Listed[str] = ()


class Lineage(Section):
    """Place of a version among the others."""

    version: int = Field(ge=1)
    parent: int = Field(ge=0)
    """Version it was made from; 0 is the configured model."""
    created_at: Moment
    provenance: Provenance

    @model_validator(mode="after")
    def _descends(self) -> Self:
        if self.parent >= self.version:
            message = f"parent {self.parent} is not older than version {self.version}"
            raise ValueError(message)
        return self
