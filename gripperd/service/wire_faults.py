"""Faults of the bench's wire as documents."""

from typing import Annotated

from pydantic import Field

from gripperd.bench.wire_faults import MOST_WAITING, WireFault, WireFaultKind
from gripperd.config.section import Section
from gripperd.link.bench import BenchState, SetWireFaults
from gripperd.service.rendering import GIVEN, Document, to
from gripperd.units import MILLI

MOST_TOLD = 100
"""Faults in one document; the rest is a number."""


class WireFaultRequest(Section):
    """What one request on the wire is to meet."""

    kind: Annotated[WireFaultKind, Field(strict=False)]
    code: int = Field(default=4, ge=1, le=255, description="Of an exception.")
    delay_ms: float = Field(default=1000, ge=0, le=600_000, description="If late.")
    unit: int | None = Field(
        default=None, ge=0, le=255, description="Whose requests; left out: any."
    )
    times: int = Field(
        default=1, ge=1, le=MOST_WAITING, description="Requests in a row."
    )

    @property
    def fault(self) -> WireFault:
        """The same for the bench."""
        return WireFault(
            kind=self.kind,
            code=self.code,
            delay=self.delay_ms * MILLI,
            unit=self.unit,
            times=self.times,
        )


class WireFaultsRequest(Section):
    """What the next requests on the wire are to meet, in place of what was said."""

    faults: list[WireFaultRequest] = Field(
        default=[],
        max_length=MOST_TOLD,
        description="In order; each waits for a request that it can befall.",
    )
    chance: float = Field(
        default=0, ge=0, le=1, description="Of a fault at random once none waits."
    )

    @property
    def request(self) -> SetWireFaults:
        """The same for the bench."""
        return SetWireFaults(tuple(each.fault for each in self.faults), self.chance)


class WireFaultDocument(Document):
    """A fault that waits for its request."""

    kind: WireFaultKind
    code: int
    delay_ms: float
    unit: int | None
    times: int


class WireFaultsDocument(Document):
    """What is wrong with the wire of the bench."""

    waiting: tuple[WireFaultDocument, ...] = Field(
        description=f"The first {MOST_TOLD}."
    )
    chance: float


def wire_faults(state: BenchState) -> WireFaultsDocument:
    """What waits for the next requests."""
    waiting = (
        WireFaultDocument(
            kind=fault.kind,
            code=fault.code,
            delay_ms=to("ms", fault.delay, GIVEN),
            unit=fault.unit,
            times=fault.times,
        )
        for fault in state.wire_faults[:MOST_TOLD]
    )
    return WireFaultsDocument(waiting=tuple(waiting), chance=state.wire_fault_chance)
