"""Whether the daemon is well, and what one has to know about it."""

from collections.abc import Iterator, Mapping
from datetime import datetime
from typing import Literal

from fastapi import Request
from pydantic import Field
from starlette.responses import Response

from gripperd.config import FailMode
from gripperd.control.states import APART, BOUND
from gripperd.drivers.facts import RigFacts, warnings
from gripperd.errors import LinkError
from gripperd.link.buses import BusFigures, ReadBuses
from gripperd.link.control import Overview, ReadModules, ReadOverview
from gripperd.service.body import router
from gripperd.service.buses import BusDocument, bus_document
from gripperd.service.context import Context, Daemon
from gripperd.service.fleet import Fleet
from gripperd.service.modules import RigDocument, rig_document
from gripperd.service.problems import ProblemResponse, problem
from gripperd.service.rendering import Document, optional, timestamp
from gripperd.service.timing_documents import TimingDocument, timing_document

OVERVIEW_WITHIN = 1.0
"""[s]"""
NO_SAFETY_FUNCTION = (
    "gripperd is not a safety function: protect people by other means, such as an"
    " enable input on the valve's supply"
)
FAILS_OPEN = "{name}: without power or air the muscle vents and the object drops"
SKIPPED = "a saved profile is not there: {complaint}"
DAMAGED = "the history left out what is not as it was written: {records}"
NO_REAL_TIME = "the control loop runs without real-time priority; see overruns"
EDITED = (
    "{name}: control goes by another {model} than the service has read, since its file"
    " was edited; start the daemon again"
)
UNLOGGED = "control dropped {count} log lines: nobody took them in time"

routes = router("health")


class Health(Document):
    """Well; anything else is a problem document."""

    status: Literal["live", "ready"]
    degraded: str | None = optional("What does not work, though holding goes on.")


class About(Document):
    """The daemon and what it drives."""

    name: Literal["gripperd"] = "gripperd"
    version: str
    mode: Literal["simulated", "hardware"]
    started_at: datetime = Field(description="Start of the service.")
    models: Mapping[str, str] = Field(description="Name of each gripper's model.")
    fail_modes: Mapping[str, FailMode] = Field(
        description="What happens to each gripper without power or air."
    )
    control: str = Field(description="`up`, or why it cannot be asked.")
    control_started_at: datetime | None
    real_time: bool | None = Field(
        description="The control loop has real-time priority; null while unknown."
    )
    overruns: int | None = Field(description="Periods of control that took too long.")
    timing: Mapping[str, TimingDocument] = Field(
        description="How punctual the control loop of each gripper is."
    )
    buses: tuple[BusDocument, ...] = Field(description="Empty while unknown.")
    modules: Mapping[str, RigDocument] = Field(
        description="By gripper; empty while unknown."
    )
    warnings: tuple[str, ...]


@routes.get("/health/live")
async def live() -> Health:
    """The service answers."""
    return Health(status="live")


@routes.get("/health/ready", response_model=Health)
async def ready(request: Request, daemon: Daemon) -> Health | Response:
    """Control answers and nothing keeps a gripper from working; else 503 with why."""
    found = [await _reason(daemon, name) for name in daemon.fleet]
    reasons = [reason for reason in found if reason]
    if not reasons:
        return Health(status="ready", degraded=daemon.past.archive.trouble)
    detail = "; ".join(dict.fromkeys(reasons))
    return ProblemResponse(problem("not-ready", detail, instance=request.url.path))


async def _reason(daemon: Context, name: str) -> str | None:
    """Why a gripper is not ready."""
    try:
        state = (await daemon.states.get(name)).document
    except LinkError as error:
        return str(error)
    if state.machine in APART:
        return f"{name} is {state.machine}: {state.link}"
    if state.machine in BOUND:
        causes = "; ".join(each.message for each in state.faults if each.latched)
        return f"{name} is {state.machine}: {causes}"
    return None


@routes.get("/info")
async def info(daemon: Daemon) -> About:
    """Version, mode, models, and what to be warned of."""
    try:
        overview = await daemon.control.ask(ReadOverview(), Overview, OVERVIEW_WITHIN)
        buses = await daemon.control.ask(ReadBuses(), list[BusFigures], OVERVIEW_WITHIN)
        rigs = await daemon.control.ask(
            ReadModules(), dict[str, RigFacts], OVERVIEW_WITHIN
        )
        control = "up"
    except LinkError as error:
        overview, buses, rigs, control = None, [], {}, str(error)
    grippers = {
        name: await daemon.up_to_date(each) for name, each in daemon.fleet.items()
    }
    return About(
        version=daemon.version,
        mode="hardware" if daemon.bench is None else "simulated",
        started_at=timestamp(daemon.started_at),
        models={name: each.chain.name for name, each in grippers.items()},
        fail_modes={name: each.fail_mode for name, each in grippers.items()},
        control=control,
        control_started_at=timestamp(overview.started_at) if overview else None,
        real_time=overview.real_time if overview else None,
        overruns=overview.overruns if overview else None,
        timing=_timing(overview),
        buses=tuple(map(bus_document, buses)),
        modules={name: rig_document(facts) for name, facts in rigs.items()},
        warnings=tuple(_warnings(daemon, overview)),
    )


def _timing(overview: Overview | None) -> Mapping[str, TimingDocument]:
    timings = overview.timings if overview else {}
    return {name: timing_document(timing) for name, timing in timings.items()}


def _warnings(daemon: Context, overview: Overview | None) -> Iterator[str]:
    yield NO_SAFETY_FUNCTION
    for name in daemon.fleet:
        yield from _of_gripper(name, daemon.fleet)
    archive = daemon.past.archive
    if archive.trouble is not None:
        yield archive.trouble
    if archive.damaged:
        yield DAMAGED.format(records=", ".join(archive.damaged))
    for complaint in daemon.library.skipped:
        yield SKIPPED.format(complaint=complaint)
    if overview is not None:
        yield from _of_control(overview)


def _of_gripper(name: str, fleet: Fleet) -> Iterator[str]:
    gripper = fleet[name]
    for said in warnings(gripper.output, gripper.input):
        yield f"{name}: {said}"
    if gripper.fail_mode is FailMode.VENT:
        yield FAILS_OPEN.format(name=name)
    if fleet.edited(name):
        yield EDITED.format(name=name, model=gripper.chain.name)


def _of_control(overview: Overview) -> Iterator[str]:
    if not overview.real_time:
        yield NO_REAL_TIME
    if overview.unlogged:
        yield UNLOGGED.format(count=overview.unlogged)
