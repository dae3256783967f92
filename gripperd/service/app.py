"""The application: every resource, behind the guard, in front of control and bench."""

from typing import Any

from fastapi import FastAPI

from gripperd.config import Settings
from gripperd.link.client import Client
from gripperd.service import bench as bench_resource
from gripperd.service import (
    commands,
    docs,
    grippers,
    health,
    predictions,
    profiles,
    schema,
)
from gripperd.service.context import Context, shared_states
from gripperd.service.failures import answer_failures
from gripperd.service.guard import Guard
from gripperd.service.library import ProfileLibrary

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


def create_app(
    settings: Settings,
    control: Client,
    bench: Client | None,
    *,
    started_at: float,
    version: str,
) -> FastAPI:
    """Put the application together.

    Parameters
    ----------
    settings
        What the daemon was told to do.
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
    app.state.context = Context(
        settings=settings,
        control=control,
        bench=bench,
        library=ProfileLibrary(settings.profiles, settings.state_dir / "profiles"),
        states=shared_states(settings, control),
        started_at=started_at,
        version=version,
    )
    # The first is matched first: states are what is read most.
    for resource in (grippers, commands, health, profiles, predictions, bench_resource):
        app.include_router(resource.routes, prefix=VERSIONED, responses=schema.PROBLEM)
    app.include_router(docs.routes)
    app.add_middleware(Guard, host=settings.http.host)
    answer_failures(app)
    return app
