"""A disk that fails under a daemon that holds an egg: it says so, and holds."""

import os
import resource
import shutil
import signal
import sqlite3
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, closing, contextmanager
from pathlib import Path
from random import Random

from gripperd.service.archive import REST
from tests.daemon import until
from tests.faults.held import COMMANDS, Held, held_egg
from tests.faults.row import Row

SAID_WITHIN = 5.0
"""A lock is waited for for two seconds, and who asks may be behind another. [s]"""
SIZE = "4m"
"""Of the small disk."""
KEPT = "given before"
"""Key of a command that was acknowledged when all was well."""

Injected = AbstractContextManager[None]


@contextmanager
def limited(held: Held) -> Iterator[None]:
    """No file of the service may grow: everywhere, the nearest to a full disk."""
    service = held.process("service")
    before = resource.prlimit(service, resource.RLIMIT_FSIZE)
    resource.prlimit(service, resource.RLIMIT_FSIZE, (1, before[1]))
    try:
        yield
    finally:
        resource.prlimit(service, resource.RLIMIT_FSIZE, before)


def small_disk(folder: Path) -> tuple[str, ...]:
    """Command line that runs another with a small disk of its own as its state."""
    mount = f'mount -t tmpfs -o size={SIZE} tmpfs "$0" && exec "$@"'
    return ("unshare", "--mount", "sh", "-c", mount, str(folder / "state"))


def may_mount() -> bool:
    """Whether this machine lets us have a disk of our own."""
    if shutil.which("unshare") is None:
        return False
    with tempfile.TemporaryDirectory() as name:
        (Path(name) / "state").mkdir()
        tried = (*small_disk(Path(name)), "true")
        done = subprocess.run(tried, capture_output=True, check=False)
    return done.returncode == 0


def _inside(held: Held) -> Path:
    """The state as the daemon sees it."""
    root = Path(f"/proc/{held.daemon.process.pid}/root")
    return root / (held.folder / "state").relative_to("/")


@contextmanager
def full(held: Held) -> Iterator[None]:
    """Not an octet more goes on the disk."""
    filling = _inside(held) / "filling"
    with filling.open("wb", buffering=0) as file:
        for size in (1 << 16, 1 << 10, 1):
            try:
                while file.write(b"." * size) == size:
                    pass
            except OSError:
                continue
    try:
        yield
    finally:
        filling.unlink()


@contextmanager
def read_only(held: Held) -> Iterator[None]:
    """The disk can be read and not be written, as after an error of its own."""

    def mounted(how: str) -> bool:
        target = str(held.folder / "state")
        enter = ("nsenter", "--mount", "--target", f"{held.daemon.process.pid}")
        again = [*enter, "mount", "-o", f"remount,{how}", target]
        return subprocess.run(again, capture_output=True, check=False).returncode == 0

    # Nothing may be open for writing then: the service finds it so at its start.
    def found_so() -> bool:
        if service := held.process("service"):
            os.kill(service, signal.SIGKILL)
        return mounted("ro")

    until(found_so)
    until(held.ready)
    try:
        yield
    finally:
        assert mounted("rw")


@contextmanager
def locked(held: Held) -> Iterator[None]:
    """Another program has the database for itself."""
    path = held.folder / "state" / "history.db"
    other = sqlite3.connect(path, isolation_level=None)
    with closing(other):
        other.execute("BEGIN EXCLUSIVE")
        yield


def failing(held: Held, name: str, inject: Callable[[Held], Injected]) -> Row:
    """Let the disk fail for a while."""
    wrong = set[str]()
    before = held.give(KEPT, type="adjust").json()["id"]
    with inject(held):
        start = time.monotonic()
        unkept = held.http.post(COMMANDS, json={"type": "adjust"})
        took = held.since(start, lambda: "degraded" in held.answer("/health/ready"))
        held.over(unkept)
        held = held.adjusted()
        wrong |= _as_promised(held, unkept.status_code)
    held.since(start, lambda: "degraded" not in held.answer("/health/ready"))
    name_of = unkept.json()["id"]
    held.since(start, lambda: len(held.told(command=name_of)) == 3)
    wrong |= _done_again(held, before)
    return Row(
        fault=name,
        noticed="degraded; recorded later",
        took=(took,),
        limit=SAID_WITHIN,
        wrong=tuple(sorted(wrong | held.wrong())),
    )


def _done_again(held: Held, before: str) -> set[str]:
    """Whether a command is carried out once more when its key comes again."""
    again = held.give(KEPT, type="adjust")
    same = (again.status_code, again.json()["id"]) == (200, before)
    return set() if same else {"an acknowledged command is lost"}


def _as_promised(held: Held, unkept: int) -> set[str]:
    """What does not go on as it must without a disk."""
    wrong = held.wrong()
    if unkept != 202:
        wrong.add(f"a command without a key got {unkept}")
    refused = held.give("given without a disk", type="adjust")
    if (refused.status_code, refused.json()["code"]) != (503, "not-recorded"):
        wrong.add(f"a command with a key got {refused.status_code}")
    # What can be read meanwhile says nothing of what can be written.
    time.sleep(2 * REST)
    held.answer("/history?limit=1")
    if "degraded" not in held.answer("/health/ready"):
        wrong.add("called sound after a read")
    warnings = held.answer("/info")["warnings"]
    if not any("history cannot be kept" in warning for warning in warnings):
        wrong.add("no warning")
    if not held.http.post("/grippers/g0/stop").is_success:
        wrong.add("no stop")
    return wrong


def corrupt(held: Held) -> Row:
    """Overwrite the database, and start the service anew on what is left."""
    path = held.folder / "state" / "history.db"
    old, before = held.process("service"), held.give(KEPT, type="adjust").json()["id"]
    held = held.adjusted()
    content = Random(1).randbytes(path.stat().st_size)
    start = time.monotonic()
    path.write_bytes(content)
    os.kill(old, signal.SIGKILL)
    held.since(start, lambda: held.process("service") not in {0, old} and held.ready())

    def told() -> bool:
        events = held.answer("/history?kind=storage").get("events", [])
        return any("damaged history was set aside" in each["text"] for each in events)

    took = held.since(start, told)
    wrong = held.wrong() | _done_again(held, before)
    aside = [each.stat().st_size for each in path.parent.glob("history.damaged-*.db")]
    if len(aside) != 1 or aside[0] < len(content):
        wrong.add("the damaged file is lost")
    return Row(
        fault="database overwritten, service restarted",
        noticed="set aside, told in the history",
        took=(took,),
        limit=10.0,
        wrong=tuple(sorted(wrong)),
    )


def rows() -> Iterator[Row]:
    """All of a kind on the same daemon, which has to recover from each."""
    with held_egg() as held:
        yield failing(held, "files may not grow", limited)
        yield failing(held, "database locked", locked)
        yield corrupt(held)
    if not may_mount():
        yield Row(fault="disk full, disk read-only", noticed="not tried: may not mount")
        return
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "state").mkdir()
        with held_egg(folder, small_disk(folder)) as held:
            yield failing(held, "disk full", full)
            yield failing(held, "disk read-only", read_only)
