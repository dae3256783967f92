"""The parts of the daemon, started one by one, as units of their own."""

import asyncio
import os
import socket
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing, contextmanager
from pathlib import Path
from typing import IO, NamedTuple

from gripperd.cli.notify import VARIABLE, listen, parse
from gripperd.link.bench import BenchState, ReadBench
from gripperd.link.client import Client
from tests.daemon import PATIENCE, START


class Part(NamedTuple):
    """One running process, and what it reported when it became ready."""

    process: "subprocess.Popen[bytes]"
    facts: Mapping[str, str]


@contextmanager
def part(
    config: Path,
    *arguments: str,
    program: tuple[str, ...] = START,
    stderr: int | IO[bytes] | None = None,
    before: Callable[[], None] | None = None,
    fact: str = "READY",
) -> Iterator[Part]:
    """Run one while inside, and end it as a service manager would.

    It is ready when it reports a certain fact.
    """
    address = config.with_name(f"{arguments[0]}.report")
    with closing(listen(address)) as receiver:
        receiver.settimeout(PATIENCE)
        process = subprocess.Popen(
            [*program, *arguments, "--config", str(config)],
            env=os.environ | {VARIABLE: str(address)},
            stdout=subprocess.DEVNULL,
            stderr=stderr,
            preexec_fn=before,
        )
        try:
            yield Part(process, _ready(receiver, fact))
        finally:
            process.terminate()
            process.wait(PATIENCE)


def _ready(receiver: socket.socket, fact: str) -> Mapping[str, str]:
    while fact not in (facts := parse(receiver.recv(4096))):
        pass
    return facts


def module(name: str) -> tuple[str, ...]:
    """A program of the tests."""
    return (sys.executable, "-m", name)


class Truth(threading.Thread):
    """Looks at the simulated rig all the time, past its wire."""

    def __init__(self, runtime: Path) -> None:
        super().__init__()
        self.states: list[BenchState] = []
        self._socket = runtime / "bench.sock"
        self._over = threading.Event()

    def run(self) -> None:
        asyncio.run(self._look())

    async def _look(self) -> None:
        client = Client(self._socket, "the bench")
        try:
            while not self._over.is_set():
                self.states.append(await client.ask(ReadBench(), BenchState, PATIENCE))
                await asyncio.sleep(0.01)
        finally:
            await client.close()

    def __enter__(self) -> "Truth":
        self.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._over.set()
        self.join()
