"""Writes to the disk that are cut short: what is read afterwards is old or new."""

import hashlib
import os
import shutil
import signal
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from random import Random

from gripperd.config import load_model, load_profile, saved_profiles, shipped
from gripperd.config.lineage import Added, Provenance, Recorded
from gripperd.config.saved import write_profile
from gripperd.store import Versions
from gripperd.store.history import EventQuery, History
from gripperd.store.recordings import Contents, Recordings, StoredRecording
from tests.faults.death import every_call, forked, killed_at_byte
from tests.faults.row import Row, counted
from tests.store.history.conftest import command, event

NOON = datetime(2026, 1, 31, 12, tzinfo=UTC)
OLD, NEW = "old", "new"
KILLS = 15
"""Times that a process is killed while it writes records."""
CUTS = 60
"""Places at which a log is cut off."""
COMMITS = 12


@dataclass(frozen=True)
class Write:
    """Something that is written, and how to see what has become of it."""

    name: str
    prepare: Callable[[Path], None]
    """Leaves the old state in an empty folder."""
    write: Callable[[Path], None]
    look: Callable[[Path], str]
    """Old, new, or what else is found."""
    stride: int = 1
    """Bytes from one death to the next."""


def _versions(folder: Path) -> Versions:
    return Versions(folder / "models", load_model(shipped("models/reference.yaml")))


def _add(folder: Path) -> None:
    _versions(folder).add(
        load_model(shipped("models/reference.yaml")),
        parent=0,
        created_at=NOON,
        provenance=Provenance(
            program="0.1.0",
            recording=Recorded(name="steps.csv", sha256="0" * 64),
            seed=7,
            effects=(Added(name="parameter:gripper.spring_preload_N"),),
        ),
    )


def _shelf(folder: Path) -> str:
    shelf = _versions(folder).all()
    if shelf.complaints:
        return "damaged"
    return {1: OLD, 2: OLD, 3: NEW}[len(shelf.versions)]


def _active(folder: Path) -> str:
    return {0: OLD, 1: NEW}[_versions(folder).active]


def _profile(folder: Path, mass: float) -> None:
    apple = load_profile(shipped("profiles/apple.yaml"))
    write_profile(replace(apple, mass=mass), folder / "profiles")


def _saved(folder: Path) -> str:
    saved = saved_profiles(folder / "profiles")
    if saved.complaints:
        return "damaged"
    return {0.1: OLD, 0.2: NEW}[saved.profiles["apple"].mass]


CONTENT = b"run,t_s\n" * 100


def _keep(folder: Path) -> None:
    recordings = Recordings(folder / "recordings")
    found = Contents(
        name="rig",
        sha256=hashlib.sha256(CONTENT).hexdigest(),
        columns=("t_s",),
        runs=(),
        rejected_samples=(),
        remarks=(),
    )
    stored = StoredRecording(
        file="rig.csv", size=len(CONTENT), created_at=NOON, contents=found
    )
    with recordings.draft() as draft:
        (draft / "rig.csv").write_bytes(CONTENT)
        recordings.keep(draft, stored)


def _recording(folder: Path) -> str:
    recordings = Recordings(folder / "recordings")
    recordings.sweep()
    for stored in recordings.all():
        content = recordings.path(stored).read_bytes()
        return NEW if hashlib.sha256(content).hexdigest() == stored.id else "half"
    # The same content can be sent again.
    _keep(folder)
    return OLD if len(recordings.all()) == 1 else "in the way"


def _nothing(_: Path) -> None:
    pass


WRITES = (
    Write("model version kept", _add, _add, _shelf, stride=11),
    Write(
        "model version activated",
        _add,
        lambda folder: void(_versions(folder).activate(1)),
        _active,
    ),
    Write(
        "profile saved",
        lambda folder: _profile(folder, 0.1),
        lambda folder: _profile(folder, 0.2),
        _saved,
        stride=7,
    ),
    Write("recording kept", _nothing, _keep, _recording, stride=7),
)


def void(_: object) -> None:
    """Forget what a call returned."""


@contextmanager
def _place(write: Write) -> Iterator[tuple[Path, Callable[[], None]]]:
    """A folder, and what brings it back to the old state."""
    with tempfile.TemporaryDirectory() as name:
        old, folder = Path(name) / "old", Path(name) / "now"
        old.mkdir()
        write.prepare(old)

        def again() -> None:
            shutil.rmtree(folder, ignore_errors=True)
            shutil.copytree(old, folder)

        yield folder, again


def killed_between_calls(write: Write) -> Row:
    """Die before or after every single call that changes a file."""
    with _place(write) as (folder, again):
        found = [
            write.look(folder) for _ in every_call(lambda: write.write(folder), again)
        ]
    fault = f"{write.name}: killed at every call"
    return counted(fault, found, {OLD, NEW})


def killed_at_every_byte(write: Write, stride: int = 1) -> Row:
    """Die at every byte that a file has so far."""
    found = []
    with _place(write) as (folder, again):
        size, over = 0, False
        while not over:
            again()
            over = killed_at_byte(lambda: write.write(folder), size)
            found.append(write.look(folder))
            size += stride
    which = "every byte" if stride == 1 else f"every {stride}th byte"
    return counted(f"{write.name}: killed at {which}", found, {OLD, NEW})


def killed_while_recording(kills: int = KILLS) -> Row:
    """Kill a process that keeps commands; what it had acknowledged must be there."""
    random, found = Random(1), []
    for _ in range(kills):
        with tempfile.TemporaryDirectory() as name:
            path = Path(name) / "history.db"
            acknowledged = _killed_after(path, random.randrange(1, 40), random.random())
            found.append(_as_kept(path, acknowledged))
    return counted("history: killed while it writes", found, {"all kept"})


def _killed_after(path: Path, count: int, share: float) -> int:
    """Kill a writer some time after so many acknowledgements; how many it gave."""
    reader, writer = os.pipe()

    def work() -> None:
        history, number = History(path, "now"), 0
        while True:
            history.put([command(number)], [event(number)])
            os.write(writer, b".")
            number += 1

    child = forked(work)
    os.close(writer)
    heard = 0
    while heard < count:
        heard += len(os.read(reader, 1))
    # Somewhere between this acknowledgement and the next.
    _spin(share)
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    while octets := os.read(reader, 4096):
        heard += len(octets)
    os.close(reader)
    return heard


def _spin(share: float) -> None:
    for _ in range(int(share * 50_000)):
        pass


def _as_kept(path: Path, acknowledged: int) -> str:
    """What is read of commands and events that were written pair by pair."""
    history = History(path, "later")
    events = [record.entry for record in history.events(EventQuery(after=0, limit=999))]
    commands = [record.id for record in history.newest("g0", 999)]
    aside = history.set_aside
    history.close()
    if aside is not None or history.damaged:
        return "damaged"
    if commands != [f"c{number}" for number in reversed(events)]:
        return "half"
    if events != list(range(len(events))):
        return "a gap"
    return "all kept" if len(events) >= acknowledged else "an acknowledged one is lost"


def torn_log(cuts: int = CUTS) -> Row:
    """Cut the log off where a power cut could: behind what was synced, at any byte."""
    random, found = Random(2), []
    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / "history.db"
        history, log = History(path, "now"), path.with_name("history.db-wal")
        synced = []
        for number in range(COMMITS):
            history.put([command(number)], [event(number)])
            synced.append(log.stat().st_size)
        for cut in range(cuts):
            copy = Path(name) / f"cut{cut}" / path.name
            copy.parent.mkdir()
            shutil.copy(path, copy)
            size = random.randrange(synced[-1] + 1)
            copy.with_name(log.name).write_bytes(log.read_bytes()[:size])
            found.append(_as_kept(copy, sum(each <= size for each in synced)))
            shutil.rmtree(copy.parent)
        history.close()
    return counted("history: its log cut off at any byte", found, {"all kept"})


def rows() -> Iterator[Row]:
    """Everything that is written, cut short everywhere."""
    for write in WRITES:
        yield killed_between_calls(write)
        yield killed_at_every_byte(write, write.stride)
    yield killed_while_recording()
    yield torn_log()
