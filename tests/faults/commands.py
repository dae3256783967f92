"""Commands that are given twice, raced for, cancelled at any time or left alone."""

import tempfile
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import httpx

from gripperd.config import load_settings, shipped
from gripperd.control.command import Order, Status
from gripperd.control.journal import Happening
from gripperd.control.profile import Mode, Profile
from gripperd.control.states import Machine
from gripperd.control.task import Adjust, Adopt, Move, SelfTest, Tare, Vent
from gripperd.model import Chain
from tests.control.monitors.watched import SPANS, holding, stage
from tests.control.stage import PERIOD, Stage, ordered, real
from tests.daemon import PATIENCE, running_daemon, until
from tests.faults.held import COMMANDS
from tests.faults.row import Row, counted

EVERY = 0.1
"""Time from one try to the next. [s]"""
REST = 5.0
"""Longest until the jaws rest. [s]"""
CLIENTS, ROUNDS = 10, 3
TTL = 0.5
LOST_WITHIN = 1.0
"""[s]"""

EGG = {"type": "grasp", "profile": "raw_egg"}
RELEASE = {"type": "release"}
Begin = Callable[[Chain, Profile], Stage]


def _empty(chain: Chain, _: Profile) -> Stage:
    return stage(chain, 1)


def _before(chain: Chain, profile: Profile) -> Stage:
    made = stage(chain, 1)
    made.rig.plant.place(real(profile))
    return made


def _found(chain: Chain, profile: Profile) -> Stage:
    """Control was started anew while something is held."""
    before = holding(chain, profile)
    made = Stage(chain, before.rig, SPANS)
    made.now = before.now
    made.run(0.2)
    return made


def _kinds(profile: Profile) -> tuple[tuple[str, Begin, Order], ...]:
    """Every kind of command with the state that it is given in."""
    return (
        ("grasp", _before, ordered(profile, Mode.FORCE)),
        ("release", holding, None),
        ("adjust", holding, Adjust(force=1.2 * profile.force)),
        ("hold", _found, Adopt(profile=profile)),
        ("vent", holding, Vent()),
        ("move", _empty, Move(opening=0.05)),
        ("tare", _empty, Tare()),
        ("self_test", _empty, SelfTest()),
    )


def cancelled(chain: Chain, profile: Profile, every: float = EVERY) -> Iterator[Row]:
    """Cancel every kind of command after any time, until it is over by itself."""
    for name, begin, order in _kinds(profile):
        found, after, over = [], 0.0, False
        while not over:
            outcome = _cancelled(begin(chain, profile), order, after)
            found.append(outcome)
            over = outcome != "cancelled"
            after += every
        fault = f"{name} cancelled, every {every:g} s"
        yield counted(fault, found, {"cancelled", "over before"})


def _cancelled(made: Stage, order: Order, after: float) -> str:
    """Give a command, and cancel it after a time. [s]."""
    command = made.submit(order)
    made.run(after)
    before = made.command(command).final
    if not before:
        made.write(made.gripper.cancel(command.id, made.instant))
    made.until(lambda: made.state.machine is Machine.READY, REST)
    made.run(10 * PERIOD)
    ends = [
        entry.command.status
        for entry in made.gripper.ledger.journal.since(0)
        if entry.kind is Happening.COMMAND
        and entry.command is not None
        and entry.command.id == command.id
        and entry.command.final
    ]
    if len(ends) != 1:
        return f"told {len(ends)} ends"
    return "over before" if before else _called(ends[0])


def _called(status: Status) -> str:
    return "cancelled" if status is Status.CANCELLED else f"ended as {status}"


@contextmanager
def daemon() -> Iterator[httpx.Client]:
    """A daemon with empty jaws."""
    with (
        tempfile.TemporaryDirectory() as name,
        running_daemon(Path(name)) as running,
        httpx.Client(base_url=f"{running.url}/v1", timeout=PATIENCE) as http,
    ):
        yield http


def _together(http: httpx.Client, asks: list[dict[str, str]]) -> list[httpx.Response]:
    """Ask for a grasp from many clients at once, each with its headers."""

    def ask(headers: dict[str, str]) -> httpx.Response:
        with httpx.Client(base_url=http.base_url, timeout=PATIENCE) as client:
            return client.post(COMMANDS, json=EGG, headers=headers)

    with ThreadPoolExecutor(len(asks)) as pool:
        return list(pool.map(ask, asks))


def _over(http: httpx.Client, name: str) -> dict[str, Any]:
    """A command once it has its end."""
    found: dict[str, Any] = {}

    def is_over() -> bool:
        nonlocal found
        found = http.get(f"{COMMANDS}/{name}").json()
        return found["completed_at"] is not None

    until(is_over, 60.0)
    return found


def _begun(http: httpx.Client) -> int:
    """How many grasps were ever begun, by the history."""
    events = http.get("/history", params={"kind": "command", "limit": 500}).json()
    begun = [
        event["command"]["id"]
        for event in events["events"]
        if (event["command"]["type"], event["command"]["status"])
        == ("grasp", "running")
    ]
    return len(begun)


def _opened(http: httpx.Client) -> None:
    """Put an egg between open jaws."""
    released = http.post(f"{COMMANDS}?wait_s=60", json=RELEASE)
    assert released.json()["status"] == "succeeded", released.text
    http.delete("/bench/object").raise_for_status()
    http.put("/bench/object", json={"profile": "raw_egg"}).raise_for_status()


def duplicated(http: httpx.Client, rounds: int = ROUNDS) -> Row:
    """Send the same request many times at once."""
    found = []
    for number in range(rounds):
        _opened(http)
        before = _begun(http)
        answers = _together(http, [{"Idempotency-Key": f"same {number}"}] * CLIENTS)
        names = {answer.json()["id"] for answer in answers}
        codes = sorted(answer.status_code for answer in answers)
        done = _over(http, next(iter(names)))
        until(lambda: _begun(http) > before)  # noqa: B023
        alone = len(names) == 1 and codes == [200] * (CLIENTS - 1) + [201]
        once = _begun(http) == before + 1 and done["status"] == "succeeded"
        found.append("one effect" if alone and once else f"{codes}")
    return counted(f"a grasp sent {CLIENTS} times at once", found, {"one effect"})


def raced(http: httpx.Client, rounds: int = ROUNDS) -> Row:
    """Let clients that know nothing of each other ask for the same thing at once."""
    found = []
    for number in range(rounds):
        _opened(http)
        answers = _together(
            http, [{"Idempotency-Key": f"{number} of {n}"} for n in range(CLIENTS)]
        )
        taken = [each.json()["id"] for each in answers if each.status_code == 201]
        ends = [_over(http, name)["status"] for name in taken]
        refused = [each for each in answers if each.status_code != 201]
        said = all(each.json()["status"] in {409, 429} for each in refused)
        won = ends.count("succeeded") == 1
        found.append("one effect" if said and won else f"{ends}")
    return counted(f"{CLIENTS} clients race for a grasp", found, {"one effect"})


def lease_lost(http: httpx.Client, rounds: int = ROUNDS) -> Row:
    """Let the lease of a client run out while its grasp moves."""
    took, wrong = [], set[str]()
    for _ in range(rounds):
        _opened(http)
        lease = {"owner": "somebody", "ttl_s": TTL}
        token = http.put("/grippers/g0/lease", json=lease).json()["token"]
        start = time.monotonic()
        given = http.post(COMMANDS, json=EGG, headers={"Lease-Token": token})
        done = _over(http, given.json()["id"])
        took.append(time.monotonic() - start - TTL)
        if (done["status"], done["error"]["code"]) != ("cancelled", "lease-lost"):
            wrong.add(f"{done['status']}")
        until(lambda: http.get("/grippers/g0").json()["machine"] == "ready")
    return Row(
        fault="lease runs out in a grasp",
        noticed="cancelled: lease-lost",
        took=tuple(took),
        limit=LOST_WITHIN,
        wrong=tuple(sorted(wrong)),
    )


def rows() -> Iterator[Row]:
    """First in the time of the simulated rig, then over REST."""
    settings = load_settings(shipped("gripperd.yaml"), {})
    yield from cancelled(settings.grippers["g0"].chain, settings.profiles["apple"])
    with daemon() as http:
        yield duplicated(http)
        yield raced(http)
        yield lease_lost(http)
