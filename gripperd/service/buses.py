"""The figures of a bus as a document."""

from collections.abc import Mapping

from pydantic import Field

from gripperd.link.buses import BusFigures
from gripperd.service.rendering import Document
from gripperd.units import MILLI


class LatencyClass(Document):
    """Replies that took no longer than this, and longer than the class before."""

    up_to_ms: float | None = Field(description="Null is the class above every bound.")
    replies: int


class BusDocument(Document):
    """What has happened on a bus since control was started."""

    name: str = Field(description="Its address.")
    grippers: tuple[str, ...]
    up: bool = Field(description="The line is open.")
    requests: int
    connections: int = Field(description="Times that the line was opened.")
    discarded_octets: int = Field(description="Those that no request explains.")
    errors: Mapping[str, int] = Field(
        description="By kind; `connect` is a failed attempt to open the line."
    )
    mean_latency_ms: float | None = Field(description="Null before the first reply.")
    latency: tuple[LatencyClass, ...]


def bus_document(figures: BusFigures) -> BusDocument:
    """Describe a bus for the outside."""
    replies = sum(figures.latency_counts)
    mean = figures.latency_total / replies / MILLI if replies else None
    bounds = [*(round(bound / MILLI, 6) for bound in figures.latency_bounds), None]
    return BusDocument(
        name=figures.name,
        grippers=figures.grippers,
        up=figures.up,
        requests=figures.requests,
        connections=figures.connections,
        discarded_octets=figures.discarded,
        errors=figures.errors,
        mean_latency_ms=None if mean is None else round(mean, 3),
        latency=tuple(
            LatencyClass(up_to_ms=bound, replies=count)
            for bound, count in zip(bounds, figures.latency_counts, strict=True)
        ),
    )
