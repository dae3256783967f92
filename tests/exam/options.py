"""What `make exam` and `make exam-peers` have in common: options, and the sitting."""

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Protocol, TypeVar

import typer

from tests.exam.question import Question, questions
from tests.exam.sitting import note, noted, sat
from tests.hidden_rig import FAMILIES

Cases = Annotated[int, typer.Option(help="Number of cases, over all families.")]
Family = Annotated[str, typer.Option(help="A, B, or both.")]
Jobs = Annotated[int, typer.Option(help="Processes.")]
Seed = Annotated[int, typer.Option(help="Of the mixture.")]
Results = Annotated[
    Path | None, typer.Option(help="JSON lines: read, resumed and added to.")
]


class Solved(Protocol):
    """One line of the results."""

    @property
    def question(self) -> Question:
        """What was asked."""
        ...


Line = TypeVar("Line", bound=Solved)


def chosen(family: str) -> tuple[str, ...]:
    """Give the families that an option means."""
    return FAMILIES if family == "both" else (family,)


def mixture(families: tuple[str, ...], cases: int, seed: int) -> list[Question]:
    """Share the cases out between the families."""
    each, rest = divmod(cases, len(families))
    return [
        question
        for place, family in enumerate(families)
        for question in questions(family, each + (place < rest), seed)
    ]


def solved(
    work: Callable[[Question, Path], Line],
    kind: type[Line],
    asked: list[Question],
    jobs: int,
    results: Path | None,
) -> list[Line]:
    """Solve what an earlier sitting did not, and give all.

    Parameters
    ----------
    work
        Solves a question in a folder of its own.
    kind
        What it gives.
    asked
        The questions.
    jobs
        Processes.
    results
        File that an earlier sitting left, and that is added to.
    """
    known = noted(results, kind) if results else []
    old = {one.question for one in known}
    lines = [one for one in known if one.question in set(asked)]
    for one in sat(work, [one for one in asked if one not in old], jobs):
        lines.append(one)
        if results:
            note(results, one)
    return lines
