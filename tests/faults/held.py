"""The whole daemon as a user runs it, holding an egg, and what may not change."""

import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Self

import httpx

from gripperd.control.grasp import TOLERANCE_SHARE
from tests.daemon import Daemon, children, running_daemon, until

PATIENCE = 60.0
"""Longest wait for anything. [s]"""
SETTLED = 0.02
"""Share by which the force may differ. [-]"""
ASKED = 12.0
"""Force of each jaw that the shipped profile of an egg asks for. [N]"""
ADJUSTED = TOLERANCE_SHARE + 0.01
"""Share by which it may differ from what was asked for: what a command accepts of the
force measured, and how far that is from the true one. [-]"""
UNSETTLED = {"executing", "stopping", "offline", "attaching"}
COMMANDS = "/grippers/g0/commands"


@dataclass(frozen=True)
class Held:
    """A daemon that holds an egg."""

    daemon: Daemon
    http: httpx.Client
    """Of ``/v1``."""
    folder: Path
    force: float
    """Of each jaw, truly. [N]"""

    def answer(self, path: str) -> dict[str, Any]:
        """A document; nothing while there is none."""
        with suppress(httpx.TransportError):
            found = self.http.get(path)
            document: dict[str, Any] = found.json() if found.is_success else {}
            return document
        return {}

    def ready(self) -> bool:
        """Whether all of it answers."""
        return bool(self.answer("/health/ready"))

    def process(self, name: str) -> int:
        """Id of one of its processes, 0 while there is none."""
        return children(self.daemon.process).get(name, 0)

    def since(self, start: float, happened: Callable[[], bool]) -> float:
        """Time from then until something has happened. [s]."""
        until(happened, PATIENCE)
        return time.monotonic() - start

    def adjusted(self) -> Self:
        """The same from a command on that has brought the force to its target again."""
        force = float(self.answer("/bench")["force_N"])
        assert abs(force - ASKED) <= ADJUSTED * ASKED, f"{force:.2f} N"
        return replace(self, force=force)

    def wrong(self) -> set[str]:
        """What is not as it was when the egg had been grasped, once nothing moves."""
        until(lambda: self.answer("/grippers/g0").get("machine") not in UNSETTLED)
        state, truth = self.http.get("/grippers/g0").json(), self.http.get("/bench")
        force = truth.json()["force_N"]
        found = set[str]()
        if (state["machine"], state["grip"]) != ("ready", "holding"):
            found.add(f"{state['machine']}, {state['grip']}")
        if abs(force - self.force) > SETTLED * self.force:
            found.add(f"{self.force:.2f} N became {force:.2f} N")
        if truth.json()["object"]["cracked"]:
            found.add("cracked")
        return found

    def give(self, key: str | None = None, **command: object) -> httpx.Response:
        """Give a command and wait for its end."""
        headers = {"Prefer": "wait=60"} | ({"Idempotency-Key": key} if key else {})
        return self.http.post(COMMANDS, json=command, headers=headers)

    def over(self, given: httpx.Response) -> dict[str, Any]:
        """A command once it has its end."""
        place = f"{COMMANDS}/{given.json()['id']}"
        until(lambda: self.answer(place).get("completed_at") is not None, PATIENCE)
        return self.answer(place)

    def told(self, **query: str) -> list[dict[str, Any]]:
        """Events of the history, newest first."""
        found = self.http.get("/history", params=query)
        events: list[dict[str, Any]] = found.raise_for_status().json()["events"]
        return events


@contextmanager
def held_egg(
    folder: Path | None = None, within: Sequence[str] = (), **environment: str
) -> Iterator[Held]:
    """Run a daemon while inside, and let it hold an egg."""
    with tempfile.TemporaryDirectory() as name:
        place = folder or Path(name)
        with (
            running_daemon(place, within, **environment) as daemon,
            httpx.Client(base_url=f"{daemon.url}/v1", timeout=PATIENCE) as http,
        ):
            yield grasped(daemon, http, place)


def grasped(daemon: Daemon, http: httpx.Client, folder: Path) -> Held:
    """Grasp an egg."""
    http.put("/bench/object", json={"profile": "raw_egg"}).raise_for_status()
    done = Held(daemon, http, folder, 0.0).give(type="grasp", profile="raw_egg")
    assert done.json()["status"] == "succeeded", done.text
    return Held(daemon, http, folder, settled_force(http))


def settled_force(http: httpx.Client) -> float:
    """Force of each jaw, once it is no more brought up to its target. [N]."""
    force, before = 0.0, -1.0

    def is_settled() -> bool:
        nonlocal force, before
        before = force
        time.sleep(1.0)
        force = float(http.get("/bench").json()["force_N"])
        return abs(force - before) < SETTLED / 4 * force

    until(is_settled)
    return force
