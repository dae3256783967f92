"""The clock on the wall steps under the whole daemon; the monotonic one does not.

A small library in front of the C library shifts the one clock for every process of
the daemon, SQLite included; the clock of the machine is left alone.
"""

import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from datetime import UTC, datetime
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

from tests.daemon import until
from tests.faults.held import Held, held_egg
from tests.faults.row import Row

SOURCE = Path(__file__).with_name("clock_step.c")
HOUR = 3600
ZONE = "Europe/Berlin"
"""Where an hour is told twice on a night in October, and a minute may have 61 s."""
ON_TIME = 5.0
"""Longest that a command or an event may take here. [s]"""
TTL = 2.0
"""Of a lease that has to end in time. [s]"""


class Wall(NamedTuple):
    """The clock on the wall of a daemon."""

    file: Path

    def step(self, seconds: int) -> None:
        """Be so far off from now on. [s]."""
        with self.file.open("r+b") as file:
            file.write(seconds.to_bytes(8, "little", signed=True))

    @property
    def offset(self) -> int:
        """How far it is off. [s]."""
        return int.from_bytes(self.file.read_bytes(), "little", signed=True)

    def step_to(self, moment: datetime) -> None:
        """Show another time from now on."""
        self.step(round(moment.timestamp() - time.time()))


def compiled(folder: Path) -> Mapping[str, str] | None:
    """Environment of processes whose clock can be stepped; None without a compiler."""
    compiler = shutil.which("gcc")
    if compiler is None:
        return None
    library, file = folder / "clock_step.so", folder / "step"
    flags = ("-O2", "-shared", "-fPIC", "-o", str(library), str(SOURCE), "-ldl")
    subprocess.run([compiler, *flags], check=True)
    file.write_bytes(bytes(8))
    return {"LD_PRELOAD": str(library), "CLOCK_STEP": str(file), "TZ": ZONE}


@contextmanager
def on_the_wall() -> Iterator[tuple[Held, Wall] | None]:
    """A daemon that holds an egg, and its clock; None without a compiler."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        environment = compiled(folder)
        if environment is None:
            yield None
            return
        with held_egg(folder, (), **environment) as held:
            yield held, Wall(folder / "step")


def stepped(held: Held, wall: Wall, name: str, seconds: int) -> Row:
    """Step the clock while an egg is held and a lease runs, and back."""
    return _shifted(held, wall, name, lambda: wall.step(seconds))


def told_twice(held: Held, wall: Wall) -> Row:
    """Live through the end of daylight saving, when local time repeats an hour."""
    night = datetime(2026, 10, 25, 0, 59, 59, tzinfo=UTC)
    return _shifted(held, wall, "daylight saving ends", lambda: wall.step_to(night))


def _shifted(held: Held, wall: Wall, name: str, shift: Callable[[], None]) -> Row:
    processes = [held.process(each) for each in ("control", "service")]
    before = held.told(limit="1")[0]["number"]
    lease = {"owner": "the test", "ttl_s": TTL}
    asked = time.monotonic()
    held.http.put("/grippers/g0/lease", json=lease).raise_for_status()
    shift()
    # Two seconds are two seconds, whatever the clock on the wall says.
    until(lambda: held.answer("/grippers/g0/lease").get("owner") is None)
    lasted = time.monotonic() - asked
    start = time.monotonic()
    done = held.give(type="adjust").json()
    took = held.since(start, lambda: len(held.told(command=done["id"])) == 3)
    stepped = datetime.fromisoformat(done["created_at"]).timestamp() - time.time()
    expected = wall.offset
    wall.step(0)
    wrong = _records(held, before, done["id"]) | held.adjusted().wrong()
    if lasted < TTL:
        wrong.add(f"a lease of {TTL:g} s lasted {lasted:.1f} s")
    if abs(stepped - expected) > HOUR / 2:
        wrong.add("the clock did not step")
    if processes != [held.process(each) for each in ("control", "service")]:
        wrong.add("a process was started anew")
    return Row(
        fault=name,
        noticed="nothing; a command and its records on time",
        took=(took,),
        limit=ON_TIME,
        wrong=tuple(sorted(wrong)),
    )


def _records(held: Held, before: int, command: str) -> set[str]:
    """What is wrong with the records since a number."""
    events = held.told(limit="500")
    numbers = [event["number"] for event in events]
    wrong = set[str]()
    if numbers != sorted(numbers, reverse=True):
        wrong.add("records out of order")
    if any(first - second != 1 for first, second in pairwise(numbers)):
        wrong.add("records are missing")
    if not all(event["at"].endswith("Z") for event in events):
        wrong.add("records not in UTC")
    of_command = [
        event["command"]["status"]
        for event in events
        if event["number"] > before and event.get("command", {}).get("id") == command
    ]
    if of_command != ["succeeded", "running", "queued"]:
        wrong.add(f"a command was told as {of_command}")
    newest = held.answer("/grippers/g0/commands")["commands"][0]["id"]
    if newest != command:
        wrong.add("the newest command is not listed first")
    return wrong


def rows() -> Iterator[Row]:
    """Each on the same daemon, while it holds an egg."""
    with on_the_wall() as found:
        if found is None:
            yield Row(fault="clock steps", noticed="not tried: no compiler")
            return
        held, wall = found
        yield stepped(held, wall, "clock steps by an hour", HOUR)
        yield stepped(held, wall, "clock steps back by an hour", -HOUR)
        yield stepped(held, wall, "leap second: a second twice", -1)
        yield told_twice(held, wall)
