"""Never move on start, never drop on restart: an egg is held through every end."""

import signal
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import httpx
import pytest

from gripperd.bench.placed import ObjectState
from tests.daemon import PATIENCE, gripperd, settings_file, until
from tests.parts import Part, Truth, part
from tests.wiretap import Wiretap, wiretap

SETTLED = 0.02
"""Share by which the force may differ; the rig is at rest. [-]"""


@dataclass
class Cell:
    """Bench, control and service apart, and everything that control says tapped."""

    config: Path
    wired: Path
    """What control goes by: the bench as hardware, through the tap."""
    tap: Wiretap
    log: Path
    stack: ExitStack
    parts: dict[str, Part] = field(default_factory=dict)

    def start(self, name: str) -> None:
        config = self.wired if name == "control" else self.config
        with self.log.open("ab") as log:
            started = part(config, name, stderr=log)
            self.parts[name] = self.stack.enter_context(started)

    def end(self, name: str, number: signal.Signals) -> None:
        process = self.parts[name].process
        process.send_signal(number)
        process.wait(PATIENCE)

    @property
    def http(self) -> httpx.Client:
        url = self.parts["service"].facts["ADDRESS"]
        return httpx.Client(base_url=f"{url}/v1", timeout=PATIENCE)

    def state(self) -> dict[str, Any]:
        with self.http as http:
            found: dict[str, Any] = http.get("/grippers/g0").json()
        return found

    def ready(self) -> bool:
        return self.state().get("machine") == "ready"

    def told(self, kind: str) -> list[str]:
        """What the history says, newest first."""
        with self.http as http:
            found = http.get("/history", params={"kind": kind}).json()
        return [event["text"] for event in found["events"]]

    def hold_an_egg(self) -> float:
        with self.http as http:
            http.put("/bench/object", json={"profile": "raw_egg"}).raise_for_status()
            body = {"type": "grasp", "profile": "raw_egg"}
            done = http.post(
                "/grippers/g0/commands", json=body, headers={"Prefer": "wait=60"}
            ).json()
        assert done["status"] == "succeeded", str(done)
        return float(done["result"]["force_N"])


@contextmanager
def cell(folder: Path) -> Iterator[Cell]:
    with ExitStack() as stack:
        config = settings_file(folder)
        bench = stack.enter_context(part(config, "bench", stderr=subprocess.DEVNULL))
        host, _, port = bench.facts["ADDRESS"].rpartition(":")
        tap = stack.enter_context(wiretap(host, int(port)))
        # On a busy machine bench and tap may be late; that is no cable that is out.
        bus = f'bus: {{tcp: "{tap.address}", timeout_ms: 10000}}'
        wired = folder / "wired.yaml"
        wired.write_text(config.read_text().replace("bus: bench", bus))
        made = Cell(config, wired, tap, folder / "log", stack)
        made.start("control")
        made.start("service")
        until(made.ready)
        yield made


def killed(cell: Cell) -> None:
    cell.end("control", signal.SIGKILL)


def terminated(cell: Cell) -> None:
    cell.end("control", signal.SIGTERM)


def out_of_memory(cell: Cell) -> None:
    """The kernel kills a whole unit, the service too."""
    cell.end("service", signal.SIGKILL)
    cell.end("control", signal.SIGKILL)


def upgraded(cell: Cell) -> None:
    """Both are replaced, the interface first."""
    cell.end("service", signal.SIGTERM)
    cell.end("control", signal.SIGTERM)


def cable_out(cell: Cell) -> None:
    cell.tap.cut()
    cell.end("control", signal.SIGKILL)


@pytest.mark.parametrize(
    "end", [killed, terminated, out_of_memory, upgraded, cable_out]
)
def test_an_egg_is_held_through_every_end_and_adopted(
    tmp_path: Path, end: Callable[[Cell], None]
) -> None:
    with cell(tmp_path) as held:
        held.hold_an_egg()
        with Truth(tmp_path / "run") as truth:
            until(lambda: bool(truth.states))
            ended_at = time.monotonic()
            end(held)
            before = len(held.tap.asked)
            for name in ("control", "service"):
                if held.parts[name].process.poll() is not None:
                    held.start(name)
            until(held.ready)
            until(lambda: len(held.tap.asked) > before + 100)
        state = held.state()
        assert (state["grip"], state["adopted"]) == ("holding", True)
        # Nobody knows any more what it is, so less of it counts.
        assert state["hold_budget"]["assumed"]
        assert 0 < state["hold_budget"]["air_s"] < 33
        assert held.tap.written(ended_at) == []
        forces = [each.grip for each in truth.states]
        assert min(forces) == pytest.approx(forces[0], rel=SETTLED)
        assert max(forces) == pytest.approx(forces[0], rel=SETTLED)
        assert len({each.current for each in truth.states}) == 1
        assert all(_carried(each.placed) for each in truth.states)
        assert told_last(held.log, "state") >= {"adopted=True", "grip=holding"}
        until(lambda: len(held.told("control")) == 2)
        found = f"adopted {state['current_mA']:.2f} mA as found"
        until(lambda: held.told("adoption")[0] == found)


def told_last(log: Path, topic: str) -> set[str]:
    """Words of the last line about a topic."""
    lines = [line for line in log.read_text().splitlines() if f"] {topic} " in line]
    return set(lines[-1].split())


def _carried(placed: Any) -> bool:  # noqa: ANN401 - or nothing
    return (
        placed is not None and placed.state is ObjectState.HELD and not placed.cracked
    )


def test_nothing_is_written_on_a_first_start(tmp_path: Path) -> None:
    with cell(tmp_path) as fresh:
        until(lambda: len(fresh.tap.asked) > 100)
        assert fresh.tap.written(0.0) == []


def test_a_tare_survives_a_restart_and_is_told(tmp_path: Path) -> None:
    with cell(tmp_path) as tared:
        with tared.http as http:
            done = http.post(
                "/grippers/g0/commands",
                json={"type": "tare"},
                headers={"Prefer": "wait=60"},
            ).json()
        assert done["status"] == "succeeded", str(done)
        before = tared.state()
        assert before["zero_N"] == done["result"]["zero_N"]
        assert before["tared_at"] is not None
        until((tmp_path / "state" / "zeros" / "g0.yaml").exists)
        killed(tared)
        tared.start("control")
        until(tared.ready)
        after = tared.state()
        kept = ("zero_N", "tared_at")
        assert [after[key] for key in kept] == [before[key] for key in kept]
        assert "adopted the zero of the force sensor" in tared.log.read_text()
        until(lambda: tells(tared, "adopted the zero of the force sensor"))


def tells(cell: Cell, what: str) -> bool:
    with cell.http as http:
        events = http.get("/history", params={"kind": "adoption"}).json()["events"]
    return any(what in event["text"] for event in events)


def test_a_killed_motion_stays_where_it_was_and_is_not_gone_on_with(
    tmp_path: Path,
) -> None:
    with cell(tmp_path) as moving, moving.http as http:
        body = {"type": "grasp", "profile": "raw_egg"}
        http.post("/grippers/g0/commands", json=body).raise_for_status()
        until(lambda: len(moving.tap.written(0.0)) > 20)
        killed(moving)
        ended_at = time.monotonic()
        left = http.get("/bench").json()["current_mA"]
        moving.start("control")
        until(moving.ready)
        before = len(moving.tap.asked)
        until(lambda: len(moving.tap.asked) > before + 100)
        assert moving.tap.written(ended_at) == []
        assert http.get("/bench").json()["current_mA"] == left
        assert moving.state()["command"] is None


def test_a_new_version_beside_the_old_one_is_refused_and_writes_nothing(
    tmp_path: Path,
) -> None:
    with cell(tmp_path) as old:
        old.hold_an_egg()
        since = time.monotonic()
        second = gripperd("control", "--config", str(old.wired))
        assert second.returncode == 1
        assert "another process answers" in second.stderr
        assert old.tap.written(since) == []
        assert old.state()["grip"] == "holding"
