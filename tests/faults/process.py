"""Processes of the whole daemon that end, stall, or get no memory any more."""

import os
import resource
import signal
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import httpx

from tests.daemon import until
from tests.faults.held import Held, held_egg
from tests.faults.row import Row

CONTROL_SILENCE, RESTART = 2.0, 10.0
"""The silence that the supervisor allows, and the time for a new start. [s]"""
CONTROL, SERVICE = "control", "service"
GROUPS = Path("/sys/fs/cgroup/memory")
"""Where the kernel lets memory be limited, if it does (cgroups, version 1)."""
LITTLE = 256 * 1024
"""More than that a process may not get. [octets]"""

End = Callable[[int], None]


def killed(process: int) -> None:
    """As by the kernel."""
    os.kill(process, signal.SIGKILL)


def told_to_end(process: int) -> None:
    """As by a service manager."""
    os.kill(process, signal.SIGTERM)


def stalled(process: int) -> None:
    """As by a debugger."""
    os.kill(process, signal.SIGSTOP)


def ended(held: Held, fault: str, end: End, *names: str, limit: float = RESTART) -> Row:
    """Do something to processes, and wait until there are new ones."""
    old = {name: held.process(name) for name in names}
    before = held.told(limit="1")[0]["number"]
    for process in old.values():
        end(process)
    start = time.monotonic()
    replaced: Callable[[], bool] = lambda: all(  # noqa: E731
        held.process(name) not in {0, process} for name, process in old.items()
    )
    took = held.since(start, lambda: replaced() and held.ready())
    wrong, noticed = held.wrong(), "force unchanged, ready"
    if CONTROL in names:
        wrong |= _adopted(held, before)
        noticed = "force unchanged, adopted, recorded"
    return Row(
        fault=fault,
        noticed=noticed,
        took=(took,),
        limit=limit,
        wrong=tuple(sorted(wrong)),
    )


def _adopted(held: Held, before: int) -> set[str]:
    """What the state and the history do not say of a new life of control."""
    wrong = set[str]()
    state = held.http.get("/grippers/g0").json()
    if not state["adopted"]:
        wrong.add("not adopted")
    found = f"adopted {state['current_mA']:.2f} mA as found"

    def recorded() -> bool:
        texts = [each["text"] for each in held.told() if each["number"] > before]
        return found in texts and any("began a new life" in text for text in texts)

    try:
        until(recorded)
    except AssertionError:
        wrong.add("not recorded")
    return wrong


@contextmanager
def little_memory() -> Iterator[End | None]:
    """What leaves a process hardly any memory; None where nobody may do that."""
    group = GROUPS / f"gripperd-{os.getpid()}"
    try:
        group.mkdir()
        (group / "memory.limit_in_bytes").write_text(f"{LITTLE}")
    except OSError:
        with suppress(OSError):
            group.rmdir()
        yield None
        return

    def starve(process: int) -> None:
        (group / "cgroup.procs").write_text(f"{process}")

    yield starve
    until(lambda: not (group / "cgroup.procs").read_text())
    group.rmdir()


def no_memory(process: int) -> None:
    """Refuse a process any further memory: everywhere."""
    _, hard = resource.prlimit(process, resource.RLIMIT_AS)
    resource.prlimit(process, resource.RLIMIT_AS, (1, hard))


def out_of_memory(held: Held, fault: str, starve: End) -> Row:
    """Take the memory from control, and let it need some until it is gone."""

    def starved(process: int) -> None:
        starve(process)
        lease = {"owner": "x" * 64, "ttl_s": 60}
        while held.process(CONTROL) == process:
            # Each is written down, by control for the time being in its memory.
            with suppress(httpx.HTTPError, KeyError):
                token = held.http.put("/grippers/g0/lease", json=lease).json()["token"]
                headers = {"Lease-Token": token}
                held.http.delete("/grippers/g0/lease", headers=headers)

    return ended(held, fault, starved, CONTROL)


def rows() -> Iterator[Row]:
    """Each while an egg is held; its force must not change."""
    with held_egg() as held:
        yield ended(held, "control killed", killed, CONTROL)
        yield ended(held, "control told to end", told_to_end, CONTROL)
        yield ended(
            held,
            "control stalled",
            stalled,
            CONTROL,
            limit=CONTROL_SILENCE + RESTART,
        )
        yield ended(held, "service killed", killed, SERVICE)
        yield ended(held, "both killed", killed, SERVICE, CONTROL)
        yield ended(held, "both replaced: upgrade", told_to_end, SERVICE, CONTROL)
        yield out_of_memory(held, "control gets no memory", no_memory)
        with little_memory() as starve:
            if starve is not None:
                yield out_of_memory(held, "control out of memory, killed", starve)
                return
        yield Row(fault="control out of memory", noticed="not tried: no cgroup for us")
