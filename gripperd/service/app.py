"""The application: every resource, behind the guard, in front of control and bench."""

from asyncio import to_thread
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from datetime import UTC, datetime
from functools import partial
from typing import Any

from fastapi import FastAPI

from gripperd.config import Settings
from gripperd.link.client import Client
from gripperd.service import bench as bench_resource
from gripperd.service import (
    commands,
    diagnoses,
    docs,
    faults,
    grippers,
    health,
    history,
    leases,
    metrics,
    models,
    predictions,
    profiles,
    schema,
)
from gripperd.service import recordings as recordings_resource
from gripperd.service import settings as settings_resource
from gripperd.service.context import Context, gone_by, shared_states
from gripperd.service.diagnosing import Diagnosing
from gripperd.service.failures import answer_failures
from gripperd.service.fleet import Fleet
from gripperd.service.guard import Guard
from gripperd.service.library import ProfileLibrary
from gripperd.service.past import Past
from gripperd.store.diagnoses import Diagnoses
from gripperd.store.recordings import Recordings

VERSIONED = "/v1"
DESCRIPTION = (
    "Drives a gripper powered by a pneumatic artificial muscle. Names carry their"
    " units; forces are per jaw, pressures gauge. It is not a safety function."
)


class Service(FastAPI):
    """The application; its OpenAPI document says what failures look like."""

    def openapi(self) -> dict[str, Any]:
        """Give the OpenAPI document."""
        return schema.describe(self)


@asynccontextmanager
async def living(app: FastAPI) -> AsyncIterator[None]:
    """Find what an earlier life left, and leave nothing running at the end."""
    context: Context = app.state.context
    await to_thread(context.recordings.sweep)
    await context.diagnosing.open()
    context.past.open()
    try:
        yield
    finally:
        await context.past.close()
        await context.diagnosing.close()


def create_app(
    settings: Settings,
    control: Client,
    bench: Client | None,
    *,
    started_at: float,
    version: str,
) -> FastAPI:
    """Put the application together; serve it while it is :func:`living`.

    Parameters
    ----------
    settings
        What the daemon was told to do, as it was loaded.
    control
        Answers :mod:`gripperd.link.control`; the caller closes it.
    bench
        Answers :mod:`gripperd.link.bench`; None on hardware.
    started_at
        Seconds since the epoch.
    version
        Of gripperd.
    """
    app = Service(
        title="gripperd",
        version=version,
        description=DESCRIPTION,
        docs_url=None,
        redoc_url=None,
        redirect_slashes=False,
        generate_unique_id_function=lambda route: route.name,
    )
    fleet = Fleet(settings, partial(gone_by, control))
    recordings = Recordings(settings.state_dir / "recordings")
    app.state.context = Context(
        settings=settings,
        fleet=fleet,
        control=control,
        bench=bench,
        library=ProfileLibrary(settings.profiles, settings.state_dir / "profiles"),
        states=shared_states(fleet, control),
        started_at=started_at,
        version=version,
        recordings=recordings,
        past=Past(settings.state_dir / "history.db", control, fleet),
        diagnosing=Diagnosing(
            Diagnoses(settings.state_dir / "diagnoses"),
            recordings,
            lambda: datetime.now(UTC),
        ),
    )
    # The first is matched first: states are what is read most.
    for resource in (
        grippers,
        commands,
        leases,
        faults,
        history,
        health,
        profiles,
        predictions,
        models,
        recordings_resource,
        diagnoses,
        settings_resource,
        bench_resource,
    ):
        app.include_router(resource.routes, prefix=VERSIONED, responses=schema.PROBLEM)
    app.include_router(metrics.routes)
    app.include_router(docs.routes)
    app.add_middleware(Guard, host=settings.http.host)
    answer_failures(app)
    return app
