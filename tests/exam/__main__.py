"""Examine the diagnosis: ``make exam``, ``make exam CASES=400 FAMILY=A JOBS=2``."""

from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from tests.exam.answer import Answer, answered
from tests.exam.question import Question, questions
from tests.exam.sitting import note, noted, sat
from tests.exam.tables import confusion, errors, report
from tests.hidden_rig import FAMILIES

Cases = Annotated[int, typer.Option(help="Number of cases, over all families.")]
Family = Annotated[str, typer.Option(help="A, B, or both.")]
Jobs = Annotated[int, typer.Option(help="Processes.")]
Seed = Annotated[int, typer.Option(help="Of the mixture.")]
Results = Annotated[
    Path | None, typer.Option(help="JSON lines: read, resumed and added to.")
]


def main(
    cases: Cases = 200,
    family: Family = "both",
    jobs: Jobs = 2,
    seed: Seed = 1,
    results: Results = None,
) -> None:
    """Diagnose seeded cases in which something is hidden, and mark the answers."""
    families = FAMILIES if family == "both" else (family,)
    asked = mixture(families, cases, seed)
    known = noted(results, Answer) if results else []
    old = {one.question for one in known}
    answers = [one for one in known if one.question in set(asked)]
    for one in sat(answered, [one for one in asked if one not in old], jobs):
        answers.append(one)
        if results:
            note(results, one)
    console = Console(width=110)
    console.print(confusion(answers))
    for name in families:
        of = [one for one in answers if one.question.family == name]
        console.print(report(of, f"Family {name}, {len(of)} cases"))
    for error in errors(answers):
        console.print(error, markup=False)


def mixture(families: tuple[str, ...], cases: int, seed: int) -> list[Question]:
    """Share the cases out between the families."""
    each, rest = divmod(cases, len(families))
    return [
        question
        for place, family in enumerate(families)
        for question in questions(family, each + (place < rest), seed)
    ]


if __name__ == "__main__":
    typer.run(main)
