"""Processes that live but do not get on: stopped by a signal, as a debugger does."""

import asyncio
import os
import signal
import socket
import time
from collections.abc import Awaitable, Callable
from contextlib import suppress
from itertools import pairwise
from pathlib import Path

import httpx
import pytest

from gripperd.cli.run import CONTROL_SILENCE
from gripperd.cli.supervisor import Child
from gripperd.link.folder import private_folder
from tests.daemon import (
    PATIENCE,
    children,
    document,
    running,
    running_daemon,
    settings_file,
    until,
)
from tests.parts import Truth

SILENCE = 5.0
"""Longest silence of a child in these tests. [s]"""


@pytest.fixture
def anyio_backend() -> object:
    """The event loop of the program; these tests are too slow for two."""
    return ("asyncio", {"use_uvloop": True})


def ready(url: str) -> bool:
    with suppress(httpx.TransportError):
        return httpx.get(f"{url}/v1/health/ready", timeout=PATIENCE).is_success
    return False


def test_a_stalled_control_is_started_anew_and_the_grip_stays(tmp_path: Path) -> None:
    with running_daemon(tmp_path) as daemon:
        with httpx.Client(base_url=f"{daemon.url}/v1", timeout=PATIENCE) as http:
            http.put("/bench/object", json={"profile": "raw_egg"}).raise_for_status()
            http.post(
                "/grippers/g0/commands",
                json={"type": "grasp", "profile": "raw_egg"},
                headers={"Prefer": "wait=60"},
            ).raise_for_status()
        stalled = children(daemon.process)["control"]
        service = children(daemon.process)["service"]
        with Truth(tmp_path / "run") as truth:
            until(lambda: bool(truth.states))
            os.kill(stalled, signal.SIGSTOP)
            until(lambda: children(daemon.process).get("control", stalled) != stalled)
            until(lambda: ready(daemon.url))
        state = document(f"{daemon.url}/v1/grippers/g0")
        assert (state["grip"], state["adopted"]) == ("holding", True)
        forces = [each.grip for each in truth.states]
        assert max(forces) - min(forces) < 0.02 * forces[0]
        assert children(daemon.process)["service"] == service


def test_the_unit_is_fed_by_control_and_by_nothing_else(tmp_path: Path) -> None:
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as manager:
        manager.bind(str(tmp_path / "notify"))
        manager.settimeout(PATIENCE)
        arguments = ("run", "--config", str(settings_file(tmp_path)))
        with running(*arguments, NOTIFY_SOCKET=str(tmp_path / "notify")) as process:
            while b"READY=1" not in manager.recv(4096):
                pass
            assert manager.recv(4096) == b"WATCHDOG=1"
            assert manager.recv(4096) == b"WATCHDOG=1"
            parts = children(process)
            os.kill(parts["service"], signal.SIGSTOP)
            assert manager.recv(4096) == b"WATCHDOG=1"
            stalled = parts["control"]
            os.kill(stalled, signal.SIGSTOP)
            fed = [time.monotonic()]
            # Its next life feeds the unit as well.
            while children(process).get("control", stalled) == stalled:
                assert manager.recv(4096) == b"WATCHDOG=1"
                fed.append(time.monotonic())
            os.kill(parts["service"], signal.SIGCONT)
        # Four times as long as control leaves it without.
        assert max(later - sooner for sooner, later in pairwise(fed)) > CONTROL_SILENCE


def started(folder: Path) -> Child:
    """A service with nobody behind it: it is ready all the same."""
    private_folder(folder / "run", "service.notify")
    arguments = ["service", "--config", str(settings_file(folder))]
    return Child("service", arguments, folder / "run", SILENCE)


@pytest.mark.anyio
async def test_a_stalled_service_is_killed(tmp_path: Path) -> None:
    child = started(tmp_path)
    await child.start()
    assert child.process is not None
    child.process.send_signal(signal.SIGSTOP)
    assert await child.died() == -signal.SIGKILL
    await child.end()


@pytest.mark.anyio
async def test_a_service_that_answers_is_left_alone(
    tmp_path: Path, eventually: Callable[[Callable[[], bool]], Awaitable[None]]
) -> None:
    child = started(tmp_path)
    signs: list[float] = []
    child.alive = lambda: signs.append(time.monotonic())
    await child.start()
    watch = asyncio.create_task(child.died())
    since = time.monotonic()
    # Longer than it could have lived without a sign.
    await eventually(lambda: bool(signs) and signs[-1] - since > 1.5 * SILENCE)
    assert not watch.done()
    assert len(signs) > 2
    watch.cancel()
    await child.end()


@pytest.mark.anyio
async def test_a_supervisor_that_stalled_itself_blames_nobody(tmp_path: Path) -> None:
    child = started(tmp_path)
    await child.start()
    watch = asyncio.create_task(child.died())
    await asyncio.sleep(0.1)
    # Nothing in this process runs, while the child goes on.
    time.sleep(1.25 * SILENCE)  # noqa: ASYNC251
    await asyncio.sleep(0.1)
    assert not watch.done()
    watch.cancel()
    await child.end()
