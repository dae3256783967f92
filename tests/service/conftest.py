"""The whole daemon in one thread: bench, bus, control, links, service; real sockets."""

import asyncio
import threading
import time
import uuid
from collections.abc import Callable, Coroutine, Iterator
from contextlib import AsyncExitStack, contextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from queue import Queue
from random import Random
from typing import Any

import httpx
import pytest
import uvloop

from gripperd.bench.modules import Modules
from gripperd.bench.rig import Rig
from gripperd.bench.sensors import Sensor, SensorSettings
from gripperd.bench.server import serve_bench
from gripperd.config import (
    GripperSettings,
    Http,
    Settings,
    load_model,
    load_settings,
    shipped,
)
from gripperd.control.gripper import Gripper
from gripperd.control.loop import Loop
from gripperd.demo.files import write_rig
from gripperd.demo.hidden import Hidden
from gripperd.drivers.analog import AnalogRig
from gripperd.drivers.bus import TcpAddress, open_bus
from gripperd.link.bench import BenchDesk
from gripperd.link.client import Client
from gripperd.link.control import ControlDesk
from gripperd.link.server import serve as serve_link
from gripperd.protocol.live_zero import LoopScale
from gripperd.service.app import create_app, living
from gripperd.service.server import serve as serve_http
from tests.daemon import PATIENCE
from tests.demonstration import SEED, STEP
from tests.drivers.steady import steady

STARTED_AT = 1_700_000_000.0
Report = Callable[[str], None]


@pytest.fixture(scope="module")
def settings(tmp_path_factory: pytest.TempPathFactory) -> Settings:
    """The shipped bench, on free ports."""
    return replace(
        load_settings(shipped("gripperd.yaml"), {}),
        http=Http(host="127.0.0.1", port=0),
        runtime_dir=tmp_path_factory.mktemp("run"),
        state_dir=tmp_path_factory.mktemp("state"),
    )


@contextmanager
def running(main: Callable[[Report], Coroutine[Any, Any, None]]) -> Iterator[str]:
    """Run a server in a thread of its own while inside; gives what it reports."""
    reports: Queue[str | BaseException] = Queue()
    handles: Queue[tuple[asyncio.AbstractEventLoop, asyncio.Task[None]]] = Queue()

    async def guarded() -> None:
        task = asyncio.current_task()
        assert task is not None
        handles.put((asyncio.get_running_loop(), task))
        try:
            await main(reports.put)
        except Exception as error:
            reports.put(error)
            raise

    def run() -> None:
        with suppress(asyncio.CancelledError):
            uvloop.run(guarded())

    thread = threading.Thread(target=run)
    thread.start()
    loop, task = handles.get()
    try:
        url = reports.get()
        if isinstance(url, BaseException):
            raise url
        yield url
    finally:
        if not loop.is_closed():
            loop.call_soon_threadsafe(task.cancel)
        thread.join()


async def service(settings: Settings, report: Report, *, bench: bool) -> None:
    """The service in front of the sockets of a folder."""
    control = Client(settings.runtime_dir / "control.sock", "the control process")
    rig = Client(settings.runtime_dir / "bench.sock", "the bench") if bench else None
    app = create_app(settings, control, rig, started_at=STARTED_AT, version="1.2.3")
    try:
        async with living(app):
            await serve_http(app, "127.0.0.1", 0, report)
    finally:
        await control.close()
        if rig is not None:
            await rig.close()


async def unplugged(settings: Settings, port: int, report: Report) -> None:
    """Service and control, and nobody on the bus."""
    async with AsyncExitStack() as stack:
        loop = await _control(settings, TcpAddress(host="127.0.0.1", port=port), stack)
        await _together(loop.run(), service(settings, report, bench=False))


async def whole(settings: Settings, report: Report) -> None:
    """Everything."""
    (gripper,) = settings.grippers.values()
    assert gripper.input is not None
    # As in the shipped settings: the grip sensor spans 100 N.
    grip = Sensor(LoopScale(value_low=0.0, value_high=100.0), 5e-4)
    rig = Rig(gripper.chain, Random(1), sensors=SensorSettings(grip=grip))
    modules = Modules(
        rig,
        (gripper.output.module, gripper.output.unit),
        (gripper.input.module, gripper.input.unit),
    )
    async with AsyncExitStack() as stack:
        server = await stack.enter_async_context(serve_bench(modules, "127.0.0.1", 0))
        host, _, port = server.address.rpartition(":")
        loop = await _control(settings, TcpAddress(host=host, port=int(port)), stack)
        desk = BenchDesk(server, rig)
        await stack.enter_async_context(
            serve_link(settings.runtime_dir / "bench.sock", desk.respond)
        )
        await _together(loop.run(), service(settings, report, bench=True))


async def _control(
    settings: Settings, address: TcpAddress, stack: AsyncExitStack
) -> Loop:
    gripper: GripperSettings = settings.grippers["g0"]
    bus = await stack.enter_async_context(open_bus(address))
    steady(bus)
    loop = Loop(
        Gripper(
            "g0",
            gripper.chain,
            auto_enable=True,
            identify=lambda: uuid.uuid4().hex,
        ),
        AnalogRig(bus, gripper.output, gripper.input),
        period=0.01,
    )
    desk = ControlDesk({"g0": loop}, real_time=False, started_at=STARTED_AT)
    await stack.enter_async_context(
        serve_link(settings.runtime_dir / "control.sock", desk.respond)
    )
    return loop


async def _together(*coroutines: Coroutine[Any, Any, None]) -> None:
    async with asyncio.TaskGroup() as tasks:
        for coroutine in coroutines:
            tasks.create_task(coroutine)


@dataclass(frozen=True)
class Daemon:
    """A running daemon and a client of it."""

    url: str
    http: httpx.Client

    def until(
        self, path: str, holds: Callable[[dict[str, Any]], bool]
    ) -> dict[str, Any]:
        """Read a resource until something holds of it."""
        while True:
            found: dict[str, Any] = self.http.get(path).json()
            if holds(found):
                return found
            time.sleep(0.01)


@pytest.fixture(scope="module")
def whole_daemon(settings: Settings) -> Iterator[Daemon]:
    """One for the tests of a file: a fifth of a core is too much to leave running."""
    with (
        running(lambda report: whole(settings, report)) as url,
        httpx.Client(base_url=url, timeout=PATIENCE) as http,
    ):
        yield Daemon(url, http)


@pytest.fixture
def daemon(whole_daemon: Daemon) -> Daemon:
    """The daemon, ready, with open jaws and nothing between them."""
    return made_ready(whole_daemon)


def made_ready(whole_daemon: Daemon) -> Daemon:
    """A daemon, once it is ready, with open jaws and nothing between them."""
    http = whole_daemon.http
    http.delete("/v1/bench/faults")
    ready = "/v1/grippers/g0"
    whole_daemon.until(ready, lambda state: state["machine"] != "attaching")
    if http.get(ready).json()["machine"] == "executing":
        http.post(f"{ready}/stop")
    if http.get(ready).json()["machine"] == "fault":
        recover(whole_daemon)
    if http.get(ready).json()["machine"] == "disabled":
        http.post(f"{ready}/enable")
    whole_daemon.until(ready, lambda state: state["machine"] == "ready")
    if http.get(ready).json()["grip"] != "released":
        released = http.post(f"{ready}/commands?wait_s=60", json={"type": "release"})
        assert released.json()["status"] == "succeeded"
    http.delete("/v1/bench/object")
    return whole_daemon


def recover(daemon: Daemon) -> None:
    """Leave a fault whose cause is mended."""
    gripper = "/v1/grippers/g0"
    for fault in daemon.http.get(f"{gripper}/faults?active=true").json()["faults"]:
        path = f"{gripper}/faults/{fault['id']}/acknowledge"
        daemon.http.post(path, json={"by": "the next test"}).raise_for_status()
    daemon.until(
        f"{gripper}/faults?active=true",
        lambda found: all("cleared_at" in fault for fault in found["faults"]),
    )
    daemon.http.post(f"{gripper}/reset").raise_for_status()


@pytest.fixture(scope="session")
def rig_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A rig with creep: its recording, and the drawing's model, which has none."""
    folder = tmp_path_factory.mktemp("rig")
    write_rig(folder, Hidden.CREEP, SEED, STEP)
    model = folder / "model.yaml"
    gripper = (
        "gripper: {open_width_mm: 85, width_per_contraction: 4.0,"
        " spring_preload_N: 240, spring_rate_N_per_mm: 1.0}\n"
    )
    model.write_text(model.read_text() + gripper)
    return folder


@pytest.fixture(scope="module")
def drawn_settings(
    settings: Settings, rig_folder: Path, tmp_path_factory: pytest.TempPathFactory
) -> Settings:
    """The shipped bench, with a gripper whose model is the drawing's."""
    model = load_model(rig_folder / "model.yaml")
    gripper = replace(settings.grippers["g0"], model=model, chain=model.chain())
    return replace(
        settings,
        grippers={"g0": gripper},
        runtime_dir=tmp_path_factory.mktemp("drawn_run"),
        state_dir=tmp_path_factory.mktemp("drawn_state"),
    )


@pytest.fixture(scope="module")
def drawn_daemon(drawn_settings: Settings) -> Iterator[Daemon]:
    with (
        running(lambda report: whole(drawn_settings, report)) as url,
        httpx.Client(base_url=url, timeout=PATIENCE) as http,
    ):
        yield Daemon(url, http)


@pytest.fixture
def drawn(drawn_daemon: Daemon) -> Daemon:
    """A daemon that goes by the drawing's model, ready, with empty jaws."""
    return made_ready(drawn_daemon)


@pytest.fixture(scope="module")
def lonely(
    settings: Settings, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[httpx.Client]:
    """A service on hardware whose control process is not running."""
    apart = replace(settings, runtime_dir=tmp_path_factory.mktemp("alone"))
    with (
        running(lambda report: service(apart, report, bench=False)) as url,
        httpx.Client(base_url=url, timeout=PATIENCE) as http,
    ):
        yield http
