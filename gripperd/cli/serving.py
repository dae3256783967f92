"""The service process; apart, so that control never loads a web framework."""

import time
from os import nice

import structlog

from gripperd import __version__
from gripperd.cli.notify import notify
from gripperd.cli.processes import bench_socket, control_socket, simulated
from gripperd.config import Settings
from gripperd.link.client import Client
from gripperd.link.folder import private_folder
from gripperd.service.app import create_app, living
from gripperd.service.server import serve as serve_http

SERVICE_NICENESS = 5
"""Below the control loop, which matters where that has no real-time priority."""

log = structlog.get_logger()


async def service(settings: Settings, address: tuple[str, int] | None) -> None:
    """Serve REST."""
    # Who put a folder there before us could answer in the place of control.
    private_folder(settings.runtime_dir, control_socket(settings).name)
    nice(SERVICE_NICENESS)
    bench_client = None
    if simulated(settings) is not None:
        bench_client = Client(bench_socket(settings), "the bench")
    control_client = Client(control_socket(settings), "the control process")
    app = create_app(
        settings,
        control_client,
        bench_client,
        started_at=time.time(),
        version=__version__,
    )

    def ready(url: str) -> None:
        log.info("service listens", url=url)
        notify(READY=1, ADDRESS=url)

    host, port = address or (settings.http.host, settings.http.port)
    try:
        async with living(app):
            await serve_http(app, host, port, ready)
    finally:
        for client in filter(None, (control_client, bench_client)):
            await client.close()
