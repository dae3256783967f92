"""Names, documents, tables and headers made to do harm, while an egg is held."""

import shutil
import socket
import tempfile
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple
from urllib.parse import urlsplit

from gripperd.config import shipped
from tests.daemon import gripperd, until
from tests.faults.attacks import (
    JSON,
    KEPT,
    RELEASE,
    SOUND,
    TABLES,
    TEXTS,
    Ask,
    documents,
    hosts,
    names,
    origins,
    simple,
    table,
)
from tests.faults.held import COMMANDS, PATIENCE, Held, held_egg
from tests.faults.row import Row
from tests.faults.settings import SETTINGS

UNUSABLE = 78
"""Status of a command that was given an unusable configuration."""
LEASE = "/v1/grippers/g0/lease"
TOKENS = ("", "0", "x" * 10_000, "\u00e9", "../../etc/passwd", "null", "' OR 1=1 --")
KEYS = ("", "x" * 10_000, "a" * 256, "\x7f")


class Hostile(NamedTuple):
    """A daemon that holds an egg, and what it logs."""

    held: Held
    log: Path

    @property
    def current(self) -> float:
        """Of the valve, truly. [mA]"""
        found: float = self.held.http.get("/bench").json()["current_mA"]
        return found

    def logged(self) -> str:
        """All that was logged so far."""
        return self.log.read_text(errors="replace")

    def files(self) -> set[Path]:
        """All that is kept on disk, but for the history's own files."""
        state = self.held.folder / "state"
        return {path for path in state.rglob("*") if "history.db" not in path.name}


@contextmanager
def attacked() -> Iterator[Hostile]:
    """A daemon with an egg, files of its own and a log."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        shutil.copytree(shipped("profiles"), folder / "profiles")
        log = folder / "log"
        within = ("sh", "-c", f'exec "$@" 2>>{log}', "sh")
        with held_egg(folder, within) as held:
            yield Hostile(held, log)


def answered(hostile: Hostile, ask: Ask) -> str:
    """Status line of the answer to a request, as it was sent."""
    place = urlsplit(hostile.held.daemon.url)
    given = {} if ask.host is None else {"Host": ask.host}
    sent = {**given, **ask.headers, "Connection": "close"}
    if ask.body:
        sent["Content-Length"] = str(len(ask.body))
    lines = [f"{ask.method} {ask.target} HTTP/1.1"]
    lines += [f"{name}: {value}" for name, value in sent.items()]
    head = "\r\n".join([*lines, "", ""]).encode()
    with socket.create_connection((place.hostname, place.port), PATIENCE) as line:
        line.sendall(head + ask.body)
        answer = line.makefile("rb").readline().decode("ascii", "replace")
    return answer.split(" ")[1] if answer.startswith("HTTP/1.1 ") else "hung up"


def refused(
    hostile: Hostile,
    fault: str,
    asks: Iterable[Ask],
    allowed: Sequence[str],
    told: Sequence[str] = (),
) -> Row:
    """Send hostile requests: each is refused, and nothing comes of it."""

    def send() -> Iterator[str]:
        for ask in asks:
            status = answered(hostile, ask)
            shown = f"{ask.method} {ask.target} {ask.host} {ask.headers} {ask.body!r}"
            yield status if status in allowed else f"{status}: {shown[:200]}"

    return _judged(hostile, fault, send, told)


def _judged(
    hostile: Hostile,
    fault: str,
    attack: Callable[[], Iterable[str]],
    told: Sequence[str] = (),
    *,
    keeping: bool = False,
) -> Row:
    """Count what came of an attack; all else must be as it was."""
    current, files = hostile.current, hostile.files()
    came = Counter(attack())
    wrong = {each for each in came if not each.isdecimal()} | hostile.held.wrong()
    if hostile.current != current:
        wrong.add("another current")
    if hostile.files() != files and not keeping:
        wrong.add("files were made or removed")
    if "Traceback" in hostile.logged():
        wrong.add("traceback")
    # The log may be a moment late.
    with suppress(AssertionError):
        until(lambda: all(each in hostile.logged() for each in told))
    wrong |= {f"{each} is not logged" for each in told if each not in hostile.logged()}
    return Row(
        fault=fault,
        noticed=", ".join(f"{what} {n}" for what, n in sorted(came.items())),
        came=came,
        wrong=tuple(sorted(wrong)),
    )


def requests(hostile: Hostile) -> Iterator[Row]:
    """What can be said by any client."""
    unknown = ("400", "404", "405", "422", "428")
    yield refused(hostile, "hostile names in paths", names(), unknown)
    yield refused(hostile, "hostile JSON", documents(), ("400", "404", "422"))
    yield refused(hostile, "Host of another", hosts(), ("400", "421"), ("misdirected",))
    yield refused(
        hostile, "Origin of another", origins(), ("403",), ("foreign-origin",)
    )
    yield refused(
        hostile,
        "requests of a page that need no leave",
        simple(),
        ("400", "404", "405", "415"),
        ("unsupported-media-type",),
    )


def tokens(hostile: Hostile) -> Row:
    """Commands without the token of the lease, with wrong ones, with a revoked one."""
    take = {"owner": "somebody", "ttl_s": 60}
    http = hostile.held.http
    revoked = http.put("/grippers/g0/lease", json=take).json()["token"]
    http.delete("/grippers/g0/lease", headers={"Lease-Token": revoked})
    valid = http.put("/grippers/g0/lease", json=take).json()["token"]
    release = Ask("POST", f"/v1{COMMANDS}", JSON, RELEASE)
    wrong = (*TOKENS, revoked, valid[:-1], valid + "0", valid.swapcase())
    asks = [replace(release, headers={**JSON, "Lease-Token": token}) for token in wrong]
    asks += [Ask("DELETE", LEASE, {"Lease-Token": token}) for token in wrong]
    try:
        return refused(
            hostile,
            "lease token missing, wrong, given up",
            [release, *asks],
            ("400", "422", "423", "431"),
        )
    finally:
        http.delete("/grippers/g0/lease", headers={"Lease-Token": valid})


def keys(hostile: Hostile) -> Row:
    """Idempotency keys that are none."""
    asks = [
        Ask("POST", f"/v1{COMMANDS}", {**JSON, "Idempotency-Key": key}, RELEASE)
        for key in KEYS
    ]
    return refused(hostile, "idempotency keys that are none", asks, ("400", "422"))


def recordings(hostile: Hostile) -> Row:
    """Tables that are sent in."""
    csv = {"Content-Type": "text/csv"}
    sound = Ask("POST", "/v1/recordings", csv, table(SOUND))
    assert answered(hostile, sound) == "201", "every such table is refused"
    asks = [replace(sound, body=table(row)) for row in TABLES.values()]
    asks += [
        replace(sound, target=f"/v1/recordings?name={name}")
        for name in ("../../x.csv", "%00", "x" * 10_000, ".csv")
    ]
    return refused(hostile, "hostile CSV, sent in", asks, ("400", "413", "422"))


def left_out(hostile: Hostile) -> Row:
    """Tables with a number that is none, and with a name that is a formula."""

    def send() -> Iterator[str]:
        for name, (row, count) in KEPT.items():
            csv = {"Content-Type": "text/csv"}
            body = table(row)
            found = hostile.held.http.post("/recordings", content=body, headers=csv)
            left = [each["count"] for each in found.json().get("rejected_samples", ())]
            good = found.status_code == 201 and sum(left) == count
            yield "201" if good else f"{name}: {found.status_code} {left}"

    fault = "numbers without end in CSV: left out"
    return _judged(hostile, fault, send, keeping=True)


def read_by_diagnose(hostile: Hostile, tables: Mapping[str, bytes] = TABLES) -> Row:
    """Tables that the command line reads."""
    path = hostile.held.folder / "hostile.csv"

    def read() -> Iterator[str]:
        for name, row in tables.items():
            path.write_bytes(table(row))
            yield _exit(name, "diagnose", str(path))

    return _judged(hostile, "hostile CSV, `diagnose`", read)


def settings(hostile: Hostile) -> Row:
    """Files of settings that are read again."""
    path = hostile.held.folder / SETTINGS
    before = path.read_bytes()

    def read() -> Iterator[str]:
        try:
            for name, text in TEXTS.items():
                path.write_bytes(text)
                status = answered(hostile, Ask("POST", "/v1/config/reload"))
                yield status if status == "422" else f"{name}: {status}"
        finally:
            path.write_bytes(before)

    return _judged(hostile, "hostile YAML, read again", read)


def read_by_check(hostile: Hostile, texts: Mapping[str, bytes] = TEXTS) -> Row:
    """Files of settings that the command line reads."""
    path = hostile.held.folder / "hostile.yaml"

    def read() -> Iterator[str]:
        for name, text in texts.items():
            path.write_bytes(text)
            yield _exit(name, "config", "check", str(path))

    return _judged(hostile, "hostile YAML, `config check`", read)


def _exit(name: str, *arguments: str) -> str:
    """Status of a command that has to refuse a file in a few words."""
    done = gripperd(*arguments)
    said = done.stdout + done.stderr
    # A table or file of megabytes is not repeated to whoever sent it.
    good = done.returncode > 0 and "Traceback" not in said and len(said) < 2000
    plain = "\x1b" not in said and "\x00" not in said
    return f"{done.returncode}" if good and plain else f"{name}: {said[-300:]}"


def rows() -> Iterator[Row]:
    """Each on the same daemon, which holds an egg."""
    with attacked() as hostile:
        yield from requests(hostile)
        yield tokens(hostile)
        yield keys(hostile)
        yield recordings(hostile)
        yield left_out(hostile)
        yield read_by_diagnose(hostile)
        yield settings(hostile)
        yield read_by_check(hostile)
