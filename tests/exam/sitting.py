"""Sit an exam: cases in worker processes, each answer written down as it comes."""

import os
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from multiprocessing import get_context
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TypeVar

import msgspec
from rich.console import Console
from rich.progress import Progress

from tests.exam.question import Question

Outcome = TypeVar("Outcome")


def sat(
    work: Callable[[Question, Path], Outcome], asked: Iterable[Question], jobs: int
) -> Iterator[Outcome]:
    """Yield the outcome of each question, in the order of their ends.

    Parameters
    ----------
    work
        Solves a question in a folder that is removed afterwards. It is called in
        another process, so it has to be importable.
    asked
        The questions.
    jobs
        Number of processes; each computes in one thread.
    """
    asked = list(asked)
    with (
        _single_threaded(),
        Progress(console=Console(stderr=True), transient=True) as progress,
        ProcessPoolExecutor(jobs, get_context("spawn")) as pool,
    ):
        task = progress.add_task("cases", total=len(asked))
        ends = as_completed([pool.submit(_in_a_folder, work, one) for one in asked])
        for end in ends:
            progress.advance(task)
            yield end.result()


@contextmanager
def _single_threaded() -> Iterator[None]:
    """Let processes that start meanwhile compute in one thread each.

    Their libraries read the environment when they are loaded, so it has to be set
    before a process starts.
    """
    names = [f"{library}_NUM_THREADS" for library in ("OMP", "OPENBLAS", "MKL")]
    before = {name: os.environ.get(name) for name in names}
    os.environ.update(dict.fromkeys(names, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


def _in_a_folder(work: Callable[[Question, Path], Outcome], one: Question) -> Outcome:
    with TemporaryDirectory() as folder:
        return work(one, Path(folder))


def noted(path: Path, kind: type[Outcome]) -> list[Outcome]:
    """Read the answers of an earlier sitting; none when there was none."""
    if not path.exists():
        return []
    lines = path.read_bytes().splitlines()
    return [msgspec.json.decode(line, type=kind) for line in lines]


def note(path: Path, outcome: object) -> None:
    """Add one answer to the results."""
    with path.open("ab") as file:
        file.write(msgspec.json.encode(outcome) + b"\n")
