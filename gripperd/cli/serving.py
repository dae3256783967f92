"""The service process; apart, so that control never loads a web framework."""

import asyncio
import time
from contextlib import suppress
from os import nice
from pathlib import Path
from urllib.parse import urlsplit

import structlog

from gripperd import __version__
from gripperd.cli.garbage import spare_what_stays
from gripperd.cli.notify import notify
from gripperd.cli.processes import bench_socket, control_socket, simulated
from gripperd.cli.watchdog import Watchdog, longest_silence
from gripperd.config import Settings
from gripperd.errors import LinkError
from gripperd.link.client import Client
from gripperd.link.control import Overview, ReadOverview
from gripperd.link.folder import private_folder
from gripperd.service.app import create_app, living
from gripperd.service.server import serve as serve_http

SERVICE_NICENESS = 5
"""Below the control loop, where that has no real-time priority."""
ASKED_WITHIN = 2.0
"""Control may be starting at the same time. [s]"""

EXPENDABLE = 300
"""Out of memory, the service and its workers are ended before control (proc(5))."""
LOOK = b"GET /v1/health/live HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n"
LOOKED_AGAIN = 1.0
"""Pause between two looks at itself. [s]"""
ASKED_AGAIN = 0.05
"""[s]"""

log = structlog.get_logger()


async def service(settings: Settings, address: tuple[str, int] | None) -> None:
    """Serve REST."""
    # Who put a folder there before us could answer in the place of control.
    private_folder(settings.runtime_dir, control_socket(settings).name)
    _let_control_live()
    bench_client = None
    if simulated(settings) is not None:
        bench_client = Client(bench_socket(settings), "the bench")
    control_client = Client(control_socket(settings), "the control process")
    await _give_way(control_client)
    app = create_app(
        settings,
        control_client,
        bench_client,
        started_at=time.time(),
        version=__version__,
    )

    looks: list[asyncio.Task[None]] = []

    def ready(url: str) -> None:
        spare_what_stays()
        log.info("service listens", url=url)
        notify(READY=1, ADDRESS=url)
        looks.append(asyncio.create_task(_look_at_itself(url)))

    host, port = address or (settings.http.host, settings.http.port)
    try:
        async with living(app):
            await serve_http(app, host, port, ready)
    finally:
        for look in looks:
            look.cancel()
        for client in filter(None, (control_client, bench_client)):
            await client.close()


def _let_control_live() -> None:
    with suppress(OSError):
        Path("/proc/self/oom_score_adj").write_text(str(EXPENDABLE))


async def _give_way(control: Client) -> None:
    """Leave the processor to control, unless it takes it by itself."""
    with suppress(TimeoutError):
        async with asyncio.timeout(ASKED_WITHIN):
            if await _in_real_time(control):
                return
    nice(SERVICE_NICENESS)


async def _in_real_time(control: Client) -> bool:
    """Whether control has real-time priority, once it answers."""
    while True:
        with suppress(LinkError):
            overview = await control.ask(ReadOverview(), Overview, ASKED_WITHIN)
            return overview.real_time
        await asyncio.sleep(ASKED_AGAIN)


async def _look_at_itself(url: str) -> None:
    """Feed the watchdog while this process answers requests; it asks itself."""
    place = urlsplit(url)
    watchdog = Watchdog(("service",), longest_silence())
    while place.hostname and place.port:
        with suppress(OSError):
            await _answer(place.hostname, place.port)
            watchdog.advanced("service")
        await asyncio.sleep(LOOKED_AGAIN)


async def _answer(host: str, port: int) -> None:
    reader, writer = await asyncio.open_connection(host, port)
    try:
        writer.write(LOOK)
        await reader.readline()
    finally:
        writer.close()
