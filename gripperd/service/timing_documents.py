"""How punctual control is, for people."""

from pydantic import Field

from gripperd.control.timing import Distribution, Timing
from gripperd.service.rendering import Document
from gripperd.units import MILLI

DIGITS = 3
"""Whole microseconds."""


class SpreadDocument(Document):
    """A distribution of durations, to the next class of 19 %; null without any."""

    p50_ms: float | None
    p99_ms: float | None
    longest_ms: float | None


class TimingDocument(Document):
    """One control loop since its start."""

    target_ms: float = Field(description="Period asked for.")
    period: SpreadDocument = Field(description="From one start to the next.")
    lateness: SpreadDocument = Field(description="From a deadline to the start.")
    overruns: int = Field(description="Periods that were not over in time.")


def timing_document(timing: Timing) -> TimingDocument:
    """The document of one loop."""
    return TimingDocument(
        target_ms=round(timing.target / MILLI, DIGITS),
        period=_spread(timing.period),
        lateness=_spread(timing.lateness),
        overruns=timing.overruns,
    )


def _spread(found: Distribution) -> SpreadDocument:
    points = (found.quantile(share) for share in (0.5, 0.99, 1.0))
    told = [None if each is None else round(each / MILLI, DIGITS) for each in points]
    return SpreadDocument(p50_ms=told[0], p99_ms=told[1], longest_ms=told[2])
